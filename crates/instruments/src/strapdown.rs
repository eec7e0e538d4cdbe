//! A strapdown unit as an analytic platform: its accelerometers in axes that its gyros hold in
//! inertial space, by computation.
//!
//! With the error δω of the gyros' outputs, R the matrix from body to platform axes and ω the
//! body's true inertial rate, the computed R follows Ṙ = R \[(ω + δω)×\], while the matrix from
//! body to truly inertial axes follows Ċ = C \[ω×\]. The platform's axes against inertial ones,
//! R Cᵀ, therefore change by \[(R δω)×\] R Cᵀ, which is what axes do that turn at the inertial
//! rate -R δω, in their own components. The drift of the virtual platform is
//!
//! ```text
//! omega_d = -R δω
//! ```
//!
//! A body at rest on the Earth has one constant δω: its gyros see one specific force. One
//! attitude determines three numbers, whatever its length. The generated model
//! [`gyrocal::Strapdown`] is the drift law in these axes; it takes R at each row, which
//! [`axes_csv`] writes beside the record.

mod axes_file;
mod bench;
mod integrate;
mod rotation_fit;
mod windows;

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::allan::{allan_deviation, octaves};
use serde::Serialize;

pub use axes_file::{axes_csv, read_axes};
pub use integrate::{PlatformRow, integrate};
pub use rotation_fit::{RotationFit, fit_rotation};

use crate::description::Description;
use crate::error::{MeasuredError, Unfit};
use crate::log::Log;
use crate::norms::refuse_wrong_norm;

/// How a log becomes a record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImportSettings {
    /// Interval over which specific force is averaged into one row.
    pub averaging_s: f64,
    /// A row is disturbed if its gyros or accelerometers scatter more than this many times as
    /// much as in the median row.
    pub quiet_factor: f64,
    /// Whether disturbed rows are kept; otherwise they are written as missing.
    pub keep_disturbed: bool,
    /// Heading of body y, clockwise from north, and its standard deviation; found from the gyros
    /// themselves if it is not given.
    pub heading_deg: Option<[f64; 2]>,
    /// Standard deviation of the constant error of a gyro, before the record.
    pub bias_sigma_deg_per_h: f64,
    /// Standard deviation of the level, which the accelerometers' own errors set.
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

/// A record of the virtual platform, and what was seen on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Specific force in the axes of the virtual platform, in units of its own mean norm.
    pub record: Record,
    /// Its bench description.
    pub bench: Bench,
    /// For each row the unit quaternion (w, x, y, z) from body to platform axes.
    pub platform_q_body: Vec<[f64; 4]>,
    /// What the log says by itself.
    pub report: ImportReport,
}

/// What a log says by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportReport {
    /// Samples of the log.
    pub samples: usize,
    /// Their duration.
    pub duration_s: f64,
    /// Rows of the record.
    pub rows: usize,
    /// Disturbed intervals, in the time of the log.
    pub disturbed_s: Vec<[f64; 2]>,
    /// Standard deviation of the samples within a row, of the median row: gyros \[deg/h\].
    pub gyro_scatter_deg_per_h: f64,
    /// The same of the accelerometers \[g\].
    pub accel_scatter_g: f64,
    /// Mean norm of specific force, in the unit of the log.
    pub norm_g: f64,
    /// Horizontal part of the rate at which gravity turns in the virtual platform, and its
    /// standard deviation \[deg/h\].
    pub horizontal_rate_deg_per_h: [f64; 2],
    /// What the Earth would make it \[deg/h\].
    pub expected_horizontal_rate_deg_per_h: f64,
    /// Vertical part, and its standard deviation \[deg/h\].
    pub vertical_rate_deg_per_h: [f64; 2],
    /// What the Earth would make it \[deg/h\].
    pub expected_vertical_rate_deg_per_h: f64,
    /// Heading of body y at the first row, clockwise from north, as the gyros have it.
    pub heading_deg: f64,
    /// East, north and up in body axes at the first row.
    pub body_c_enu: [[f64; 3]; 3],
    /// What one sample of a row scatters about a uniform rotation \[g\].
    pub accel_noise_g: f64,
    /// Correlation of successive rows of that scatter.
    pub accel_noise_correlation: f64,
    /// White noise of the gyros about horizontal axes as held over one minute, at most \[deg/h\].
    pub gyro_noise_deg_per_h: f64,
}

