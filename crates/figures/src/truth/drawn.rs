//! What the records of several populations are drawn of: scenarios, noise other than declared, drifts that wander.

use gyrocal_calibration::NoiseModel;
use gyrocal_evaluation::scenario;
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, Term, simulate_with};

use crate::error::Error;

/// This file, as a source of populations.
pub(super) const FILE: &str = file!();

/// Purpose of the stream of draws of noise levels.
const LEVELS: u64 = 48;

/// Sampling intervals of the records of a cell in turn, s: those of means of one to four minutes, which
/// tell as much of slow effects as raw samples.
const INTERVALS_S: [f64; 3] = [60.0, 120.0, 240.0];

/// Ratio of the true standard deviation to the declared one.
const MISDECLARED: [f64; 2] = [0.5, 2.0];

/// Random walks, deg/h/√h.
const WALKS: [f64; 2] = [3e-5, 2e-3];

/// Time constants of the Gauss-Markov processes that flicker is the sum of, h: a factor of about
/// three apart, so that their spectrum follows 1/f within 5 % between the first and the last.
const FLICKER_H: [f64; 9] = [0.05, 0.15, 0.5, 1.5, 5.0, 15.0, 50.0, 150.0, 500.0];

/// The scenario of a seed, with noise as declared.
pub(super) fn plain(seed: u64) -> Scenario {
    Scenario {
        interval_s: INTERVALS_S[(seed % INTERVALS_S.len() as u64) as usize],
        ..scenario(seed)
    }
}

/// The scenario of a seed, its noise misdeclared in half of the records, and the true noise.
pub(super) fn noisy(seed: u64) -> Result<(Scenario, NoiseModel), Error> {
    let mut scenario = plain(seed);
    let noise = misdeclare(&mut scenario, 0.5, &mut Draw::new(seed, LEVELS))?;
    Ok((scenario, noise))
}

/// Hides noise other than declared in all instruments, in this share of the records; returns the true noise.
pub(super) fn misdeclare(
    scenario: &mut Scenario,
    share: f64,
    random: &mut Draw,
) -> Result<NoiseModel, Error> {
    let mut noise = NoiseModel::default();
    if random.uniform() >= share {
        return Ok(noise);
    }
    for (axis, name) in AXES.iter().enumerate() {
        let instruments = [
            ("gyro", &mut noise.gyro_ratio),
            ("accel", &mut noise.accel_ratio),
        ];
        for (instrument, ratios) in instruments {
            ratios[axis] = random.log_uniform(MISDECLARED);
            let id = format!("{instrument}_{name}.noise");
            let hidden = Hidden::new(&id, &[("ratio", ratios[axis])])?;
            scenario.hidden.push(hidden);
        }
    }
    Ok(noise)
}

/// An effect of a gyro that has a size only.
pub(super) fn of_gyro(gyro: usize, effect: &str, size: f64) -> Result<Hidden, Error> {
    let id = format!("gyro_{}.{effect}", AXES[gyro]);
    Ok(Hidden::new(&id, &[("size", size)])?)
}

/// A random walk of a gyro.
pub(super) fn walk(gyro: usize, random: &mut Draw) -> Result<Hidden, Error> {
    of_gyro(gyro, "random_walk", random.log_uniform(WALKS))
}

/// A record with flicker of the drifts, deg/h: sums of Gauss-Markov processes of equal variance.
pub(super) fn flickering(
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
    Ok(simulate_with(scenario, &[term])?)
}

/// Coefficients of these standard deviations, deg/h, deg/h/g and deg/h/g².
pub(super) fn coefficients(sigmas: [f64; 3], random: &mut Draw) -> Coefficients {
    let [bias, g, gg] = sigmas.map(|sigma| core::array::from_fn(|_| sigma * random.normal()));
    Coefficients {
        bias_deg_per_h: bias,
        g_deg_per_h_per_g: g,
        gg_deg_per_h_per_g2: gg,
    }
}
