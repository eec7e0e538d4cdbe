//! Processor time and memory of a calibration.

use gyrocal_calibration::{Options, calibrate};
use gyrocal_statistics::median;
use gyrocal_truth::{Coefficients, Scenario, Simulation, simulate};

use crate::cost::{Peak, on_one_core};
use crate::harness::{Error, Figure};

/// Rows of the same ten days, sampled more and more often, and how often each is calibrated.
const LENGTHS: [(u32, usize); 3] = [(10_000, 30), (100_000, 3), (1_000_000, 1)];
const TEN_DAYS_S: f64 = 864_000.0;

/// Largest ratio of the time per row and pass between lengths, which differs by the caches in use.
const LINEAR: f64 = 1.5;

pub(super) fn figures() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    let mut per_pass_ns: Vec<f64> = Vec::new();
    for (rows, repetitions) in LENGTHS {
        let interval_s = TEN_DAYS_S / f64::from(rows);
        let simulation = simulated(interval_s, TEN_DAYS_S - interval_s)?;
        let peak = Peak::reset();
        let (seconds, steps) = timed(&simulation, repetitions)?;
        per_pass_ns.push(seconds * 1e9 / f64::from(rows) / steps as f64);
        if rows < 1_000_000 {
            let time = format!("{:.0} ms, {steps} steps", seconds * 1e3);
            figures.push(Figure::note(&format!("{rows} samples"), time));
            continue;
        }
        let time = Figure::at_most("a million samples", 30.0, seconds, "s");
        let name = "a million samples: peak memory of the process";
        let memory = Figure::at_most(name, 500.0, peak.read_mb(), "MB");
        figures.extend([with_steps(time, steps), memory]);
    }
    let largest = per_pass_ns.iter().copied().fold(0.0, f64::max);
    let least = per_pass_ns.iter().copied().fold(f64::INFINITY, f64::min);
    let name = "time of a row and a step, slowest over fastest length";
    let mut linear = Figure::within(name, [0.0, LINEAR], largest / least);
    let each: Vec<String> = per_pass_ns.iter().map(|ns| format!("{ns:.0} ns")).collect();
    linear.measured += &format!(" ({})", each.join(", "));
    figures.push(linear);
    let (seconds, steps) = timed(&simulated(60.0, 3.0 * 86_400.0)?, 31)?;
    let name = "three days at 60 s, all passes, on one core: median";
    let three_days = Figure::at_most(name, 100.0, seconds * 1e3, "ms");
    figures.push(with_steps(three_days, steps).over(31, "1"));
    Ok(figures)
}

fn with_steps(mut figure: Figure, steps: usize) -> Figure {
    figure.measured += &format!(", {steps} steps");
    figure
}

fn simulated(interval_s: f64, duration_s: f64) -> Result<Simulation, Error> {
    Ok(simulate(&Scenario {
        seed: 1,
        coefficients: Coefficients::PAPER_LIKE,
        interval_s,
        duration_s,
        ..Scenario::default()
    })?)
}

/// Median processor time, s, and steps of some calibrations of a record.
fn timed(simulation: &Simulation, repetitions: usize) -> Result<(f64, usize), Error> {
    let (record, bench, options) = (&simulation.record, &simulation.bench, Options::default());
    let mut steps = 0;
    let times = (0..repetitions).map(|_| {
        let (found, seconds) = on_one_core(|| calibrate(record, bench, &options, |_| ()));
        steps = found?.iterations;
        Ok(seconds)
    });
    let times = times.collect::<Result<Vec<f64>, Error>>()?;
    Ok((median(&times), steps))
}
