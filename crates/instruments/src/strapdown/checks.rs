//! Checks of the settings, and of the log against a unit at rest on the Earth.

use nalgebra::Vector3;

use super::ImportSettings;
use super::rotation_fit::RotationFit;
use crate::description::Description;
use crate::earth_rate::deg_per_h;
use crate::error::{InstrumentError, Unfit};
use crate::log::Log;

/// Largest rms residual of specific force about a uniform rotation at rest.
const LARGEST_RESIDUAL_G: f64 = 0.01;

/// Refuses logs in counts and settings out of range; returns the latitude \[deg\].
pub(super) fn check(
    log: &Log,
    description: &Description,
    settings: &ImportSettings,
) -> Result<f64, InstrumentError> {
    if log.gyro_in_counts || log.accel_in_counts {
        return Err(InstrumentError::unfit(
            Unfit::NoScale,
            "counts whose scale is to be estimated",
            "scales that are given",
            "one attitude cannot tell them: give `counts_per_rad_per_s` and `counts_per_g`, as a \
             multi-position test of the unit (gyrocal tumble) prints them",
        ));
    }
    let setting = |found: String, expected: &str| {
        InstrumentError::unfit(Unfit::Setting, found, expected, "change the option")
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
        InstrumentError::unfit(
            Unfit::Setting,
            "a description without latitude",
            "`latitude_deg` in `[site]`",
            "the virtual platform turns against the Earth, whose rate depends on it",
        )
    })
}

/// Refuses specific force that does not rotate uniformly.
pub(super) fn refuse_motion(fit: &RotationFit) -> Result<(), InstrumentError> {
    if fit.residual_rms_g <= LARGEST_RESIDUAL_G {
        return Ok(());
    }
    Err(InstrumentError::unfit(
        Unfit::NeverStatic,
        format!(
            "specific force that differs by {:.3} g from gravity turning uniformly in inertial \
             axes",
            fit.residual_rms_g
        ),
        format!("at most {LARGEST_RESIDUAL_G} g on a static base"),
        "use a stretch in which the unit stands still; if it did, check that the gyros' unit is \
         right and that gyros and accelerometers have the same right-handed axes",
    ))
}

/// Refuses a rate that is not the Earth's.
pub(super) fn refuse_other_rates(
    fit: &RotationFit,
    [horizontal, vertical]: [f64; 2],
    latitude_deg: f64,
) -> Result<(), InstrumentError> {
    let found = [
        fit.horizontal_rate_rad_per_s[0],
        fit.vertical_rate_rad_per_s[0],
    ]
    .map(deg_per_h);
    let earth = horizontal.hypot(vertical);
    let total = found[0].hypot(found[1]);
    if let Some(error) = other_rate(total, earth) {
        return Err(error);
    }
    // Where the vertical part is small its sign tells nothing.
    if vertical.abs() > 0.2 * earth && found[1] * vertical < 0.0 {
        return Err(InstrumentError::unfit(
            Unfit::Axes,
            format!("a vertical rate of {:.3} deg/h", found[1]),
            format!("{vertical:.3} deg/h at latitude {latitude_deg} deg"),
            "the gyros' axes are left-handed or not those of the accelerometers, or specific force \
             is down positive, or the sign of the latitude is wrong: change `axes` or `[site]`",
        ));
    }
    Ok(())
}

/// Refuses outputs so large that specific force turns within a row, though it keeps its direction in the body.
pub(super) fn refuse_large_bias(
    log: &Log,
    averaging_s: f64,
    [horizontal, vertical]: [f64; 2],
) -> Result<(), InstrumentError> {
    /// Turn within a row that shortens its mean by 0.2 %.
    const LARGEST_TURN_RAD: f64 = 0.2;
    /// Share of the mean norm in the norm of the mean, of a force whose direction scatters by 8 degrees.
    const STILL: f64 = 0.99;
    let count = log.len() as f64;
    let mean = |samples: &[[f64; 3]]| {
        let sum: Vector3<f64> = samples.iter().map(|sample| Vector3::from(*sample)).sum();
        (sum / count).norm()
    };
    let force = log.force()?;
    let norms = force.iter().map(|force| Vector3::from(*force).norm());
    let rate = mean(&log.gyro);
    let still = mean(force) >= STILL * norms.sum::<f64>() / count;
    if !still || rate * averaging_s < LARGEST_TURN_RAD {
        return Ok(());
    }
    match other_rate(deg_per_h(rate), horizontal.hypot(vertical)) {
        Some(error) => Err(error),
        None => Ok(()),
    }
}

/// The error of a rate at rest that is not the Earth's within a factor of two \[deg/h\].
fn other_rate(total: f64, earth: f64) -> Option<InstrumentError> {
    let ratio = total / earth;
    if (0.5..=2.0).contains(&ratio) {
        return None;
    }
    let near = |expected: f64| (0.8..=1.25).contains(&(ratio / expected));
    let degrees = 1.0_f64.to_degrees();
    let advice = if near(degrees) || near(1.0 / degrees) {
        "radians and degrees seem to be mixed up: change `unit`"
    } else if near(3600.0) || near(1.0 / 3600.0) {
        "seconds and hours seem to be mixed up: change `unit`"
    } else {
        "a bias of that size is ordinary for many gyros, but it cannot hold an analytic platform: \
         evaluate the log with gyrocal rates, or check unit and scale of the gyros if such a bias is \
         not expected"
    };
    Some(InstrumentError::unfit(
        Unfit::GyroScale,
        format!("a rate of {total:.4} deg/h at rest"),
        format!("Earth rate, {earth:.4} deg/h, within a factor of two"),
        advice,
    ))
}
