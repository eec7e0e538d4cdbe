//! Import of a strapdown unit as an analytic platform: its accelerometers in axes that its gyros hold
//! in inertial space by computation.
//!
//! With the error δω of the gyros' outputs, the matrix R from body to platform axes and the true
//! inertial rate ω of the body, the computed R follows Ṙ = R \[(ω + δω)×\], while the matrix from body
//! to truly inertial axes follows Ċ = C \[ω×\]. The platform's axes relative to inertial ones, R Cᵀ,
//! therefore change by \[(R δω)×\] R Cᵀ: they rotate at the inertial rate -R δω in their own components.
//! The drift of the virtual platform is
//!
//! ```text
//! omega_d = -R δω
//! ```
//!
//! A body at rest on the Earth has one constant δω: its gyros see one specific force. One attitude
//! determines three numbers for a record of any length. The generated model [`gyrocal::Strapdown`]
//! is the drift law in these axes; it takes R at each row, for which [`axes_csv`] gives the text of
//! a file.

mod axes_file;
mod bench;
mod checks;
mod gyro_noise;
mod integrate;
mod rotation_fit;
mod vertical;
mod windows;

use gyrocal_record::{Bench, Record};
use serde::Serialize;

pub use axes_file::{axes_csv, read_axes, wrong_norm};
pub use integrate::{PlatformRow, integrate};
pub use rotation_fit::{RotationFit, fit_rotation};

use crate::accel_from_norm::refuse_wrong_norm;
use crate::description::Description;
use crate::earth_rate::{deg_per_h, earth_deg_per_h};
use crate::error::{InstrumentError, Unfit};
use crate::log::Log;
use gyro_noise::gyro_noise_deg_per_h;

/// Settings of an import.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImportSettings {
    /// Interval over which specific force is averaged into one row.
    pub averaging_s: f64,
    /// A row is disturbed if its gyros or accelerometers scatter more than in the median row by this
    /// factor.
    pub quiet_factor: f64,
    /// `true` to keep disturbed rows; they are missing otherwise.
    pub keep_disturbed: bool,
    /// Heading of body y, clockwise from north, and its standard deviation; `None` to estimate it from
    /// the gyros.
    pub heading_deg: Option<[f64; 2]>,
    /// Prior standard deviation of the constant error of a gyro.
    pub bias_sigma_deg_per_h: f64,
    /// Standard deviation of the level, from the errors of the accelerometers.
    pub level_sigma_deg: f64,
}

impl Default for ImportSettings {
    fn default() -> Self {
        Self {
            averaging_s: 30.0,
            quiet_factor: 2.0,
            keep_disturbed: false,
            heading_deg: None,
            bias_sigma_deg_per_h: 1.0,
            level_sigma_deg: 0.01,
        }
    }
}

/// A record of the virtual platform, and estimates from the log.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Specific force in the axes of the virtual platform, in units of its own mean norm.
    pub record: Record,
    /// Its bench description.
    pub bench: Bench,
    /// For each row the unit quaternion (w, x, y, z) from body to platform axes.
    pub platform_q_body: Vec<[f64; 4]>,
    /// Estimates from the log.
    pub report: ImportReport,
}

