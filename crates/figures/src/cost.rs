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
pub(crate) struct Peak;

impl Peak {
    pub(crate) fn reset() -> Option<Self> {
        // 5 resets the peak resident set size, proc(5).
        std::fs::write("/proc/self/clear_refs", "5").ok()?;
        Some(Self)
    }

    pub(crate) fn read_mb(&self) -> Option<f64> {
        let status = std::fs::read_to_string("/proc/self/status").ok()?;
        let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
        let kibibytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
        Some(kibibytes * 1024.0 / 1e6)
    }
}
