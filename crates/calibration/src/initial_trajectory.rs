//! Initial trajectory of the Gauss-Newton iteration: the filtered attitudes of a record.

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::trajectory::Orientation;
use gyrocal::{EstimationError, FilterSettings, InitialAttitude, PlatformFilter};
use gyrocal_record::Record;

use crate::attitude::AttitudePrior;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::streaming::run_filter;

/// Filtered attitudes of a record, and the coefficients after its last row.
pub(crate) struct InitialTrajectory {
    /// Filtered attitude at each row.
    pub(crate) points: Vec<Orientation>,
    /// Coefficients: deg/h, deg/h/g, deg/h/g².
    pub(crate) drift: [f64; PARAMETERS],
    /// Their standard deviations.
    pub(crate) sigma: [f64; PARAMETERS],
    /// Mean NIS over the values used, 1 expected.
    pub(crate) nis_mean: f64,
    /// Whether it was made by growing windows.
    pub(crate) by_windows: bool,
}

/// Filters the first `rows` rows from an attitude; on the factors of the covariance if the
/// covariance itself loses its precision.
pub(crate) fn filtered_trajectory(
    record: &Record,
    rows: usize,
    settings: &FilterSettings<f64>,
    attitude: &AttitudePrior,
) -> Result<InitialTrajectory, CalibrationError> {
    match filtered_in_form::<Covariance>(record, rows, settings, attitude) {
        Err(CalibrationError::Filter {
            source:
                EstimationError::LostPrecision { .. } | EstimationError::NotPositiveDefinite { .. },
            ..
        }) => filtered_in_form::<Factors>(record, rows, settings, attitude),
        other => other,
    }
}

fn filtered_in_form<F: Form<f64>>(
    record: &Record,
    rows: usize,
    settings: &FilterSettings<f64>,
    attitude: &AttitudePrior,
) -> Result<InitialTrajectory, CalibrationError> {
    // The filter takes independent sigmas about the axes: near enough for an initial guess.
    let attitude = InitialAttitude::Orientation {
        north_and_up: attitude.orientation,
        sigma_rad: core::array::from_fn(|i| attitude.covariance[i][i].sqrt()),
    };
    let filter = PlatformFilter::<f64, F>::with_form(settings, &attitude);
    let mut points = Vec::with_capacity(rows);
    let (mut nis, mut values) = (0.0, 0);
    let filter = run_filter(record, rows, filter, |_, filter, innovation| {
        nis += innovation.nis;
        values += innovation.degrees_of_freedom();
        points.push(filter.kernel().inputs().orientation());
    })?;
    Ok(InitialTrajectory {
        points,
        drift: filter.drift().to_array(),
        sigma: filter.drift_sigma().to_array(),
        nis_mean: nis / values.max(1) as f64,
        by_windows: false,
    })
}
