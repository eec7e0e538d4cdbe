//! The first screen: what was found, in words.

use std::fmt::Write as _;

use gyrocal::generated::surveyed::parameters_index as index;
use gyrocal::trajectory::angles_rad;
use gyrocal_calibration::{
    AzimuthSearch, Calibration, ConsiderSensitivity, NoiseRatio, RunResult, SiteQuantity,
};
use gyrocal_record::CalibrationMethod;

use super::inputs::Measurement;
use super::{Found, tables};
use crate::noise::told;
use crate::text::paragraph;

/// Of the variance of a mean; less does no harm to the fit of a record of some days.
const LARGE_WALK_SHARE: f64 = 0.05;

pub(super) fn summary(found: &Found) -> String {
    let calibration = &found.calibration;
    let mut text = String::new();
    for measurement in &found.measurements {
        text.push_str(&paragraph(&of_record(measurement)));
    }
    text.push('\n');
    text.push_str(&paragraph(&format!(
        "Fit: {}.",
        calibration.fit.consistency_text()
    )));
    text.push_str(&determined(found));
    let several = found.measurements.len() > 1;
    for (measurement, run) in found.measurements.iter().zip(&calibration.runs) {
        text.push_str(&of_run(measurement, run, several));
    }
    text.push_str(&site(found));
    text.push_str(&clocks(&found.measurements));
    let [x, y, z] = calibration.final_angles_rad.map(f64::to_degrees);
    let last = if several { " of the last record" } else { "" };
    text.push_str(&paragraph(&format!(
        "Platform against east, north, up at the last row{last}: {x:.4}, {y:.4}, {z:.4} deg about \
         x, y, z."
    )));
    let _ = writeln!(text, "\n{}", tables::coefficients(calibration));
    if let Some(table) = tables::turn_ons(found) {
        let _ = writeln!(
            text,
            "\nWhat each turn-on adds to the constant drifts, deg/h:\n\n{table}"
        );
    }
    if let Some(table) = tables::gains(found) {
        let _ = writeln!(
            text,
            "\nSigmas before and after the other records:\n\n{table}"
        );
    }
    if !calibration.site_sensitivities.is_empty() {
        let of = if several {
            "the first record's site"
        } else {
            "the site"
        };
        let _ = writeln!(
            text,
            "\nSilent biases: what errors of {of} do to the coefficients, in their units, without a \
             trace\nin the fit:\n\n{}",
            tables::silent_biases(calibration)
        );
    }
    text
}

fn of_record(measurement: &Measurement) -> String {
    let mut text = format!(
        "{}: {} rows over {:.2} days",
        measurement.path.display(),
        measurement
            .averaged
            .map_or(measurement.record.len(), |averaged| averaged.rows_read),
        measurement.record.duration_s() / 86_400.0,
    );
    if let Some(averaged) = measurement.averaged {
        let means = measurement
            .record
            .accel_g
            .iter()
            .filter(|row| row.iter().any(|value| !value.is_nan()))
            .count();
        let _ = write!(
            text,
            ", averaged to {means} means over {} s with {:.3} of the noise",
            averaged.interval_s, averaged.noise_ratio
        );
        if averaged.left_out > 0 {
            let _ = write!(
                text,
                "; {} values left out, means of less than half of the usual number",
                averaged.left_out
            );
        }
        let share = measurement.walk_share();
        if share > LARGE_WALK_SHARE {
            let _ = write!(
                text,
                ". Up to {:.0} % of the variance of these means is the platform's own random \
                 turning within an interval, which the declared noise does not cover: average \
                 over a shorter one",
                100.0 * share
            );
        }
    }
    text
}

