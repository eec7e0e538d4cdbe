use gyrocal::generated::platform::DRIFT;
use gyrocal::{
    Drift, EstimationError, Innovation, Integration, Platform, PlatformFilter, Recentring,
};

const PARAMETERS: usize = Platform::PARAMETERS;
use gyrocal_record::{Bench, Record};

use crate::error::CalibrationError;
use crate::fit::Fit;
use crate::settings::settings;

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
}

impl Default for Options {
    /// RK4, chart moved at every step, steps of at most two minutes.
    fn default() -> Self {
        Self {
            integration: Integration::RK4,
            recentring: Recentring::EveryStep,
            longest_step_s: 120.0,
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
/// [`CalibrationError::TooShort`], or [`CalibrationError::Filter`] with the row at which the
/// filter stopped.
pub fn calibrate(
    record: &Record,
    bench: &Bench,
    options: &Options,
    mut progress: impl FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    if record.len() < Platform::STATES {
        return Err(CalibrationError::TooShort {
            found: record.len(),
            expected: Platform::STATES,
        });
    }
    let mut settings = settings(bench);
    settings.integration = options.integration;
    settings.recentring = options.recentring;
    settings.longest_step_s = options.longest_step_s;
    let at = |row: usize| {
        move |source: EstimationError| CalibrationError::Filter {
            row: row + 1,
            time_s: record.time_s[row],
            source,
        }
    };
    let mut filter = PlatformFilter::new(&settings).map_err(at(0))?;
    let mut fit = Fit {
        nis_sum: 0.0,
        values: 0,
        rows: 0,
        log_likelihood: 0.0,
    };
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
    Ok(Calibration {
        drift: filter.drift(),
        covariance: filter.drift_covariance(),
        prior_sigma: settings.drift_sigma,
        fit,
        platform_c_enu: filter.platform_c_enu(),
        final_angles_rad: filter.angles_rad(),
    })
}

impl Fit {
    fn add(&mut self, innovation: &Innovation<f64, 3>) {
        let values = innovation.degrees_of_freedom();
        self.nis_sum += innovation.nis;
        self.values += values;
        self.rows += usize::from(values > 0);
        self.log_likelihood += innovation.log_likelihood();
    }
}
