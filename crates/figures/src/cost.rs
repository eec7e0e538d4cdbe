//! Processor time and memory.

use std::time::Instant;

/// Result of a job on one thread and its processor time, s; its elapsed time if the kernel does not
/// provide processor time.
pub(crate) fn on_one_core<R>(job: impl FnOnce() -> R) -> (R, f64) {
    let (begin, begin_cpu_s) = (Instant::now(), thread_s());
    let made = job();
    let seconds = match (begin_cpu_s, thread_s()) {
        (Some(begin_s), Some(end_s)) => end_s - begin_s,
        _ => begin.elapsed().as_secs_f64(),
    };
    (made, seconds)
}

/// Processor time of this thread; `None` if the kernel does not provide it.
fn thread_s() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
    Some(nanoseconds * 1e-9)
}

/// Peak memory of the process since the creation of this value.
pub(crate) struct Peak(bool);

impl Peak {
    pub(crate) fn reset() -> Self {
        // 5 resets the peak resident set size, proc(5).
        Self(std::fs::write("/proc/self/clear_refs", "5").is_ok())
    }

    /// NaN where the kernel does not tell: nothing was measured then, and so nothing holds.
    pub(crate) fn read_mb(&self) -> f64 {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find(|line| line.starts_with("VmHWM:"));
        let kibibytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse().ok());
        let told = kibibytes.filter(|_| self.0);
        told.map_or(f64::NAN, |kibibytes: f64| 1024.0 * kibibytes / 1e6)
    }
}

/// Processor time of this process, s; zero if the kernel does not provide it.
pub(crate) fn process_s() -> f64 {
    // Ticks of a hundredth of a second, proc(5); the name in parentheses may have blanks.
    const TICKS_PER_S: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = text.rsplit(')').next().unwrap_or_default();
    let fields = after_name.split_whitespace();
    // User and system time are fields 14 and 15, the first after the name is the third.
    let ticks = fields
        .skip(11)
        .take(2)
        .filter_map(|field| field.parse::<f64>().ok());
    ticks.sum::<f64>() / TICKS_PER_S
}
