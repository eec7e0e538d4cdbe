//! Times of a step: of the structured filter in both forms beside the textbook filter, in builds for several
//! processors; of the textbook filter beside those of other packages, since the reference must not be a slow one;
//! and against the number of states.

use std::hint::black_box;
use std::process::Command;

use gyrocal::{EstimationError, Integration};
use gyrocal_testkit::extended_filter::{SIZES, samples, start, step};
use gyrocal_testkit::step_times::peer_times;
use gyrocal_testkit::timing::{medians, seconds, target_features};

use super::RULES;
use super::instructions::{cargo, output, root};
use crate::harness::{Error, Figure};

const ROUNDS: usize = 501;

/// Processors that the example `step_times` is built for, any for none, and least times of the textbook filter over
/// ours by the rules.
const BUILDS: [(&str, [Option<f64>; 2]); 3] = [
    ("", [Some(5.0), Some(4.0)]),
    ("x86-64-v3", [Some(7.0), Some(4.0)]),
    ("native", [None, None]),
];

/// Largest time of the textbook filter over that of the fastest of other packages.
const OVER_FASTEST: f64 = 1.1;

/// Steps of one round of each number of states: two hours.
const STEPS_OF_SIZE: usize = 120;
/// Largest cost of a step relative to proportionality to n². One-sided: at n = 12 most of a step does
/// not depend on n (sines, divisions of the update), so larger ones cost less than in proportion.
const OVER_SQUARE: f64 = 1.3;

pub(super) fn figures() -> Result<Vec<Figure>, Error> {
    let features = target_features();
    let mut figures = vec![Figure::note("target features of this build", features)];
    for (processor, least) in BUILDS {
        if processor.is_empty() || has_x86_64_v3() {
            figures.extend(of_build(processor, least)?);
        } else {
            let name = format!("steps built for {processor} not timed");
            let why = "this machine has no x86-64-v3".to_owned();
            figures.push(Figure::note(&name, why));
        }
    }
    figures.extend(beside_other_packages()?);
    for (rule, integration) in RULES {
        figures.extend(by_states(rule, integration)?);
    }
    let figures = figures.into_iter();
    Ok(figures.map(|one| one.over(ROUNDS, "")).collect())
}

/// Figures of a build of the example `step_times`. Builds for other processors stay apart: the flags would make
/// cargo build everything again.
fn of_build(processor: &str, least: [Option<f64>; 2]) -> Result<Vec<Figure>, Error> {
    let run = "run --release --quiet --package gyrocal --example step_times --";
    let mut command = Command::new(cargo());
    command.current_dir(root()).args(run.split(' '));
    command.arg(ROUNDS.to_string());
    if !processor.is_empty() {
        let target = root().join("target/figures").join(processor);
        command.env("RUSTFLAGS", format!("-C target-cpu={processor}"));
        command.env("CARGO_TARGET_DIR", target);
        command.env_remove("CARGO_ENCODED_RUSTFLAGS");
    }
    let printed = output(&mut command)?;
    let build = match processor {
        "" => String::new(),
        processor => format!(", {processor}"),
    };
    let mut figures = Vec::new();
    for ((rule, _), least) in RULES.into_iter().zip(least) {
        // A line for each rule: three times in ns, and their ratios to the first.
        let line = printed.lines().find_map(|line| line.strip_prefix(rule));
        let numbers = line.unwrap_or_default().split_whitespace();
        let numbers: Vec<f64> = numbers.map(str::parse).collect::<Result<_, _>>()?;
        let [ours, dense, factors, _, of_dense, of_factors] = numbers[..] else {
            let why = format!("the example step_times printed no times of {rule}: {printed}");
            return Err(why.into());
        };
        let what = format!("{rule} step{build}: time of dense_joseph / of the kernel");
        figures.push(match least {
            Some(least) => Figure::within(&what, [least, f64::INFINITY], of_dense),
            None => Figure::note(&what, format!("{of_dense:.3}")),
        });
        let what = format!("{rule}{build}, factors / covariance: time of a step");
        figures.push(Figure::note(&what, format!("{of_factors:.2}")));
        let what = format!("{rule} step{build}: kernel, dense_joseph, kernel on factors");
        let ns = format!("{ours:.0} ns, {dense:.0} ns, {factors:.0} ns");
        figures.push(Figure::note(&what, ns));
    }
    Ok(figures)
}

/// The textbook filter beside Joseph-form filters of other packages.
fn beside_other_packages() -> Result<[Figure; 2], Error> {
    let (ns, ratios) = peer_times(ROUNDS)?;
    let what = "euler step: dense_joseph / fastest Joseph-form crate";
    let ratio = 1.0 / ratios[1].min(ratios[2]);
    let ns = ns.map(|ns| format!("{ns:.0} ns")).join(", ");
    Ok([
        Figure::within(what, [f64::NEG_INFINITY, OVER_FASTEST], ratio),
        Figure::note("euler step: dense_joseph, adskalman, multicalc", ns),
    ])
}

/// Cost of a step against the number of states.
fn by_states(rule: &str, integration: Integration) -> Result<Vec<Figure>, Error> {
    let samples = samples(STEPS_OF_SIZE)?;
    let starts = SIZES.map(|states| start(states, integration));
    let starts = starts.into_iter().collect::<Result<Vec<_>, _>>()?;
    let (times, ratios) = medians(ROUNDS, || {
        let mut times = [0.0; SIZES.len()];
        for (time, start) in times.iter_mut().zip(&starts) {
            let mut filter = black_box(start.clone());
            let mut step = |sample| step(&mut filter, sample);
            *time = seconds(|| samples.iter().try_for_each(&mut step))?;
            black_box(&filter);
        }
        Ok::<_, EstimationError>(times)
    })?;
    let ns = times.map(|time| format!("{:.0}", time / STEPS_OF_SIZE as f64 * 1e9));
    let sizes = SIZES.map(|states| states.to_string()).join(" ");
    let what = format!("{rule} step: ns at n = {sizes}");
    let mut figures = vec![Figure::note(&what, ns.join(" "))];
    for (states, ratio) in SIZES.iter().zip(ratios).skip(1) {
        let proportional = (*states as f64 / SIZES[0] as f64).powi(2);
        let what = format!("{rule} step: cost({states}) / cost(12) / ({states}/12)^2");
        let bounds = [f64::NEG_INFINITY, OVER_SQUARE];
        figures.push(Figure::within(&what, bounds, ratio / proportional));
    }
    Ok(figures)
}

pub(crate) fn has_x86_64_v3() -> bool {
    #[cfg(target_arch = "x86_64")]
    return std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("fma")
        && std::arch::is_x86_feature_detected!("bmi2");
    #[cfg(not(target_arch = "x86_64"))]
    false
}
