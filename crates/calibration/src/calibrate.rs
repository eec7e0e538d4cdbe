use gyrocal::estimation::form::Form;
use gyrocal::estimation::{Covariance, Factors};
use gyrocal::generated::platform::DRIFT;
use gyrocal::{
    Drift, EstimationError, Integration, Platform, PlatformFilter, Recentring, Settings,
};
use gyrocal_record::{Bench, Record};
use nalgebra::SMatrix;

use crate::error::CalibrationError;
use crate::fit::Fit;
use crate::settings::settings;

const PARAMETERS: usize = Platform::PARAMETERS;

/// A posterior sigma below this share of the prior's counts as determined by the record.
const DETERMINED: f64 = 0.1;

/// How a record is filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How the angles are integrated over a step.
    pub integration: Integration,
    /// When the chart moves.
    pub recentring: Recentring<f64>,
    /// Longest interval integrated in one step, s; longer ones are divided.
    pub longest_step_s: f64,
    /// Whether the covariance is carried as its factors: slower, for priors that are too wide
    /// otherwise.
    pub factorised: bool,
}

impl Default for Options {
    /// RK4, chart moved at every step, steps of at most two minutes, the covariance itself.
    fn default() -> Self {
        Self {
            integration: Integration::RK4,
            recentring: Recentring::EveryStep,
            longest_step_s: 120.0,
            factorised: false,
        }
    }
}

impl Options {
    /// The paper's own filter: Euler angles in one chart, one Euler step a sample.
    #[must_use]
    pub fn of_the_paper() -> Self {
        Self {
            integration: Integration::EULER,
            recentring: Recentring::Never,
            longest_step_s: f64::INFINITY,
            factorised: false,
        }
    }
}

/// What a record said of the gyros.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Estimated coefficients: deg/h, deg/h/g, deg/h/g².
    pub drift: Drift<f64>,
    /// Covariance of their errors, in the order of the fields.
    pub covariance: [[f64; PARAMETERS]; PARAMETERS],
    /// Standard deviations before the record.
    pub prior_sigma: Drift<f64>,
    /// Agreement of the innovations with their predicted covariance.
    pub fit: Fit,
    /// Platform components from East, North, Up components at the last row.
    pub platform_c_enu: [[f64; 3]; 3],
    /// Platform angles against East-North-Up at the last row, rad.
    pub final_angles_rad: [f64; 3],
}

/// One estimated coefficient with its name and unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientEstimate {
    /// Public name, such as `gyro_x.bias`.
    pub id: &'static str,
    /// Unit of estimate and sigma.
    pub unit: &'static str,
    /// Meaning in a few words.
    pub meaning: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Standard deviation of its error.
    pub sigma: f64,
    /// Whether the record, and not the prior, determined it.
    pub determined: bool,
}

impl Calibration {
    /// The coefficients with names, in the order of [`Self::covariance`].
    #[must_use]
    pub fn coefficients(&self) -> [CoefficientEstimate; PARAMETERS] {
        let (estimates, priors) = (self.drift.to_array(), self.prior_sigma.to_array());
        core::array::from_fn(|i| {
            let sigma = self.covariance[i][i].sqrt();
            CoefficientEstimate {
                id: DRIFT[i].id,
                unit: DRIFT[i].unit,
                meaning: DRIFT[i].doc,
                estimate: estimates[i],
                sigma,
                determined: sigma < DETERMINED * priors[i],
            }
        })
    }
}

/// Estimates the nine coefficients from a record in one pass of the streaming filter.
///
/// `progress` is called now and then with the number of rows done.
///
/// # Errors
/// [`CalibrationError::UnequalLengths`] and [`CalibrationError::TooShort`] of a record;
/// [`CalibrationError::Filter`] with the row at which the filter stopped;
/// [`CalibrationError::NotPositiveDefinite`] if the covariance that it found is none.
pub fn calibrate(
    record: &Record,
    bench: &Bench,
    options: &Options,
    progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    check(record)?;
    let settings = Settings {
        integration: options.integration,
        recentring: options.recentring,
        longest_step_s: options.longest_step_s,
        ..settings(bench)
    };
    if options.factorised {
        filtered::<Factors>(record, &settings, progress)
    } else {
        filtered::<Covariance>(record, &settings, progress)
    }
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

fn filtered<F: Form<f64>>(
    record: &Record,
    settings: &Settings<f64>,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
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
    for row in 1..record.len() {
        let interval_s = record.time_s[row] - record.time_s[row - 1];
        fit.add(
            &filter
                .step(interval_s, &record.accel_g[row])
                .map_err(at(row))?,
        );
        if row % 1024 == 0 {
            progress(row);
        }
    }
    let covariance = filter.drift_covariance();
    if !is_positive_definite(&covariance) {
        return Err(CalibrationError::NotPositiveDefinite);
    }
    Ok(Calibration {
        drift: filter.drift(),
        covariance,
        prior_sigma: settings.drift_sigma,
        fit,
        platform_c_enu: filter.platform_c_enu(),
        final_angles_rad: filter.angles_rad(),
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