/// Estimates from a log before its calibration.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ImportReport {
    /// Number of samples of the log.
    pub samples: usize,
    /// Duration of the log.
    pub duration_s: f64,
    /// Number of rows of the record.
    pub rows: usize,
    /// Disturbed intervals, in the time of the log.
    pub disturbed_s: Vec<[f64; 2]>,
    /// Standard deviation of the samples of the gyros within the median row \[deg/h\].
    pub gyro_scatter_deg_per_h: f64,
    /// The same of the accelerometers \[g\].
    pub accel_scatter_g: f64,
    /// Mean norm of specific force, in the unit of the log.
    pub norm_g: f64,
    /// Horizontal part of the rotation rate of gravity in the virtual platform, and its standard
    /// deviation \[deg/h\].
    pub horizontal_rate_deg_per_h: [f64; 2],
    /// Horizontal part of Earth rate \[deg/h\].
    pub expected_horizontal_rate_deg_per_h: f64,
    /// Vertical part of the rotation rate, and its standard deviation \[deg/h\].
    pub vertical_rate_deg_per_h: [f64; 2],
    /// Vertical part of the rate by projection of the gyros on specific force, and its standard deviation
    /// \[deg/h\]; `None` if the rate is no stationary noise about a mean, as of a unit that rocks.
    pub vertical_projection_deg_per_h: Option<[f64; 2]>,
    /// Both weighted by what they know \[deg/h\].
    pub vertical_combined_deg_per_h: [f64; 2],
    /// Vertical part of Earth rate \[deg/h\].
    pub expected_vertical_rate_deg_per_h: f64,
    /// Heading of body y at the first row, clockwise from north, from the gyros.
    pub heading_deg: f64,
    /// East, north and up in body axes at the first row.
    pub body_c_enu: [[f64; 3]; 3],
    /// Standard deviation of a row about a uniform rotation \[g\].
    pub accel_noise_g: f64,
    /// Correlation of these deviations in successive rows.
    pub accel_noise_correlation: f64,
    /// Upper limit of the white noise of the gyros about horizontal axes, as held over one minute
    /// \[deg/h\].
    pub gyro_noise_deg_per_h: f64,
}

/// Converts a log to a record of a virtual platform with its bench description.
///
/// # Errors
///
/// [`Unfit::NoScale`] in counts; [`Unfit::Setting`] without latitude or with settings out of
/// range; [`Unfit::TooShort`]; [`Unfit::Norm`] if specific force is not gravity;
/// [`Unfit::NeverStatic`] if gravity does not rotate uniformly in the virtual platform;
/// [`Unfit::GyroScale`] and [`Unfit::Axes`] if it does not rotate at Earth rate; [`Unfit::NoAccelerometers`].
pub fn import(
    log: &Log,
    description: &Description,
    settings: &ImportSettings,
) -> Result<Imported, InstrumentError> {
    let latitude_deg = checks::check(log, description, settings)?;
    checks::refuse_large_bias(log, settings.averaging_s, earth_deg_per_h(latitude_deg))?;
    let rows = integrate(log, settings.averaging_s)?;
    if rows.len() < FEWEST_ROWS {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} intervals of {} s", rows.len(), settings.averaging_s),
            format!("at least {FEWEST_ROWS}"),
            "record for longer, or average over shorter intervals",
        ));
    }
    let quiet = windows::quiet(&rows, settings.quiet_factor);
    let fit = StaticFit::of(log, &rows, &quiet, latitude_deg, settings)?;
    let bench = bench::bench(
        &fit.rotation,
        latitude_deg,
        fit.heading_deg,
        fit.gyro_noise_deg_per_h,
        settings,
    )?;
    let record = Record {
        time_s: rows.iter().map(|row| row.time_s).collect(),
        accel_g: rows
            .iter()
            .zip(&quiet)
            .map(|(row, quiet)| match *quiet || settings.keep_disturbed {
                true => row.force_g.map(|component| component / fit.norm_g),
                false => [f64::NAN; 3],
            })
            .collect(),
        temperature_c: None,
    };
    Ok(Imported {
        record,
        bench,
        platform_q_body: rows.iter().map(|row| row.platform_q_body).collect(),
        report: fit.report(log, &rows, &quiet, settings),
    })
}

/// The rows of a log as those of a unit at rest on the Earth.
struct StaticFit {
    /// Mean norm of specific force, in the unit of the log.
    norm_g: f64,
    rotation: RotationFit,
    heading_deg: f64,
    gyro_noise_deg_per_h: f64,
    latitude_deg: f64,
}

