//! Timing of things against each other, in one process and interleaved.

use std::time::Instant;

/// Rounds that are run and not counted.
const WARM_UP: usize = 10;

/// Seconds that `work` takes.
pub(crate) fn seconds<E>(work: impl FnOnce() -> Result<(), E>) -> Result<f64, E> {
    let begin = Instant::now();
    work()?;
    Ok(begin.elapsed().as_secs_f64())
}

/// Calls `round` again and again, which times every contender once; returns the median of each
/// contender's time, and the median over rounds of its ratio to the first one's.
///
/// Contenders of a round see the same state of the machine, so the ratio is taken before the
/// median: what others do meanwhile hits both.
pub(crate) fn medians<const N: usize, E>(
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

/// Whether this build may use what every x86-64-v3 processor has.
pub(crate) const fn is_x86_64_v3() -> bool {
    cfg!(all(
        target_feature = "avx2",
        target_feature = "fma",
        target_feature = "bmi2"
    ))
}

/// What this build was allowed to use.
pub(crate) fn target_features() -> String {
    let known = [
        ("sse2", cfg!(target_feature = "sse2")),
        ("avx", cfg!(target_feature = "avx")),
        ("avx2", cfg!(target_feature = "avx2")),
        ("fma", cfg!(target_feature = "fma")),
        ("avx512f", cfg!(target_feature = "avx512f")),
        ("neon", cfg!(target_feature = "neon")),
    ];
    let names: Vec<&str> = known
        .iter()
        .filter(|(_, on)| *on)
        .map(|(name, _)| *name)
        .collect();
    format!("{}: {}", std::env::consts::ARCH, names.join(" "))
}
