//! Sentences of `gyrocal calibrate`, made from its result alone.

use std::fmt::Write as _;

use gyrocal::trajectory::angles_rad;
use gyrocal_calibration::{
    AzimuthSearch, Calibration, ConsiderSensitivity, NoiseDifference, NoiseEstimate, NoiseRatio,
    RunResult, SIGNIFICANT_WALK_SHARE, SiteQuantity, times_overlap,
};
use gyrocal_record::{AXES, CalibrationMethod, FittedEffects, printable_path};

use super::inputs::Measurement;
use super::{CalibrationRun, tables};
use crate::noise::ratio_text;
use crate::text::paragraph;

pub(super) fn summary(found: &CalibrationRun) -> String {
    let calibration = &found.calibration;
    let mut text = String::new();
    for measurement in &found.measurements {
        text.push_str(&paragraph(&record_line(measurement)));
    }
    text.push('\n');
    for problem in found.setup() {
        text.push_str(&paragraph(&format!(
            "Error of the set-up: {}",
            problem.text()
        )));
    }
    text.push_str(&paragraph(&found.verdict.text));
    if calibration.fit.is_gross() {
        return text;
    }
    text.push_str(&observability(found));
    for index in 0..found.measurements.len().min(calibration.runs.len()) {
        text.push_str(&run_results(found, index));
    }
    text.push_str(&site(found));
    text.push_str(&overlapping_times(&found.measurements));
    text.push_str(&paragraph(&final_angles(found)));
    let _ = writeln!(text, "\n{}", tables::coefficients(calibration));
    if let Some(with) = &found.with_effects {
        text.push_str(&with_effects(calibration, with));
    }
    let site_title = if found.has_several_records() {
        "Sensitivity to errors of the first record's site, which the residuals do not show: bias of \
         each coefficient in its unit"
    } else {
        "Sensitivity to site errors, which the residuals do not show: bias of each coefficient in \
         its unit"
    };
    let further = [
        (
            "Offsets of the turn-ons from the mean constant drifts, deg/h",
            tables::turn_ons(found),
        ),
        (
            "Sigmas from the first record alone and from all records",
            tables::first_run_sigmas(found),
        ),
        (site_title, tables::site_sensitivities(calibration)),
    ];
    for (title, table) in further {
        if let Some(table) = table {
            let _ = writeln!(text, "\n{}\n{table}", paragraph(&format!("{title}:")));
        }
    }
    text
}

/// The effects that were given, and the coefficients with and without them.
fn with_effects(calibration: &Calibration, with: &FittedEffects) -> String {
    let names: Vec<&str> = with.effects.iter().map(|one| one.effect.as_str()).collect();
    let title = format!(
        "Coefficients with {} in the model, which gains {:.1} nats of log-likelihood:",
        names.join(", "),
        with.gained_nats
    );
    let coefficients = tables::with_effects(calibration, with);
    let effects = tables::given_effects(with);
    format!("\n{}\n{coefficients}\n\n{effects}\n", paragraph(&title))
}

pub(super) fn record_line(measurement: &Measurement) -> String {
    let rows = measurement
        .averaged
        .map_or(measurement.record.len(), |averaged| {
            averaged.report.rows_read
        });
    let mut text = format!(
        "{}: {rows} rows over {:.2} days",
        printable_path(&measurement.path),
        measurement.record.duration_s() / 86_400.0,
    );
    let Some(averaged) = measurement.averaged else {
        return text;
    };
    let _ = write!(
        text,
        ", averaged over {} s to {} means of {:.3} times the noise",
        averaged.report.interval_s, averaged.means, averaged.report.noise_ratio
    );
    if averaged.report.left_out > 0 {
        let _ = write!(
            text,
            "; {} values left out, means of fewer than half of the median number of values",
            averaged.report.left_out
        );
    }
    if averaged.walk_share > SIGNIFICANT_WALK_SHARE {
        let _ = write!(
            text,
            ". Up to {:.0} % of the variance of these means is the attitude random walk within an \
             interval, which the declared noise does not include: average over a shorter interval",
            100.0 * averaged.walk_share
        );
    }
    text
}