/// Turns a log into a record of a virtual platform and its bench description.
///
/// # Errors
///
/// [`Unfit::NoScale`] in counts; [`Unfit::Setting`] without latitude or with settings out of
/// range; [`Unfit::TooShort`]; [`Unfit::Norm`] if specific force is not gravity;
/// [`Unfit::NeverStatic`] if gravity does not turn uniformly in the virtual platform;
/// [`Unfit::GyroScale`] and [`Unfit::Axes`] if it does not turn as the Earth makes it.
pub fn import(
    log: &Log,
    description: &Description,
    settings: &ImportSettings,
) -> Result<Imported, MeasuredError> {
    let latitude_deg = check(log, description, settings)?;
    let rows = integrate(log, settings.averaging_s);
    if rows.len() < FEWEST_ROWS {
        return Err(MeasuredError::unfit(
            Unfit::TooShort,
            format!("{} intervals of {} s", rows.len(), settings.averaging_s),
            format!("at least {FEWEST_ROWS}"),
            "record for longer, or average over shorter intervals",
        ));
    }
    let quiet = windows::quiet(&rows, settings.quiet_factor);
    let used: Vec<&PlatformRow> = rows
        .iter()
        .zip(&quiet)
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
            (
                row.time_s - start_s,
                row.force_g.map(|component| component / norm_g),
            )
        })
        .collect();
    let fit = fit_rotation(&points, mean_rate(log));
    refuse_motion(&fit)?;
    let earth = earth_deg_per_h(latitude_deg);
    refuse_other_rates(&fit, earth, latitude_deg)?;
    let gyro_noise = gyro_noise_deg_per_h(&rows, norm_g, &fit, settings.averaging_s)?;
    let body_c_enu = fit.platform_c_enu();
    let heading = heading_deg(&body_c_enu);
    let bench = bench::bench(&fit, latitude_deg, heading, gyro_noise, settings)?;
    let [gyro_scatter, accel_scatter] = windows::median_scatter(&rows);
    let duration_s = log.time_s[log.len() - 1] - log.time_s[0] + log.interval_s;
    // The fit knows the accelerometers' noise; the gyros' own adds to the mean rate.
    let mean_noise = gyro_noise * (60.0 / duration_s).sqrt();
    let with_noise = |[rate, sigma]: [f64; 2]| [per_hour(rate), per_hour(sigma).hypot(mean_noise)];
    let report = ImportReport {
        samples: log.len(),
        duration_s,
        rows: rows.len(),
        disturbed_s: windows::disturbed_s(&rows, &quiet, settings.averaging_s),
        gyro_scatter_deg_per_h: per_hour(gyro_scatter),
        accel_scatter_g: accel_scatter,
        norm_g,
        horizontal_rate_deg_per_h: with_noise(fit.horizontal_rate),
        expected_horizontal_rate_deg_per_h: earth[0],
        vertical_rate_deg_per_h: with_noise(fit.vertical_rate),
        expected_vertical_rate_deg_per_h: earth[1],
        heading_deg: heading,
        body_c_enu,
        accel_noise_g: fit.residual_rms,
        accel_noise_correlation: fit.residual_correlation,
        gyro_noise_deg_per_h: gyro_noise,
    };
    let record = Record {
        time_s: rows.iter().map(|row| row.time_s).collect(),
        accel_g: rows
            .iter()
            .zip(&quiet)
            .map(|(row, quiet)| match *quiet || settings.keep_disturbed {
                true => row.force_g.map(|component| component / norm_g),
                false => [f64::NAN; 3],
            })
            .collect(),
        temperature_c: None,
    };
    Ok(Imported {
        record,
        bench,
        platform_q_body: rows.iter().map(|row| row.platform_q_body).collect(),
        report,
    })
}

/// As many rows as the filter has states, and some more.
const FEWEST_ROWS: usize = 20;

/// A uniform rotation leaves at most this of specific force at rest.
const LARGEST_RESIDUAL_G: f64 = 0.01;

fn check(
    log: &Log,
    description: &Description,
    settings: &ImportSettings,
) -> Result<f64, MeasuredError> {
    if log.gyro_in_counts || log.accel_in_counts {
        return Err(MeasuredError::unfit(
            Unfit::NoScale,
            "counts whose scale is to be estimated",
            "scales that are given",
            "one attitude cannot tell them: give `counts_per_rad_per_s` and `counts_per_g`, as a \
             multi-position test of the unit (gyrocal tumble) prints them",
        ));
    }
    let setting = |found: String, expected: &str| {
        MeasuredError::unfit(Unfit::Setting, found, expected, "change the option")
    };
    let longest_s = 0.5 * (log.time_s[log.len() - 1] - log.time_s[0]);
    if !(2.0 * log.interval_s..=longest_s).contains(&settings.averaging_s) {
        let found = format!("an averaging interval of {} s", settings.averaging_s);
        let expected = format!("{:.4} to {longest_s:.1} s", 2.0 * log.interval_s);
        return Err(setting(found, &expected));
    }
    if settings.quiet_factor.is_nan() || settings.quiet_factor <= 1.0 {
        let found = format!("a quiet factor of {}", settings.quiet_factor);
        return Err(setting(found, "more than 1"));
    }
    description.site.latitude_deg.ok_or_else(|| {
        MeasuredError::unfit(
            Unfit::Setting,
            "a description without latitude",
            "`latitude_deg` in `[site]`",
            "the virtual platform turns against the Earth, whose rate depends on it",
        )
    })
}

