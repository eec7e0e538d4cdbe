//! Maximum-likelihood estimate of the noise relative to the declared noise.

use gyrocal::estimation::EstimationError;
use gyrocal_inference::NoiseScore;
use gyrocal_record::{Bench, NoiseEstimate, NoiseRatio};
use gyrocal_statistics::NORMAL_97_5;
use nalgebra::{Cholesky, DMatrix, DVector};

/// Most steps of Fisher's scoring; four bring a variance that is off by a factor of a hundred within
/// a hundredth of its sigma.
const MAX_STEPS: usize = 12;

/// Largest step in the logarithm of a variance.
const LARGEST_STEP: f64 = 2.0;

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

/// Maximises the likelihood over the logarithms of six variances by Fisher's scoring.
pub(crate) fn estimate(
    score: impl Fn(&[f64]) -> Result<NoiseScore, EstimationError>,
) -> Result<NoiseEstimate, EstimationError> {
    let mut logarithm = DVector::<f64>::zeros(6);
    let mut sigma = DVector::<f64>::repeat(6, f64::INFINITY);
    for _ in 0..MAX_STEPS {
        let factors: Vec<f64> = logarithm.iter().map(|value| value.exp()).collect();
        let found = score(&factors)?;
        // A noise far below the others is unobservable: a prior of e^10 about the declared one keeps
        // its logarithm finite and has no weight where the noise is observable.
        let prior = 1e-2;
        // Random walks come last and are held.
        let stride = found.d_log_variance.len();
        let mut information = DMatrix::from_fn(6, 6, |i, j| found.information[i * stride + j]);
        let mut gradient = DVector::from_iterator(6, found.gradient().into_iter().take(6));
        for i in 0..6 {
            information[(i, i)] += prior;
            gradient[i] -= prior * logarithm[i];
        }
        let Some(cholesky) = Cholesky::new(information) else {
            break;
        };
        let step = cholesky.solve(&gradient);
        let inverse = cholesky.inverse();
        sigma = inverse.diagonal().map(f64::sqrt);
        logarithm += step.map(|step| step.clamp(-LARGEST_STEP, LARGEST_STEP));
        if step
            .iter()
            .zip(sigma.iter())
            .all(|(step, sigma)| step.abs() < 0.01 * sigma)
        {
            break;
        }
    }
    let ratio = |index: usize| {
        let at = |logarithm: f64| (0.5 * logarithm).exp();
        NoiseRatio {
            ratio: at(logarithm[index]),
            interval: [-1.0, 1.0]
                .map(|side| at(logarithm[index] + side * NORMAL_97_5 * sigma[index])),
        }
    };
    Ok(NoiseEstimate {
        accel: core::array::from_fn(ratio),
        gyro: [3, 4, 5].map(ratio),
    })
}
