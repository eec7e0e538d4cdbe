//! The streaming filter over a record.

use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::generated::strapdown::StrapdownInputs;
use gyrocal::{
    Drift, EstimationError, ExtensionFilter, FilterSettings, InitialAttitude, Innovation,
    PlatformFilter, Strapdown,
};
use gyrocal_inference::stop;
use gyrocal_record::Record;

use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fit::FitStatistics;
use crate::gyro_axes::GyroAxes;
use crate::work;

/// Estimates of the filter after the last row.
pub(crate) struct Filtered {
    pub(crate) drift: Drift<f64>,
    pub(crate) covariance: [[f64; PARAMETERS]; PARAMETERS],
    pub(crate) fit: FitStatistics,
    pub(crate) platform_c_enu: [[f64; 3]; 3],
    pub(crate) angles_rad: [f64; 3],
}

/// Runs the streaming filter over a record; `watch` is called after each row with its number.
pub(crate) fn filter(
    record: &Record,
    settings: &FilterSettings<f64>,
    attitude: &InitialAttitude<f64>,
    factorised: bool,
    watch: &mut dyn FnMut(usize),
) -> Result<Filtered, CalibrationError> {
    if factorised {
        filter_in::<Factors>(record, settings, attitude, watch)
    } else {
        filter_in::<Covariance>(record, settings, attitude, watch)
    }
}

fn filter_in<F: Form<f64>>(
    record: &Record,
    settings: &FilterSettings<f64>,
    attitude: &InitialAttitude<f64>,
    watch: &mut dyn FnMut(usize),
) -> Result<Filtered, CalibrationError> {
    let mut fit = FitStatistics::of_nothing();
    let filter = PlatformFilter::<f64, F>::with_form(settings, attitude);
    let filter = run_filter(record, record.len(), filter, |row, _, innovation| {
        fit.add(innovation);
        watch(row);
    })?;
    Ok(Filtered {
        drift: filter.drift(),
        covariance: filter.drift_covariance(),
        fit,
        platform_c_enu: filter.platform_c_enu(),
        angles_rad: filter.angles_rad(),
    })
}

/// Runs the streaming filter, its covariance in factors, over a record. `watch` gets each row
/// number, the filter after the update, and the innovation.
///
/// # Errors
/// [`CalibrationError::Filter`] with the row at which the filter stopped; the first row if it
/// cannot be made.
pub fn run_factorised_filter(
    record: &Record,
    settings: &FilterSettings<f64>,
    attitude: &InitialAttitude<f64>,
    watch: &mut FilterWatch<'_>,
) -> Result<(), CalibrationError> {
    let filter = PlatformFilter::<f64, Factors>::with_form(settings, attitude);
    run_filter(record, record.len(), filter, watch).map(|_| ())
}

/// Runs the streaming filter of a strapdown unit, whose law holds in the axes of its gyros, over a record.
/// `watch` gets each row number, specific force along the platform as the filter knows it \[g\], and the
/// innovation.
///
/// # Errors
/// As [`run_factorised_filter`], and [`CalibrationError::GyroAxes`] if there is not one attitude for each row.
pub fn run_strapdown_filter(
    record: &Record,
    axes: &GyroAxes,
    settings: &FilterSettings<f64>,
    attitude: &InitialAttitude<f64>,
    watch: &mut StrapdownWatch<'_>,
) -> Result<(), CalibrationError> {
    let (rows, attitudes) = (record.len(), axes.len());
    if rows != attitudes {
        return Err(CalibrationError::GyroAxes { rows, attitudes });
    }
    let at = |row: usize| {
        move |source: EstimationError| CalibrationError::Filter {
            row: row + 1,
            time_s: record.time_s[row],
            source,
        }
    };
    let start = [[0.0, KNOWN]; Strapdown::PARAMETERS - PARAMETERS];
    let filter = StrapdownFilter::new(Strapdown, start, settings, attitude);
    let mut filter = filter.map_err(at(0))?;
    for row in 0..rows {
        stop::check_at(row)?;
        work::count_filtered_row();
        let interval_s = match row {
            0 => 0.0,
            _ => record.time_s[row] - record.time_s[row - 1],
        };
        filter.inputs_mut().platform_c_gyros = axes.between(row.saturating_sub(1), 0.5);
        let innovation = filter
            .take(interval_s, &record.accel_g[row])
            .map_err(at(row))?;
        watch(row, filter.filter().inputs().inputs().f_0, &innovation);
    }
    Ok(())
}

/// Sees a row number, specific force along the platform \[g\], and the innovation.
pub type StrapdownWatch<'a> = dyn FnMut(usize, [f64; 3], &Innovation<f64, 3>) + 'a;

/// The filter of a strapdown unit.
type StrapdownFilter = ExtensionFilter<f64, Strapdown, StrapdownInputs<f64>, { Strapdown::STATES }>;

/// Standard deviation of a parameter that is known: a filter takes none of zero.
const KNOWN: f64 = 1e-12;

/// Sees a row number, the filter after the update, and the innovation.
pub type FilterWatch<'a> =
    dyn FnMut(usize, &PlatformFilter<f64, Factors>, &Innovation<f64, 3>) + 'a;

/// Runs a filter over the first `rows` rows of a record. `watch` gets each row number, the filter
/// after the update, and the innovation.
///
/// # Errors
/// [`CalibrationError::Filter`] with the row at which the filter stopped; the first row if
/// `filter` is an error.
pub(crate) fn run_filter<F: Form<f64>>(
    record: &Record,
    rows: usize,
    filter: Result<PlatformFilter<f64, F>, EstimationError>,
    mut watch: impl FnMut(usize, &PlatformFilter<f64, F>, &Innovation<f64, 3>),
) -> Result<PlatformFilter<f64, F>, CalibrationError> {
    let at = |row: usize| {
        move |source: EstimationError| CalibrationError::Filter {
            row: row + 1,
            time_s: record.time_s[row],
            source,
        }
    };
    let mut filter = filter.map_err(at(0))?;
    for row in 0..rows {
        stop::check_at(row)?;
        work::count_filtered_row();
        if row > 0 {
            let interval_s = record.time_s[row] - record.time_s[row - 1];
            filter.predict(interval_s).map_err(at(row))?;
        }
        let innovation = filter.update(&record.accel_g[row]).map_err(at(row))?;
        watch(row, &filter, &innovation);
    }
    Ok(filter)
}
