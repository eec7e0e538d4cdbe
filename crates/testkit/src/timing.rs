//! Interleaved timing of alternatives in one process.

use std::hint::black_box;
use std::time::Instant;

/// Rounds before those that count.
const WARM_UP: usize = 10;

/// Time of `work`, s.
pub fn seconds<E>(work: impl FnOnce() -> Result<(), E>) -> Result<f64, E> {
    let begin = Instant::now();
    work()?;
    Ok(begin.elapsed().as_secs_f64())
}

/// The shorter of two times of `work`, called with the stack 16 bytes apart.
///
/// The start of the stack differs between runs of a program, and with it the alignment of numbers to
/// cache lines, which is a fifth of the time of a dense step.
pub fn well_placed<E>(mut work: impl FnMut() -> Result<f64, E>) -> Result<f64, E> {
    Ok(placed::<2, E>(&mut work)?.min(placed::<4, E>(&mut work)?))
}

#[inline(never)]
fn placed<const WORDS: usize, E>(work: &mut dyn FnMut() -> Result<f64, E>) -> Result<f64, E> {
    let below = black_box([0_u64; WORDS]);
    let time = work();
    black_box(&below);
    time
}

/// Calls `round`, which times every contender once, repeatedly; returns the median time of each
/// contender, and the median over rounds of its ratio to the first one.
///
/// The ratio is taken before the median: all contenders of a round see the same load of the machine.
pub fn medians<const N: usize, E>(
    rounds: usize,
    mut round: impl FnMut() -> Result<[f64; N], E>,
) -> Result<([f64; N], [f64; N]), E> {
    for _ in 0..WARM_UP {
        round()?;
    }
    let mut times = Vec::with_capacity(rounds);
    for _ in 0..rounds {
        times.push(round()?);
    }
    let over = |value: &dyn Fn(&[f64; N]) -> f64| {
        let mut values: Vec<f64> = times.iter().map(value).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let absolute = core::array::from_fn(|k| over(&|times| times[k]));
    let relative = core::array::from_fn(|k| over(&|times| times[k] / times[0]));
    Ok((absolute, relative))
}

/// Model name of the processor, where the system tells it.
pub fn processor() -> String {
    let description = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = description.lines();
    let name = lines.find_map(|line| line.strip_prefix("model name"));
    let name = name.map(|name| name.trim_start_matches([' ', '\t', ':']));
    name.unwrap_or("an unnamed processor").to_owned()
}

/// Target features of this build.
pub fn target_features() -> String {
    let known = [
        ("sse2", cfg!(target_feature = "sse2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
    ];
    let on = known.iter().filter(|(_, on)| *on);
    let names: Vec<&str> = on.map(|(name, _)| *name).collect();
    format!("{}: {}", std::env::consts::ARCH, names.join(" "))
}
