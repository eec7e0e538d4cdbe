//! Magnitude of specific force at rest.

use gyrocal_record::Gravity;
use gyrocal_statistics::upper_median;
use nalgebra::{DMatrix, DVector};

use crate::finding::SetupFinding;
use crate::kind::SetupKind;
use crate::samples::{Complete, Samples};
use crate::text::number;
use crate::unit;
use crate::vector::norm;

/// Relative error of gravity that is left to the fine diagnosis: accelerometers are no better.
const LEAST_ERROR: f64 = 5e-5;

/// The mean must be so many standard errors off.
const STANDARD_ERRORS: f64 = 12.0;

/// What varies with the attitude may be at most this share of what does not: biases and gains of
/// single accelerometers are left to the fine diagnosis. Of a bias the part along the axis of the Earth does not
/// vary: it must lie within four degrees of it to be taken for gravity.
const MOST_VARYING: f64 = 0.05;

/// An error of the magnitude that is neither gravity's nor left to the diagnosis.
const NO_GRAVITY: f64 = 0.1;

/// Standard gravity, which a record may have been divided by in place of the local one.
const STANDARD_M_PER_S2: f64 = 9.806_65;

/// Local gravity lies between these.
const LOCAL_M_PER_S2: core::ops::RangeInclusive<f64> = 9.76..=9.84;

/// Fewest complete rows.
const LEAST_ROWS: usize = 30;

/// A magnitude that is wrong by the same share at all attitudes. It is corrected.
pub(crate) fn find(samples: &mut Samples<'_>) -> Vec<SetupFinding> {
    let complete = samples.complete();
    if complete.len() < LEAST_ROWS {
        return Vec::new();
    }
    let off: Vec<f64> = complete
        .iter()
        .map(|sample| norm(sample.force_g) / samples.rest_g - 1.0)
        .collect();
    let middle = upper_median(&mut off.clone()).unwrap_or(0.0);
    let is_uniform = !varies(&complete, &off, middle);
    if middle.abs() > NO_GRAVITY && !is_uniform {
        return vec![unit::finding(1.0 + middle, None)];
    }
    let error = standard_error(samples, &complete, &off, middle);
    let limit = LEAST_ERROR.max(STANDARD_ERRORS * error);
    if middle.abs() <= limit || !is_uniform {
        return Vec::new();
    }
    let finding = finding(samples, middle, error);
    for row in &mut samples.accel_g {
        *row = row.map(|value| value / (1.0 + middle));
    }
    samples.look_again();
    vec![finding]
}

/// Of the median magnitude, from the larger of the noise and the scatter of the magnitudes.
fn standard_error(samples: &Samples<'_>, complete: &[Complete], off: &[f64], middle: f64) -> f64 {
    let mut sizes: Vec<f64> = off.iter().map(|value| (value - middle).abs()).collect();
    let scatter = gyrocal_statistics::robust_sigma(&mut sizes);
    scatter.max(samples.sigma_g() / samples.rest_g) / (complete.len() as f64).sqrt()
}

/// Whether biases and gains of single axes explain more than a part of the magnitudes.
fn varies(complete: &[Complete], off: &[f64], middle: f64) -> bool {
    /// Rows that are enough for five unknowns.
    const ROWS: usize = 2000;
    let stride = complete.len().div_ceil(ROWS);
    let rows: Vec<(&Complete, f64)> = complete
        .iter()
        .zip(off.iter().copied())
        .step_by(stride)
        .collect();
    let terms = |sample: &Complete| {
        let [x, y, z] = sample.up;
        [1.0, x, y, z, x * x - z * z, y * y - z * z]
    };
    let matrix = DMatrix::from_fn(rows.len(), 6, |row, term| terms(rows[row].0)[term]);
    let right = DVector::from_iterator(rows.len(), rows.iter().map(|(_, value)| *value));
    // A vertical that hardly moves leaves combinations open: the smallest solution is meant.
    let Ok(solved) = (matrix.transpose() * &matrix + DMatrix::identity(6, 6) * 1e-6)
        .cholesky()
        .ok_or(())
        .map(|factor| factor.solve(&(matrix.transpose() * &right)))
    else {
        return false;
    };
    let fitted = &matrix * solved;
    let mean = fitted.mean();
    let variance = fitted
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>()
        / fitted.len() as f64;
    variance.sqrt() > MOST_VARYING * middle.abs()
}

fn finding(samples: &Samples<'_>, middle: f64, error: f64) -> SetupFinding {
    let ratio = 1.0 + middle;
    let description = format!(
        "Specific force at rest is {} at all attitudes, {} is declared: gravity at the site, the \
         unit of the record or a common scale is another. It is corrected; give {} and {} in [site].",
        six_digits(ratio * samples.rest_g),
        six_digits(samples.rest_g),
        Gravity::KEYS[0],
        Gravity::KEYS[1],
    );
    let evidence = format!(
        "the median magnitude is off by {:.2e} of it, with a standard error of {:.1e}",
        middle, error
    );
    let mut finding = SetupFinding::new(SetupKind::Gravity, description, evidence);
    let local = STANDARD_M_PER_S2 * ratio;
    if LOCAL_M_PER_S2.contains(&local) {
        finding = finding.or(
            SetupKind::Gravity,
            format!("standard g as the unit, with local gravity of {local:.4} m/s^2"),
        );
    }
    finding
        .or(
            SetupKind::Scale,
            format!(
                "a common scale of all accelerometers of {}",
                six_digits(ratio)
            ),
        )
        .or(
            SetupKind::Scale,
            format!(
                "a bias of accelerometers of {} g along the axis of the Earth",
                number(middle.abs())
            ),
        )
}

fn six_digits(value: f64) -> String {
    format!("{value:.6}")
}
