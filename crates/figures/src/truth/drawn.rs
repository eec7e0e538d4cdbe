//! What the records of several populations are drawn of: scenarios, noise other than declared, walks.

use gyrocal_calibration::NoiseModel;
use gyrocal_evaluation::scenario;
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, Hidden, Scenario};

use crate::harness::Error;

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
        let ratios = [&mut noise.gyro_ratio[axis], &mut noise.accel_ratio[axis]];
        for (ratio, instrument) in ratios.into_iter().zip(["gyro", "accel"]) {
            *ratio = random.log_uniform(MISDECLARED);
            let id = format!("{instrument}_{name}.noise");
            scenario
                .hidden
                .push(Hidden::new(&id, &[("ratio", *ratio)])?);
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

/// Coefficients of these standard deviations, deg/h, deg/h/g and deg/h/g².
pub(super) fn coefficients(sigmas: [f64; 3], random: &mut Draw) -> Coefficients {
    let [bias, g, gg] = sigmas.map(|sigma| core::array::from_fn(|_| sigma * random.normal()));
    Coefficients {
        bias_deg_per_h: bias,
        g_deg_per_h_per_g: g,
        gg_deg_per_h_per_g2: gg,
    }
}