impl StaticFit {
    fn of(
        log: &Log,
        rows: &[PlatformRow],
        quiet: &[bool],
        latitude_deg: f64,
        settings: &ImportSettings,
    ) -> Result<Self, InstrumentError> {
        let used: Vec<&PlatformRow> = rows
            .iter()
            .zip(quiet)
            .filter(|(_, quiet)| **quiet)
            .map(|(row, _)| row)
            .collect();
        let norms = used.iter().map(|row| norm(&row.force_g));
        refuse_wrong_norm(norms.clone())?;
        let norm_g = norms.sum::<f64>() / used.len() as f64;
        let start_s = rows[0].time_s;
        let points: Vec<(f64, [f64; 3])> = used
            .iter()
            .map(|row| {
                let force = row.force_g.map(|component| component / norm_g);
                (row.time_s - start_s, force)
            })
            .collect();
        let rotation = fit_rotation(&points, mean_rate(log));
        checks::refuse_motion(&rotation)?;
        checks::refuse_other_rates(&rotation, earth_deg_per_h(latitude_deg), latitude_deg)?;
        Ok(Self {
            norm_g,
            heading_deg: heading_deg(&rotation.platform_c_enu()),
            gyro_noise_deg_per_h: gyro_noise_deg_per_h(
                rows,
                norm_g,
                &rotation,
                settings.averaging_s,
            )?,
            rotation,
            latitude_deg,
        })
    }

    fn report(
        &self,
        log: &Log,
        rows: &[PlatformRow],
        quiet: &[bool],
        settings: &ImportSettings,
    ) -> ImportReport {
        let [gyro_scatter, accel_scatter] = windows::median_scatter(rows);
        let duration_s = log.time_s[log.len() - 1] - log.time_s[0] + log.interval_s;
        // The fit knows the accelerometers' noise; the gyros' own adds to the mean rate.
        let mean_noise = self.gyro_noise_deg_per_h * (60.0 / duration_s).sqrt();
        let with_noise =
            |[rate, sigma]: [f64; 2]| [deg_per_h(rate), deg_per_h(sigma).hypot(mean_noise)];
        let earth = earth_deg_per_h(self.latitude_deg);
        let level_sigma_rad = settings.level_sigma_deg.to_radians();
        let projection = vertical::projected(log, level_sigma_rad, earth[0]);
        let vertical_rate = with_noise(self.rotation.vertical_rate_rad_per_s);
        ImportReport {
            samples: log.len(),
            duration_s,
            rows: rows.len(),
            disturbed_s: windows::disturbed_s(rows, quiet, settings.averaging_s),
            gyro_scatter_deg_per_h: deg_per_h(gyro_scatter),
            accel_scatter_g: accel_scatter,
            norm_g: self.norm_g,
            horizontal_rate_deg_per_h: with_noise(self.rotation.horizontal_rate_rad_per_s),
            expected_horizontal_rate_deg_per_h: earth[0],
            vertical_rate_deg_per_h: vertical_rate,
            vertical_projection_deg_per_h: projection,
            vertical_combined_deg_per_h: vertical::combined(vertical_rate, projection),
            expected_vertical_rate_deg_per_h: earth[1],
            heading_deg: self.heading_deg,
            body_c_enu: self.rotation.platform_c_enu(),
            accel_noise_g: self.rotation.residual_rms_g,
            accel_noise_correlation: self.rotation.residual_correlation,
            gyro_noise_deg_per_h: self.gyro_noise_deg_per_h,
        }
    }
}

/// Least number of rows: more than the filter has states.
const FEWEST_ROWS: usize = 20;

fn mean_rate(log: &Log) -> [f64; 3] {
    core::array::from_fn(|axis| {
        log.gyro.iter().map(|rate| rate[axis]).sum::<f64>() / log.len() as f64
    })
}

/// Heading of body y, clockwise from north.
fn heading_deg(body_c_enu: &[[f64; 3]; 3]) -> f64 {
    let [east, north, _] = body_c_enu[1];
    east.atan2(north).to_degrees().rem_euclid(360.0)
}

fn norm(vector: &[f64; 3]) -> f64 {
    vector
        .iter()
        .map(|component| component * component)
        .sum::<f64>()
        .sqrt()
}
