//! Noise that is not normal, and drifts that wander.

use gyrocal_record::{AXES, Record};
use gyrocal_statistics::deviates::Draw;

use crate::error::Error;
use crate::hidden::Hidden;
use crate::scenario::Scenario;
use crate::simulation::{Simulation, simulate, simulate_with};
use crate::term::Term;

/// Time constants of the Gauss-Markov processes that flicker is the sum of, h: a factor of about
/// three apart, so that their spectrum follows 1/f within 5 % between the first and the last.
const FLICKER_H: [f64; 9] = [0.05, 0.15, 0.5, 1.5, 5.0, 15.0, 50.0, 150.0, 500.0];

/// A deviate of Student's distribution with a whole number of degrees of freedom.
pub fn student(random: &mut Draw, degrees: u32) -> f64 {
    let squares: f64 = (0..degrees).map(|_| random.normal().powi(2)).sum();
    random.normal() / (squares / f64::from(degrees)).sqrt()
}

/// The record of a scenario whose accelerometers have `deviate` times the declared noise, given the share of the
/// record that is over.
///
/// # Errors
/// As [`simulate`].
pub fn with_noise(
    scenario: &Scenario,
    deviate: impl FnMut(f64) -> f64,
) -> Result<Simulation, Error> {
    let mut simulation = simulate(&Scenario {
        accel_noise_g: 0.0,
        ..scenario.clone()
    })?;
    simulation.bench = scenario.bench();
    add_noise(&mut simulation.record, scenario.accel_noise_g, deviate);
    Ok(simulation)
}

/// Adds noise of `deviate` times a level, given the share of the record that is over.
pub fn add_noise(record: &mut Record, noise_g: f64, mut deviate: impl FnMut(f64) -> f64) {
    let rows = record.len() as f64;
    for (at, row) in record.accel_g.iter_mut().enumerate() {
        *row = row.map(|value| value + noise_g * deviate(at as f64 / rows));
    }
}

/// Converters of all accelerometers with a least significant bit, g.
///
/// # Errors
/// As [`Hidden::new`].
pub fn quantised(lsb_g: f64) -> Result<[Hidden; 3], Error> {
    let of = |axis: &str| Hidden::new(&format!("accel_{axis}.quantisation"), &[("lsb", lsb_g)]);
    let [x, y, z] = AXES.map(of);
    Ok([x?, y?, z?])
}

/// A record with flicker of the drifts, deg/h: sums of Gauss-Markov processes of equal variance.
///
/// # Errors
/// As [`simulate`].
pub fn flickering(
    scenario: &Scenario,
    levels: [f64; 3],
    random: &mut Draw,
) -> Result<Simulation, Error> {
    let step_s = scenario.interval_s;
    let rows = (scenario.duration_s / step_s) as usize + 2;
    let series = levels.map(|level| {
        let mut values = vec![0.0; rows];
        for time_h in FLICKER_H {
            let kept = (-step_s / 3600.0 / time_h).exp();
            let mut state = random.normal();
            for value in &mut values {
                *value += level * state;
                state = kept * state + (1.0 - kept * kept).sqrt() * random.normal();
            }
        }
        values
    });
    let term = Term::Drift(Box::new(move |moment| {
        let row = ((moment.time_s / step_s) as usize).min(rows - 1);
        core::array::from_fn(|gyro| series[gyro][row])
    }));
    simulate_with(scenario, &[term])
}
