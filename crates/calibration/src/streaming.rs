//! One pass of the streaming filter over a record.

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::{Drift, EstimationError, PlatformFilter, Settings};
use gyrocal_record::Record;

use crate::PARAMETERS;
use crate::error::CalibrationError;
use crate::fit::Fit;

/// What the filter holds after the last row.
pub(crate) struct Filtered {
    pub(crate) drift: Drift<f64>,
    pub(crate) covariance: [[f64; PARAMETERS]; PARAMETERS],
    pub(crate) fit: Fit,
    pub(crate) platform_c_enu: [[f64; 3]; 3],
    pub(crate) angles_rad: [f64; 3],
}

/// Filters a record; `watch` is called after each row with its number.
pub(crate) fn filter(
    record: &Record,
    settings: &Settings<f64>,
    factorised: bool,
    watch: impl FnMut(usize),
) -> Result<Filtered, CalibrationError> {
    if factorised {
        filter_in::<Factors>(record, settings, watch)
    } else {
        filter_in::<Covariance>(record, settings, watch)
    }
}

fn filter_in<F: Form<f64>>(
    record: &Record,
    settings: &Settings<f64>,
    mut watch: impl FnMut(usize),
) -> Result<Filtered, CalibrationError> {
    let at = |row: usize| {
        move |source: EstimationError| CalibrationError::Filter {
            row: row + 1,
            time_s: record.time_s[row],
            source,
        }
    };
    let mut filter = PlatformFilter::<f64, F>::with_form(settings).map_err(at(0))?;
    let mut fit = Fit::of_nothing();
    fit.add(&filter.update(&record.accel_g[0]).map_err(at(0))?);
    watch(0);
    for row in 1..record.len() {
        let interval_s = record.time_s[row] - record.time_s[row - 1];
        fit.add(
            &filter
                .step(interval_s, &record.accel_g[row])
                .map_err(at(row))?,
        );
        watch(row);
    }
    Ok(Filtered {
        drift: filter.drift(),
        covariance: filter.drift_covariance(),
        fit,
        platform_c_enu: filter.platform_c_enu(),
        angles_rad: filter.angles_rad(),
    })
}
