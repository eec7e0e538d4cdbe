//! A trajectory near enough to the solution for Gauss-Newton steps to begin.

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::trajectory::Orientation;
use gyrocal::{EstimationError, PlatformFilter, Settings};
use gyrocal_record::Record;

use crate::PARAMETERS;
use crate::attitude::InitialAttitude;
use crate::error::CalibrationError;

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
    match pass::<Covariance>(record, rows, settings, attitude) {
        Err(CalibrationError::Filter {
            source:
                EstimationError::LostPrecision { .. } | EstimationError::NotPositiveDefinite { .. },
            ..
        }) => pass::<Factors>(record, rows, settings, attitude),
        other => other,
    }
}

fn pass<F: Form<f64>>(
    record: &Record,
    rows: usize,
    settings: &Settings<f64>,
    attitude: &InitialAttitude,
) -> Result<Start, CalibrationError> {
    let at = |row: usize| {
        move |source: EstimationError| CalibrationError::Filter {
            row: row + 1,
            time_s: record.time_s[row],
            source,
        }
    };
    // The filter takes independent sigmas about the axes: near enough for a start.
    let sigma_rad = core::array::from_fn(|i| attitude.covariance[i][i].sqrt());
    let mut filter =
        PlatformFilter::<f64, F>::at_attitude(settings, &attitude.orientation, &sigma_rad)
            .map_err(at(0))?;
    let mut points = Vec::with_capacity(record.len());
    let (mut nis, mut values) = (0.0, 0);
    for row in 0..rows {
        if row > 0 {
            let interval_s = record.time_s[row] - record.time_s[row - 1];
            filter.predict(interval_s).map_err(at(row))?;
        }
        let innovation = filter.update(&record.accel_g[row]).map_err(at(row))?;
        nis += innovation.nis;
        values += innovation.degrees_of_freedom();
        points.push(filter.kernel().inputs().orientation());
    }
    Ok(Start {
        points,
        drift: filter.drift().to_array(),
        sigma: filter.drift_sigma().to_array(),
        nis_mean: nis / f64::from(u32::try_from(values.max(1)).unwrap_or(u32::MAX)),
    })
}
