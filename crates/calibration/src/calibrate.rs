//! Entry points of the calibration.

use gyrocal::{Anchored, Strapdown, Surveyed};
use gyrocal_inference::stop;
use gyrocal_record::{Bench, Record};
use nalgebra::SMatrix;

use crate::check::check_record;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::gyro_axes::GyroAxes;
use crate::options::{Method, Options};
use crate::result::Calibration;
use crate::run::Run;
use crate::settings::{declared_attitude, filter_settings};
use crate::{batch, streaming};

/// Estimates the nine coefficients from a record.
///
/// `progress` is called at intervals with the number of rows done.
///
/// # Errors
/// As [`calibrate_runs`].
pub fn calibrate(
    record: &Record,
    bench: &Bench,
    options: &Options,
    progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    calibrate_runs(&[Run { record, bench }], options, progress)
}

/// Estimates the nine coefficients from the records of several runs of one platform, each with its
/// own initial attitude and time origin.
///
/// # Errors
/// [`CalibrationError::UnequalLengths`] and [`CalibrationError::TooShort`] of a record, as
/// [`CalibrationError::OfSeveral`] if there are several;
/// [`CalibrationError::Filter`] with the row at which the filter stopped;
/// [`CalibrationError::NotConverged`] and [`CalibrationError::NoDescent`] of the batch
/// estimator; [`CalibrationError::NotPositiveDefinite`] if the covariance found is not positive
/// definite; [`CalibrationError::NoAttitude`] and [`CalibrationError::OneRecord`] of the streaming
/// filter; [`CalibrationError::Stopped`] if the job was asked to end.
pub fn calibrate_runs(
    runs: &[Run<'_>],
    options: &Options,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    calibrate_platform(runs, options, &mut progress)
}

/// Not generic: callers compile no estimator.
fn calibrate_platform(
    runs: &[Run<'_>],
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    check_records(runs)?;
    stop::finished(match (options.method, runs) {
        (Method::Batch, _) => batch::calibrate(&Anchored(Surveyed), runs, None, options, progress),
        (Method::Streaming, [run]) => streaming(run, options, progress),
        (Method::Streaming, _) => Err(CalibrationError::OneRecord { found: runs.len() }),
    })
}

/// Estimates the nine coefficients of a strapdown unit's gyros, in their own axes, from records of
/// the space-stable platform computed from their outputs. Each record has the axes of its gyros in
/// `gyro_axes`. The batch estimator is used, whatever the options say.
///
/// The coefficients are errors of the gyros' outputs. In a single attitude only one combination of
/// each gyro's coefficients is observable; records in several attitudes separate them.
///
/// # Errors
/// [`CalibrationError::GyroAxes`] if there is not one attitude of the gyros for each row;
/// otherwise as [`calibrate_runs`].
pub fn calibrate_strapdown(
    runs: &[Run<'_>],
    gyro_axes: &[GyroAxes],
    options: &Options,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    calibrate_unit(runs, gyro_axes, options, &mut progress)
}

/// Not generic: callers compile no estimator.
fn calibrate_unit(
    runs: &[Run<'_>],
    gyro_axes: &[GyroAxes],
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    check_records(runs)?;
    let rows = runs.iter().map(|run| run.record.len()).collect::<Vec<_>>();
    let attitudes = gyro_axes.iter().map(GyroAxes::len).collect::<Vec<_>>();
    if rows != attitudes {
        return Err(CalibrationError::GyroAxes {
            rows: rows.iter().sum(),
            attitudes: attitudes.iter().sum(),
        });
    }
    let model = &Anchored(Strapdown);
    let axes = Some(gyro_axes);
    stop::finished(batch::calibrate(model, runs, axes, options, progress))
}

/// Standard deviations of the coefficients from the first of several runs alone, in the order of
/// [`Calibration::covariance`]; `gyro_axes` is empty or has one entry for each run. `None` if there
/// is only one run.
///
/// # Errors
/// As [`calibrate_runs`] and [`calibrate_strapdown`] for the first run.
pub fn first_run_sigmas(
    runs: &[Run<'_>],
    gyro_axes: &[GyroAxes],
    options: &Options,
) -> Result<Option<[f64; PARAMETERS]>, CalibrationError> {
    let [first, _, ..] = runs else {
        return Ok(None);
    };
    let options = Options {
        noise: false,
        ..*options
    };
    let alone = match gyro_axes.get(..1) {
        None => calibrate_runs(&[*first], &options, |_| ()),
        Some(axes) => calibrate_strapdown(&[*first], axes, &options, |_| ()),
    }?;
    Ok(Some(alone.coefficients().map(|found| found.sigma)))
}

fn check_records(runs: &[Run<'_>]) -> Result<(), CalibrationError> {
    for (index, run) in runs.iter().enumerate() {
        check_record(run.record).map_err(|error| error.of_record(index, runs.len()))?;
    }
    Ok(())
}

/// Calibrates with the streaming filter.
fn streaming(
    run: &Run<'_>,
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    let settings = filter_settings(run.bench, options.discretisation);
    let attitude = declared_attitude(run.bench).ok_or(CalibrationError::NoAttitude)?;
    let form = options.factorised;
    let filtered = streaming::filter(run.record, &settings, &attitude, form, &mut |row| {
        if row % 1024 == 0 {
            progress(row);
        }
    })?;
    if !is_positive_definite(&filtered.covariance) {
        return Err(CalibrationError::NotPositiveDefinite);
    }
    Ok(Calibration {
        drift: filtered.drift,
        covariance: filtered.covariance,
        prior_sigma: settings.drift_sigma,
        fit: filtered.fit,
        platform_c_enu: filtered.platform_c_enu,
        final_angles_rad: filtered.angles_rad,
        iterations: 1,
        runs: Vec::new(),
        site_sensitivities: Vec::new(),
        unobservable: Vec::new(),
    })
}

/// True if a Cholesky factorisation exists, which does not depend on the units of the coefficients.
fn is_positive_definite(covariance: &[[f64; PARAMETERS]; PARAMETERS]) -> bool {
    SMatrix::<f64, PARAMETERS, PARAMETERS>::from(*covariance)
        .cholesky()
        .is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_that_is_no_covariance_is_seen() {
        let mut matrix = [[0.0; PARAMETERS]; PARAMETERS];
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = 10.0_f64.powi(-2 * i as i32);
        }
        assert!(is_positive_definite(&matrix));
        for correlation in [0.999_999, 1.000_001, f64::NAN] {
            let covariance = correlation * (matrix[2][2] * matrix[7][7]).sqrt();
            (matrix[2][7], matrix[7][2]) = (covariance, covariance);
            assert_eq!(is_positive_definite(&matrix), correlation < 1.0);
        }
    }
}