fn observability(found: &CalibrationRun) -> String {
    let coefficients = found.calibration.coefficients();
    let ids = |determined: bool| -> Vec<&str> {
        let those = coefficients.iter().filter(|c| c.determined == determined);
        those.map(|coefficient| coefficient.id).collect()
    };
    let [records, determine] = if found.has_several_records() {
        ["records", "determine"]
    } else {
        ["record", "determines"]
    };
    let (yes, no) = (ids(true), ids(false));
    let mut text = paragraph(&match (yes.as_slice(), no.as_slice()) {
        (_, []) => format!("The {records} {determine} all nine coefficients."),
        ([], _) => format!(
            "The {records} {determine} none of the coefficients: estimates and sigmas below are \
             mostly those of the prior."
        ),
        _ => format!(
            "The {records} {determine} {}. Not determined: {}.",
            yes.join(", "),
            no.join(", ")
        ),
    });
    let combinations = &found.calibration.unobservable;
    if !combinations.is_empty() {
        text.push_str(&paragraph(
            "Unobservable combinations, each coefficient over its prior sigma, and the ratio of \
             posterior to prior sigma:",
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

fn run_results(found: &CalibrationRun, index: usize) -> String {
    let (measurement, run) = (&found.measurements[index], &found.calibration.runs[index]);
    let is_correlated = found.is_correlated(index);
    let several = found.has_several_records();
    let mut text = String::new();
    let of = if several {
        format!(" of {}", printable_path(&measurement.path))
    } else {
        String::new()
    };
    if let Some(search) = &run.azimuth {
        text.push_str(&paragraph(&azimuth(run, search, &of)));
    }
    if let Some(noise) = &run.noise {
        let gyros = match is_correlated {
            true => String::new(),
            false => format!("\n  gyros          {}", ratios(&noise.gyro)),
        };
        let _ = writeln!(
            text,
            "Estimated / declared noise{of} (95 % CI):\n  accelerometers {}{gyros}",
            ratios(&noise.accel)
        );
        text.push_str(&match is_correlated {
            true => paragraph(
                "No ratio for the gyros: the noise of the accelerometers is correlated, and its slow part would \
                 be taken for theirs.",
            ),
            false => paragraph(&noise_differences(noise)),
        });
    }
    if run.bounded_values > 0 {
        text.push_str(&paragraph(&format!(
            "Robust estimation{of}: reduced weight of {} values beyond the bound of --robust.",
            run.bounded_values
        )));
    }
    text
}

fn azimuth(run: &RunResult, search: &AzimuthSearch, of: &str) -> String {
    let [x, y, z] = angles_rad(&run.first_platform_c_enu).map(f64::to_degrees);
    let found = format!(
        "Initial attitude{of}: not declared. Levelled by the first samples, azimuth from a search \
         over {} starts: {x:.4}, {y:.4}, {z:.4} deg about x, y, z",
        search.starts
    );
    let other = search.other_rad.to_degrees();
    if search.is_ambiguous() {
        format!(
            "{found}. The azimuth is ambiguous: another one at {other:+.1} deg from it has a \
             log-likelihood lower by only {:.1}, with other coefficients. Give \
             initial_angles_deg, or record for longer.",
            search.margin
        )
    } else if search.margin.is_finite() {
        format!(
            "{found}; the next best, at {other:+.1} deg from it, has a log-likelihood lower by \
             {:.0}.",
            search.margin
        )
    } else {
        format!("{found}; no other azimuth fits.")
    }
}

fn ratios(found: &[NoiseRatio; 3]) -> String {
    let one = |(axis, ratio): (&str, &NoiseRatio)| {
        ratio_text(ratio).map_or_else(
            || format!("{axis} not observable"),
            |ratio| format!("{axis} {ratio}"),
        )
    };
    let parts: Vec<String> = AXES.into_iter().zip(found).map(one).collect();
    parts.join(", ")
}

/// Names the noises whose interval excludes the declared one.
fn noise_differences(noise: &NoiseEstimate) -> String {
    let named = |kind: &'static str, found: [NoiseRatio; 3]| {
        AXES.into_iter()
            .zip(found)
            .filter_map(move |(axis, ratio)| {
                let difference = match ratio.difference()? {
                    NoiseDifference::Larger => "larger",
                    NoiseDifference::Smaller => "smaller",
                };
                Some(format!("{kind}_{axis} ({difference})"))
            })
    };
    let different: Vec<String> = named("accel", noise.accel)
        .chain(named("gyro", noise.gyro))
        .collect();
    if different.is_empty() {
        return "All noise levels agree with the declared ones.".to_owned();
    }
    format!(
        "Noise levels other than declared: {}. By chance one of six intervals excludes 1 in every \
         fourth record.",
        different.join(", ")
    )
}

fn site(found: &CalibrationRun) -> String {
    let calibration = &found.calibration;
    if found.method != CalibrationMethod::Batch {
        return paragraph(
            "The streaming filter takes latitude, Earth rate and gravity as exact; latitude must be \
             the astronomic one. The batch estimator reports the sensitivity to their errors.",
        );
    }
    calibration
        .site_sensitivity(SiteQuantity::Latitude)
        .map_or_else(String::new, |latitude| {
            paragraph(&format!(
                "{} {}",
                assumed_latitude(calibration, latitude),
                latitude_of_records(latitude, found.has_several_records())
            ))
        })
}

fn assumed_latitude(calibration: &Calibration, latitude: &ConsiderSensitivity) -> String {
    if let Some(sigma) = latitude.declared_sigma {
        return format!(
            "Latitude is known to {:.3} arcsec (latitude_sigma_deg); the sigmas include its \
             uncertainty.",
            3600.0 * sigma
        );
    }
    let largest = calibration.largest_bias(latitude);
    let coefficient = calibration.coefficients()[largest.coefficient];
    format!(
        "Latitude is taken as exact, because the bench file gives no latitude_sigma_deg, and must be \
         the astronomic one: an error of 1 arcsec shifts the mean of the three D_I by {:.1e} \
         deg/h/g and {} by {:.1e} {} ({:.2} sigma), which no sigma includes.",
        latitude.mean_g_bias_deg_per_h_per_g(),
        coefficient.id,
        largest.bias.abs(),
        coefficient.unit,
        largest.in_sigmas.abs(),
    )
}

fn latitude_of_records(latitude: &ConsiderSensitivity, several: bool) -> String {
    let records = if several {
        "The records alone"
    } else {
        "The record alone"
    };
    let sigma = latitude.from_record_sigma;
    if !sigma.is_finite() {
        return format!("{records} cannot determine latitude.");
    }
    let better = match latitude.declared_sigma {
        Some(declared) if sigma < declared => ", better than declared",
        _ => "",
    };
    let verb = if several { "determine" } else { "determines" };
    format!(
        "{records} {verb} latitude to {:.1} arcsec (1 sigma){better}.",
        3600.0 * sigma
    )
}

fn overlapping_times(measurements: &[Measurement]) -> String {
    let mut text = String::new();
    for (index, one) in measurements.iter().enumerate() {
        for other in &measurements[index + 1..] {
            if times_overlap(&one.record, &other.record) {
                text.push_str(&paragraph(&format!(
                    "The times of {} and {} overlap: they are treated as turn-ons with separate \
                     clocks.",
                    printable_path(&one.path),
                    printable_path(&other.path)
                )));
            }
        }
    }
    text
}

fn final_angles(found: &CalibrationRun) -> String {
    let [x, y, z] = found.calibration.final_angles_rad.map(f64::to_degrees);
    let of = if found.has_several_records() {
        " of the last record"
    } else {
        ""
    };
    format!(
        "Platform angles against east, north, up at the last row{of}: {x:.4}, {y:.4}, {z:.4} deg \
         about x, y, z."
    )
}
