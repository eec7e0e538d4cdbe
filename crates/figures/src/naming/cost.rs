//! Time and memory of a diagnosis, and its reproducibility.

use gyrocal_evaluation::diagnosed;
use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, simulate};

use crate::cost::{Peak, on_one_core};
use crate::harness::{Error, Figure};

/// Largest time for three days sampled each minute, and each second, s; largest memory of the process, MB.
const MINUTES_S: f64 = 1.0;
const SECONDS_S: f64 = 30.0;
const SECONDS_MB: f64 = 1000.0;

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let minutes = simulation(60.0)?;
    let (first, minutes_s) = told(&minutes)?;
    let (second, again_s) = told(&minutes)?;
    let name = "three days at 60 s with a cause, whole diagnosis on one core";
    let mut time = Figure::at_most(name, MINUTES_S, minutes_s.min(again_s), "s").over(2, "1");
    let name = "two diagnoses of one record are the same to the last bit";
    let same = Figure::truth(name, first == second);
    if small {
        // Times on a machine that does other work as well say little: shown, not judged.
        time.holds = None;
        return Ok(vec![time, same]);
    }
    let seconds = simulation(1.0)?;
    let peak = Peak::reset();
    let (_, seconds_s) = told(&seconds)?;
    let peak_mb = peak.read_mb();
    let rows = seconds.record.len();
    let name = format!("three days at 1 s with a cause, {rows} rows, on one core");
    let long = Figure::at_most(&name, SECONDS_S, seconds_s, "s");
    let name = "the same: peak memory of the process";
    let memory = Figure::at_most(name, SECONDS_MB, peak_mb, "MB");
    Ok(vec![time, same, long, memory])
}

/// Three days with a term of 14 standard deviations at one row a minute.
fn simulation(interval_s: f64) -> Result<Simulation, Error> {
    Ok(simulate(&Scenario {
        seed: 1,
        coefficients: Coefficients::PAPER_LIKE,
        interval_s,
        duration_s: 3.0 * 86_400.0 - interval_s,
        hidden: vec![Hidden::new("gyro_y.g_z", &[("size", 1e-3)])?],
        ..Scenario::default()
    })?)
}

/// All numbers of a diagnosis, and its time, s.
fn told(simulation: &Simulation) -> Result<(String, f64), Error> {
    let (found, seconds) = on_one_core(|| diagnosed(simulation));
    let found = found?;
    // Numbers are written with as many digits as tell them from all others.
    let all = format!("{:?}", (&found.result, found.nominal.values()));
    Ok((all, seconds))
}
