//! Maximum-likelihood estimate of the noise relative to the declared noise.

use gyrocal_inference::{Asked, Maximum, NoiseScore, Restricted, UnknownNoise};
use gyrocal_record::{AXES, Bench, NoiseEstimate, NoiseRatio};
use nalgebra::{Cholesky, DVector};

use crate::error::CalibrationError;

/// Most steps of Fisher's scoring; four bring a variance that is off by a factor of a hundred within
/// a hundredth of its sigma.
const MAX_STEPS: usize = 12;

/// Gain of the log-likelihood that a step expects below which it is not made: a hundredth of each sigma.
const LEAST_GAIN: f64 = 5e-5;

/// Precision of the logarithm of a variance over the declared one before a record: a noise far below the others is
/// unobservable. A prior of e^10 keeps its logarithm finite and has no weight where the noise is observable.
const PRIOR_PRECISION: f64 = 1e-2;

/// White noise of a gyro, held over one minute, below which a bench description is implausible: it
/// moves a platform by 1e-9 rad in a day, a ten-thousandth of the resolution of one sample of a good
/// accelerometer (1e-5 g).
const LEAST_GYRO_DEG_PER_H: f64 = 1e-7;

/// True if a bench description declares a gyro noise so small that a fit may fail to converge because
/// of it.
#[must_use]
pub fn is_gyro_noise_implausible(bench: &Bench) -> bool {
    bench.gyro_noise_deg_per_h < LEAST_GYRO_DEG_PER_H
}

/// Maximises the likelihood over the logarithms of six variances by Fisher's scoring; intervals are by the profile of
/// the likelihood. `score_from` gives the score with the derivatives by the noises from one on.
pub(crate) fn estimate(
    score_from: impl Fn(&[f64], usize) -> Result<NoiseScore, CalibrationError>,
) -> Result<NoiseEstimate, CalibrationError> {
    let noises = (0..2 * AXES.len()).map(|factor| UnknownNoise {
        factor,
        prior: Some((0.0, PRIOR_PRECISION)),
        is_held: false,
    });
    let restricted = Restricted {
        values: &[],
        sigmas: &[],
        integrated: Vec::new(),
        absent: &[],
        noises: noises.collect(),
    };
    let factors = |logarithms: &[f64]| -> Vec<f64> {
        logarithms.iter().map(|logarithm| logarithm.exp()).collect()
    };
    let mut score = |asked: Asked<'_>| {
        let first = if asked.with_derivatives {
            0
        } else {
            usize::MAX
        };
        score_from(&factors(asked.logarithms), first)
    };
    let start = DVector::zeros(2 * AXES.len());
    let (logarithms, at) = restricted.maximise(start, (LEAST_GAIN, MAX_STEPS), &mut score)?;
    let covariance = Cholesky::new(at.information)
        .ok_or(CalibrationError::NotPositiveDefinite)?
        .inverse();
    let maximum = Maximum {
        logarithms: &logarithms,
        covariance: &covariance,
        value: at.value,
    };
    let mut value = |moved: &[f64]| restricted.value(moved, &mut score).ok();
    let mut ratio = |index: usize| NoiseRatio {
        ratio: (0.5 * logarithms[index]).exp(),
        interval: maximum.sizes(index, &mut value),
    };
    Ok(NoiseEstimate {
        accel: core::array::from_fn(&mut ratio),
        gyro: [3, 4, 5].map(ratio),
    })
}