fn refuse_motion(fit: &RotationFit) -> Result<(), MeasuredError> {
    if fit.residual_rms <= LARGEST_RESIDUAL_G {
        return Ok(());
    }
    Err(MeasuredError::unfit(
        Unfit::NeverStatic,
        format!(
            "specific force that differs by {:.3} g from gravity turning uniformly in inertial \
             axes",
            fit.residual_rms
        ),
        format!("at most {LARGEST_RESIDUAL_G} g on a static base"),
        "use a stretch in which the unit stands still; if it did, check that the gyros' unit is \
         right and that gyros and accelerometers have the same right-handed axes",
    ))
}

/// The Earth's horizontal and vertical rate.
fn earth_deg_per_h(latitude_deg: f64) -> [f64; 2] {
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    [cosine, sine].map(|part| part * per_hour(EARTH_RATE_RAD_PER_S))
}

fn refuse_other_rates(
    fit: &RotationFit,
    [horizontal, vertical]: [f64; 2],
    latitude_deg: f64,
) -> Result<(), MeasuredError> {
    let found = [fit.horizontal_rate[0], fit.vertical_rate[0]].map(per_hour);
    let earth = horizontal.hypot(vertical);
    let total = found[0].hypot(found[1]);
    let ratio = total / earth;
    if !(0.5..=2.0).contains(&ratio) {
        let near = |expected: f64| (0.8..=1.25).contains(&(ratio / expected));
        let degrees = 1.0_f64.to_degrees();
        let advice = if near(degrees) || near(1.0 / degrees) {
            "radians and degrees seem to be mixed up: change `unit`"
        } else if near(3600.0) || near(1.0 / 3600.0) {
            "seconds and hours seem to be mixed up: change `unit`"
        } else {
            "check unit and scale of the gyros; if they are right, gyros with errors as large as \
             Earth rate cannot hold an analytic platform: use gyrocal tumble"
        };
        return Err(MeasuredError::unfit(
            Unfit::GyroScale,
            format!("a rate of {total:.4} deg/h at rest"),
            format!("Earth rate, {earth:.4} deg/h, within a factor of two"),
            advice,
        ));
    }
    // Where the vertical part is small its sign tells nothing.
    if vertical.abs() > 0.2 * earth && found[1] * vertical < 0.0 {
        return Err(MeasuredError::unfit(
            Unfit::Axes,
            format!("a vertical rate of {:.3} deg/h", found[1]),
            format!("{vertical:.3} deg/h at latitude {latitude_deg} deg"),
            "the gyros' axes are left-handed or not those of the accelerometers, or specific force \
             is down positive, or the sign of the latitude is wrong: change `axes` or `[site]`",
        ));
    }
    Ok(())
}

fn mean_rate(log: &Log) -> [f64; 3] {
    core::array::from_fn(|axis| {
        log.gyro.iter().map(|rate| rate[axis]).sum::<f64>() / log.len() as f64
    })
}

/// White noise of the gyros about horizontal axes as held over one minute: at most the lowest
/// point of the Allan deviation times the root of its averaging time, of what gravity does in the
/// virtual platform beside turning uniformly. The outputs of the gyros themselves would count
/// true rocking as noise.
fn gyro_noise_deg_per_h(
    rows: &[PlatformRow],
    norm_g: f64,
    fit: &RotationFit,
    averaging_s: f64,
) -> Result<f64, MeasuredError> {
    const CONFIDENCE: f64 = 0.683;
    const FEWEST_DEGREES_OF_FREEDOM: f64 = 4.0;
    let start_s = rows[0].time_s;
    let residuals: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| {
            let force = row.force_g.map(|component| component / norm_g);
            fit.horizontal_residual(row.time_s - start_s, force)
        })
        .collect();
    let mut largest = 0.0_f64;
    for axis in 0..2 {
        let rates: Vec<f64> = residuals
            .windows(2)
            .map(|pair| per_hour((pair[1][axis] - pair[0][axis]) / averaging_s))
            .collect();
        let points = allan_deviation(&rates, averaging_s, &octaves(rates.len()), CONFIDENCE)?;
        let lowest = points
            .iter()
            .filter(|point| point.degrees_of_freedom >= FEWEST_DEGREES_OF_FREEDOM)
            .map(|point| point.deviation * (point.tau_s / 60.0).sqrt())
            .fold(f64::INFINITY, f64::min);
        largest = largest.max(lowest);
    }
    Ok(largest)
}

/// Heading of body y, clockwise from north.
fn heading_deg(body_c_enu: &[[f64; 3]; 3]) -> f64 {
    let [east, north, _] = body_c_enu[1];
    east.atan2(north).to_degrees().rem_euclid(360.0)
}

fn per_hour(rad_per_s: f64) -> f64 {
    rad_per_s.to_degrees() * 3600.0
}

fn norm(vector: &[f64; 3]) -> f64 {
    vector
        .iter()
        .map(|component| component * component)
        .sum::<f64>()
        .sqrt()
}
