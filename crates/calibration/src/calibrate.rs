use gyrocal::{Anchored, Platform, Strapdown, Surveyed};
use gyrocal_record::{Bench, Record};
use nalgebra::SMatrix;

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
/// `progress` is called now and then with the number of rows done.
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

/// Estimates the nine coefficients from the records of several runs of one platform, each with
/// its own initial attitude and start.
///
/// # Errors
/// [`CalibrationError::UnequalLengths`] and [`CalibrationError::TooShort`] of a record, as
/// [`CalibrationError::OfSeveral`] if there are several;
/// [`CalibrationError::Filter`] with the row at which the filter stopped;
/// [`CalibrationError::NotConverged`] and [`CalibrationError::NoDescent`] of the batch
/// estimator; [`CalibrationError::NotPositiveDefinite`] if the covariance that was found is
/// none; [`CalibrationError::NoAttitude`] and [`CalibrationError::OneRecord`] of the streaming
/// filter.
pub fn calibrate_runs(
    runs: &[Run<'_>],
    options: &Options,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    for (index, run) in runs.iter().enumerate() {
        check(run.record).map_err(|error| error.of_record(index, runs.len()))?;
    }
    match (options.method, runs) {
        (Method::Batch, _) => {
            batch::calibrate(&Anchored(Surveyed), runs, None, options, &mut progress)
        }
        (Method::Streaming, [run]) => streaming(run, options, &mut progress),
        (Method::Streaming, _) => Err(CalibrationError::OneRecord { found: runs.len() }),
    }
}

/// Estimates the nine coefficients of a strapdown unit's gyros, in their own axes, from the
/// records of the space-stable platform that was computed from their outputs: one record or
/// several of one unit, each with the axes of its gyros. Always by the batch estimator.
///
/// Coefficients are errors of the gyros' outputs. In one attitude, however long, all of a gyro's
/// are one number; records in other attitudes tell them apart.
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
    for (index, run) in runs.iter().enumerate() {
        check(run.record).map_err(|error| error.of_record(index, runs.len()))?;
    }
    let rows = runs.iter().map(|run| run.record.len()).collect::<Vec<_>>();
    let attitudes = gyro_axes.iter().map(GyroAxes::len).collect::<Vec<_>>();
    if rows != attitudes {
        return Err(CalibrationError::GyroAxes {
            rows: rows.iter().sum(),
            attitudes: attitudes.iter().sum(),
        });
    }
    let model = &Anchored(Strapdown);
    batch::calibrate(model, runs, Some(gyro_axes), options, &mut progress)
}

/// A row in which all accelerometers say `NaN` counts for nothing.
fn check(record: &Record) -> Result<(), CalibrationError> {
    if record.time_s.len() != record.accel_g.len() {
        return Err(CalibrationError::UnequalLengths {
            times: record.time_s.len(),
            samples: record.accel_g.len(),
        });
    }
    let measured = |row: &&[f64; 3]| row.iter().any(|component| !component.is_nan());
    let found = record.accel_g.iter().filter(measured).count();
    if found < Platform::STATES {
        return Err(CalibrationError::TooShort {
            found,
            expected: Platform::STATES,
        });
    }
    Ok(())
}

/// One pass of the streaming filter.
fn streaming(
    run: &Run<'_>,
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    let settings = filter_settings(run.bench, options.discretisation);
    let attitude = declared_attitude(run.bench).ok_or(CalibrationError::NoAttitude)?;
    let form = options.factorised;
    let filtered = streaming::filter(run.record, &settings, &attitude, form, |row| {
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

/// Cholesky's factorisation is the test; it does not depend on the units of the coefficients.
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
