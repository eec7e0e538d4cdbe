//! Processor time and memory of a calibration.

use gyrocal_calibration::{Options, calibrate};
use gyrocal_statistics::median;
use gyrocal_truth::{Coefficients, Scenario, Simulation, simulate};

use super::Error;
use crate::cost::{Peak, on_one_core};
use crate::figure::Figure;

const THREE_DAYS_MS: f64 = 100.0;
const MILLION_S: f64 = 30.0;
const MILLION_MB: f64 = 500.0;

/// Largest ratio of the time per row and pass between lengths, which differs by the caches in use.
const LINEAR: f64 = 1.5;

/// The same ten days, sampled more and more often.
const TEN_DAYS_S: f64 = 864_000.0;

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    let mut per_pass_ns: Vec<f64> = Vec::new();
    let lengths: &[u32] = if small {
        &[10_000, 100_000]
    } else {
        &[10_000, 100_000, 1_000_000]
    };
    for rows in lengths {
        let simulation = simulate(&scenario(
            TEN_DAYS_S / f64::from(*rows),
            TEN_DAYS_S - TEN_DAYS_S / f64::from(*rows),
        ))?;
        if simulation.record.len() != *rows as usize {
            return Err(format!("{} rows, expected {rows}", simulation.record.len()).into());
        }
        let repetitions = (300_000 / rows).max(1);
        let peak = Peak::reset();
        let mut iterations = 0;
        let times = (0..repetitions)
            .map(|_| {
                let (seconds, passes) = timed(&simulation)?;
                iterations = passes;
                Ok(seconds)
            })
            .collect::<Result<Vec<f64>, Error>>()?;
        let seconds = median(&times);
        per_pass_ns.push(seconds * 1e9 / f64::from(*rows) / iterations as f64);
        let peak_mb = peak.and_then(|peak| peak.read_mb());
        if *rows == 1_000_000 {
            let mut figure = Figure::at_most("a million samples", MILLION_S, seconds, "s");
            figure.measured += &format!(", {iterations} steps");
            figures.push(figure);
            // Where the kernel does not tell, nothing was measured, and so nothing holds.
            figures.push(Figure::at_most(
                "a million samples: peak memory of the process",
                MILLION_MB,
                peak_mb.unwrap_or(f64::NAN),
                "MB",
            ));
        } else {
            figures.push(Figure::note(
                &format!("{rows} samples"),
                format!("{:.0} ms, {iterations} steps", seconds * 1e3),
            ));
        }
    }
    let largest = per_pass_ns.iter().copied().fold(0.0, f64::max);
    let least = per_pass_ns.iter().copied().fold(f64::INFINITY, f64::min);
    let mut linear = Figure::within(
        "time of a row and a step, slowest over fastest length",
        [0.0, LINEAR],
        largest / least,
    );
    let each: Vec<String> = per_pass_ns.iter().map(|ns| format!("{ns:.0} ns")).collect();
    linear.measured += &format!(" ({})", each.join(", "));
    figures.push(linear);
    figures.push(three_days(if small { 7 } else { 31 })?);
    if small {
        // Times on a machine that does other work as well say little: shown, not judged.
        for figure in &mut figures {
            figure.holds = None;
        }
    }
    Ok(figures)
}

fn scenario(interval_s: f64, duration_s: f64) -> Scenario {
    Scenario {
        seed: 1,
        coefficients: Coefficients::PAPER_LIKE,
        interval_s,
        duration_s,
        ..Scenario::default()
    }
}

fn three_days(repetitions: usize) -> Result<Figure, Error> {
    let simulation = simulate(&scenario(60.0, 3.0 * 86_400.0))?;
    let mut steps = 0;
    let times = (0..repetitions)
        .map(|_| {
            let (seconds, iterations) = timed(&simulation)?;
            steps = iterations;
            Ok(seconds * 1e3)
        })
        .collect::<Result<Vec<f64>, Error>>()?;
    let milliseconds = median(&times);
    let mut figure = Figure::at_most(
        "three days at 60 s, all passes, on one core: median",
        THREE_DAYS_MS,
        milliseconds,
        "ms",
    );
    figure.measured += &format!(", {steps} steps");
    Ok(figure.over(repetitions, "1"))
}

/// Processor seconds and steps of one calibration.
fn timed(simulation: &Simulation) -> Result<(f64, usize), Error> {
    let (found, seconds) = on_one_core(|| {
        calibrate(
            &simulation.record,
            &simulation.bench,
            &Options::default(),
            |_| (),
        )
    });
    Ok((seconds, found?.iterations))
}
