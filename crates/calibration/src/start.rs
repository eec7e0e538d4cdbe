//! A trajectory near enough to the solution for Gauss-Newton steps to begin.

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::trajectory::Orientation;
use gyrocal::{EstimationError, PlatformFilter, Settings};
use gyrocal_record::Record;

use crate::PARAMETERS;
use crate::attitude::InitialAttitude;
use crate::error::CalibrationError;
use crate::streaming::run_filter;

/// What one pass of the filter leaves.
pub(crate) struct Start {
    /// Filtered attitude at each row.
    pub(crate) points: Vec<Orientation>,
    pub(crate) drift: [f64; PARAMETERS],
    pub(crate) sigma: [f64; PARAMETERS],
    /// Mean NIS over the values used, 1 expected.
    pub(crate) nis_mean: f64,
}

/// Filters the first `rows` rows from an attitude, on the factors of the covariance if the
/// covariance itself loses its digits.
pub(crate) fn filtered(
    record: &Record,
    rows: usize,
    settings: &Settings<f64>,
    attitude: &InitialAttitude,
) -> Result<Start, CalibrationError> {
    match filtered_in::<Covariance>(record, rows, settings, attitude) {
        Err(CalibrationError::Filter {
            source:
                EstimationError::LostPrecision { .. } | EstimationError::NotPositiveDefinite { .. },
            ..
        }) => filtered_in::<Factors>(record, rows, settings, attitude),
        other => other,
    }
}

fn filtered_in<F: Form<f64>>(
    record: &Record,
    rows: usize,
    settings: &Settings<f64>,
    attitude: &InitialAttitude,
) -> Result<Start, CalibrationError> {
    // The filter takes independent sigmas about the axes: near enough for a start.
    let sigma_rad = core::array::from_fn(|i| attitude.covariance[i][i].sqrt());
    let filter = PlatformFilter::<f64, F>::at_attitude(settings, &attitude.orientation, &sigma_rad);
    let mut points = Vec::with_capacity(rows);
    let (mut nis, mut values) = (0.0, 0);
    let filter = run_filter(record, rows, filter, |_, filter, innovation| {
        nis += innovation.nis;
        values += innovation.degrees_of_freedom();
        points.push(filter.kernel().inputs().orientation());
    })?;
    Ok(Start {
        points,
        drift: filter.drift().to_array(),
        sigma: filter.drift_sigma().to_array(),
        nis_mean: nis / values.max(1) as f64,
    })
}