fn determined(found: &Found) -> String {
    let coefficients = found.calibration.coefficients();
    let ids = |wanted: bool| -> Vec<&str> {
        coefficients
            .iter()
            .filter(|coefficient| coefficient.determined == wanted)
            .map(|coefficient| coefficient.id)
            .collect()
    };
    let records = if found.measurements.len() > 1 {
        "records"
    } else {
        "record"
    };
    let (yes, no) = (ids(true), ids(false));
    let mut text = paragraph(&match (yes.as_slice(), no.as_slice()) {
        (_, []) => format!("The {records} determined all nine coefficients."),
        ([], _) => format!("The {records} determined none of the coefficients."),
        _ => format!(
            "The {records} determined {}; not {}.",
            yes.join(", "),
            no.join(", ")
        ),
    });
    let combinations = &found.calibration.unobservable;
    if !combinations.is_empty() {
        text.push_str(&paragraph(
            "Undetermined combinations, each coefficient over its prior sigma, and what is left \
             of their prior sigma:",
        ));
        for combination in combinations {
            let _ = writeln!(
                text,
                "  {}: {:.0} %",
                combination.text(),
                100.0 * combination.posterior_to_prior_ratio
            );
        }
    }
    text
}

fn of_run(measurement: &Measurement, run: &RunResult, several: bool) -> String {
    let mut text = String::new();
    let of = if several {
        format!(" of {}", measurement.path.display())
    } else {
        String::new()
    };
    if let Some(search) = &run.azimuth {
        text.push_str(&paragraph(&azimuth(run, search, &of)));
    }
    if let Some(noise) = &run.noise {
        let _ = writeln!(
            text,
            "Noise{of} over the declared, with 95 % intervals:\n  accelerometers {}\n  gyros          {}",
            ratios(&noise.accel),
            ratios(&noise.gyro)
        );
        text.push_str(&beside_one(&noise.accel, &noise.gyro));
    }
    if run.bounded_values > 0 {
        text.push_str(&paragraph(&format!(
            "Influence bounded{of}: {} values beyond the limit of --robust.",
            run.bounded_values
        )));
    }
    text
}

fn azimuth(run: &RunResult, search: &AzimuthSearch, of: &str) -> String {
    let [x, y, z] = angles_rad(&run.first_platform_c_enu).map(f64::to_degrees);
    let found = format!(
        "Initial attitude{of}: not given; levelled, and the azimuth found from {} starts: \
         {x:.4}, {y:.4}, {z:.4} deg about x, y, z",
        search.starts
    );
    let other = search.other_rad.to_degrees();
    if search.is_ambiguous() {
        format!(
            "{found}. It is ambiguous: an azimuth {other:+.1} deg from it fits nearly as well \
             (log-likelihood lower by {:.1} only), with other coefficients. Give \
             initial_angles_deg, or record for longer.",
            search.margin
        )
    } else if search.margin.is_finite() {
        format!(
            "{found}; the next best, {other:+.1} deg from it, has a log-likelihood lower by {:.0}.",
            search.margin
        )
    } else {
        format!("{found}; no other azimuth fits.")
    }
}

fn ratios(found: &[NoiseRatio; 3]) -> String {
    let one = |(axis, ratio): (&str, &NoiseRatio)| {
        told(ratio.ratio, ratio.interval).map_or_else(
            || format!("{axis} not told by the record"),
            |told| format!("{axis} {told}"),
        )
    };
    let parts: Vec<String> = ["x", "y", "z"].into_iter().zip(found).map(one).collect();
    parts.join(", ")
}

/// Names the noises whose interval excludes the declared one.
fn beside_one(accel: &[NoiseRatio; 3], gyro: &[NoiseRatio; 3]) -> String {
    let named = |kind: &'static str, found: &[NoiseRatio; 3]| {
        ["x", "y", "z"]
            .into_iter()
            .zip(*found)
            .filter_map(|(axis, ratio)| {
                let side = match ratio.interval {
                    [low, _] if low > 1.0 => "larger",
                    [_, high] if high < 1.0 => "smaller",
                    _ => return None,
                };
                Some(format!("{kind}_{axis} is {side} than declared"))
            })
            .collect::<Vec<_>>()
    };
    let mut all = named("accel", accel);
    all.extend(named("gyro", gyro));
    if all.is_empty() {
        return "Each interval holds 1.\n".to_owned();
    }
    paragraph(&format!(
        "By their intervals {}; one of six misses 1 by chance in every fourth record.",
        all.join(", ")
    ))
}

