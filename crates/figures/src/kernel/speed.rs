//! Time of a step of the structured filter, in both forms, relative to the textbook filter: in this
//! build, and in builds for the vector units of this machine.

use std::path::PathBuf;
use std::process::Command;

use gyrocal_testkit::step_times::{StepTimes, step_times};
use gyrocal_testkit::timing::is_x86_64_v3;

use super::Error;
use super::instructions::{cargo, output, root};
use crate::figure::Figure;

/// Targets of the processor for which the example `step_times` is built as well.
const PROCESSORS: [&str; 2] = ["x86-64-v3", "native"];

/// Figures of this build.
pub(crate) fn figures(rounds: usize) -> Result<Vec<Figure>, Error> {
    let build = if is_x86_64_v3() { "x86-64-v3" } else { "" };
    let times = step_times(rounds)?;
    Ok(times
        .iter()
        .flat_map(|times| figures_of(build, times, rounds))
        .collect())
}

/// Figures of builds for other processors; where this one lacks their instructions, the reason.
pub(crate) fn of_other_builds(rounds: usize) -> Result<Vec<Figure>, Error> {
    if !has_x86_64_v3() {
        let reason = "this machine has no x86-64-v3".to_owned();
        return Ok(vec![Figure::note("other builds not timed", reason)]);
    }
    let mut figures = Vec::new();
    for processor in PROCESSORS {
        let printed = output(
            Command::new(cargo())
                .current_dir(root())
                .env_remove("CARGO_ENCODED_RUSTFLAGS")
                .env("RUSTFLAGS", format!("-C target-cpu={processor}"))
                .env("CARGO_TARGET_DIR", target_directory(processor))
                .args(["run", "--release", "--quiet", "--package", "gyrocal"])
                .args(["--example", "step_times", "--", &rounds.to_string()]),
        )?;
        let times = printed.lines().filter_map(parsed);
        let found: Vec<Figure> = times
            .flat_map(|times| figures_of(processor, &times, rounds))
            .collect();
        if found.is_empty() {
            return Err(format!("the example step_times printed no times: {printed}").into());
        }
        figures.extend(found);
    }
    Ok(figures)
}

fn figures_of(build: &str, times: &StepTimes, rounds: usize) -> Vec<Figure> {
    let rule = times.rule;
    let of = match build {
        "" => String::new(),
        build => format!(", {build}"),
    };
    let target = match (rule, build) {
        ("euler", "") => Some(5.0),
        ("euler", "x86-64-v3") => Some(7.0),
        (_, "native") => None,
        _ => Some(4.0),
    };
    let what = format!("{rule} step{of}: time of dense_joseph / of the kernel");
    let ratio = match target {
        Some(target) => Figure::within(&what, [target, f64::INFINITY], times.ratios[1]),
        None => Figure::note(&what, format!("{:.3}", times.ratios[1])),
    };
    let factors = format!("{rule}{of}, factors / covariance: time of a step");
    let [ours, dense, on_factors] = times.ns;
    let what = format!("{rule} step{of}: kernel, dense_joseph, kernel on factors");
    let ns = format!("{ours:.0} ns, {dense:.0} ns, {on_factors:.0} ns");
    [
        ratio,
        Figure::note(&factors, format!("{:.2}", times.ratios[2])),
        Figure::note(&what, ns),
    ]
    .map(|figure| figure.over(rounds, ""))
    .to_vec()
}

/// A line of the example `step_times`: the rule, three times in ns, three ratios.
fn parsed(line: &str) -> Option<StepTimes> {
    let mut words = line.split_whitespace();
    let rule = match words.next()? {
        "euler" => "euler",
        "rk4" => "rk4",
        _ => return None,
    };
    let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>().ok()?;
    let [a, b, c, x, y, z] = numbers[..] else {
        return None;
    };
    Some(StepTimes {
        rule,
        ns: [a, b, c],
        ratios: [x, y, z],
    })
}

/// Builds for other processors stay apart: the flags would make cargo build everything again.
fn target_directory(processor: &str) -> PathBuf {
    root().join("target/figures").join(processor)
}

#[cfg(target_arch = "x86_64")]
pub(crate) fn has_x86_64_v3() -> bool {
    std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("fma")
        && std::arch::is_x86_feature_detected!("bmi2")
}

#[cfg(not(target_arch = "x86_64"))]
pub(crate) fn has_x86_64_v3() -> bool {
    false
}