fn site(found: &Found) -> String {
    if found.method != CalibrationMethod::Batch {
        return paragraph(
            "One pass of the filter: latitude, Earth rate and gravity count as exact, and latitude \
             must be the astronomic one. The batch estimator says what errors of them do.",
        );
    }
    let calibration = &found.calibration;
    let latitude = calibration
        .site_sensitivities
        .iter()
        .find(|influence| influence.quantity == SiteQuantity::Latitude);
    latitude.map_or_else(String::new, |influence| {
        let records = if found.measurements.len() > 1 {
            "By themselves the records"
        } else {
            "By itself the record"
        };
        paragraph(&format!(
            "{} {records} {}",
            assumed_latitude(calibration, influence),
            told_latitude(influence)
        ))
    })
}

fn assumed_latitude(calibration: &Calibration, influence: &ConsiderSensitivity) -> String {
    if let Some(sigma) = influence.declared_sigma {
        return format!(
            "Latitude counts as known to {:.3} arcsec (latitude_sigma_deg); the sigmas include what \
             that does.",
            3600.0 * sigma
        );
    }
    let shifts = influence
        .bias_per_unit
        .map(|bias| bias * influence.assumed_error());
    let coefficients = calibration.coefficients();
    let in_sigmas = |index: usize| (shifts[index] / coefficients[index].sigma).abs();
    let most = (0..shifts.len()).max_by(|a, b| in_sigmas(*a).total_cmp(&in_sigmas(*b)));
    let most = most.unwrap_or(0);
    let of_mass_unbalance =
        [index::GYRO_X_G_X, index::GYRO_Y_G_Y, index::GYRO_Z_G_Z].map(|index| shifts[index]);
    format!(
        "Latitude counts as exact, for the bench file gives no latitude_sigma_deg, and it must be \
         the astronomic one: an error of 1 arc second moves the mean of the three D_I by {:.1e} \
         deg/h/g and {} by {:.1e} {}, {:.2} of its sigmas, which no sigma includes.",
        (of_mass_unbalance.iter().sum::<f64>() / 3.0).abs(),
        coefficients[most].id,
        shifts[most].abs(),
        coefficients[most].unit,
        in_sigmas(most),
    )
}

fn told_latitude(influence: &ConsiderSensitivity) -> String {
    let told = influence.from_record_sigma;
    if !told.is_finite() {
        return "would tell nothing of it.".to_owned();
    }
    let better = match influence.declared_sigma {
        Some(declared) if told < declared => ", better than what is declared",
        _ => "",
    };
    format!(
        "would tell it to {:.1} arcsec (one sigma){better}.",
        3600.0 * told
    )
}

/// The error that the table of silent biases tells the effect of.
pub(super) fn site_error(influence: &ConsiderSensitivity) -> String {
    let error = influence.assumed_error();
    let size = match influence.quantity {
        SiteQuantity::Latitude => format!("latitude +{:.3} arcsec", 3600.0 * error),
        SiteQuantity::EarthRate => format!("Earth rate +{error:.1e}"),
        SiteQuantity::Gravity => format!("gravity +{error:.1e}"),
        _ => format!("+{error:.1e}"),
    };
    if influence.declared_sigma.is_some() {
        format!("{size} (1 sigma)")
    } else {
        size
    }
}

/// Records of one clock cannot overlap; whether it is one clock, the files do not say.
fn clocks(measurements: &[Measurement]) -> String {
    let span = |measurement: &Measurement| {
        let times = &measurement.record.time_s;
        (
            times.first().copied().unwrap_or(f64::NAN),
            times.last().copied().unwrap_or(f64::NAN),
        )
    };
    let mut text = String::new();
    for (index, one) in measurements.iter().enumerate() {
        for other in &measurements[index + 1..] {
            let ((a, b), (c, d)) = (span(one), span(other));
            // Clocks that start alike start at each turn-on.
            if a != c && a < d && c < b {
                text.push_str(&paragraph(&format!(
                    "The times of {} and {} overlap: they are taken for turn-ons with clocks of \
                     their own.",
                    one.path.display(),
                    other.path.display()
                )));
            }
        }
    }
    text
}
