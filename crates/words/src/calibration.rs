//! A calibration in words.

mod screen;
mod tables;
mod verdict;

use gyrocal_document::Words;
use gyrocal_record::{
    AXES, AzimuthReport, CalibrationMethod, CalibrationReport, NoiseDifference, NoiseEstimate,
    NoiseRatio, RecordReport, RunReport, SiteReport, printable_line,
};
use gyrocal_statistics::format;

pub use screen::calibration_screen;
pub use verdict::calibration_verdict;

use crate::diagnosis::is_correlation;
use crate::files::joined;
use crate::format::size;
use crate::means::means;

/// Records, verdict, what is determined, noise and site of a calibration, in reading order.
#[must_use]
pub fn calibration(report: &CalibrationReport) -> Vec<Words> {
    let records = report.records.iter().map(record_line);
    let problems = report.setup.iter();
    let problems = problems.map(|one| format!("Error of the set-up: {}", one.text()));
    let texts = records.chain(problems).chain([report.verdict_text.clone()]);
    let mut words: Vec<Words> = texts.map(Words::Paragraph).collect();
    if !report.usable {
        return words;
    }
    words.push(Words::Paragraph(determined(report)));
    words.extend(undetermined(report));
    for run in &report.runs {
        of_run(report, run, &mut words);
    }
    let more = core::iter::once(site(report))
        .chain(overlaps(report))
        .chain([final_angles(report)]);
    words.extend(more.filter(|one| !one.is_empty()).map(Words::Paragraph));
    words.extend(tables::further(report).into_iter().map(Words::Table));
    words
}

/// Whether a calibration is of several records.
fn has_several(report: &CalibrationReport) -> bool {
    report.records.len() > 1
}

/// The first of two words of a calibration of one record, the second of several.
fn by_number(report: &CalibrationReport, [one, several]: [&'static str; 2]) -> &'static str {
    if has_several(report) { several } else { one }
}

fn record_line(one: &RecordReport) -> String {
    let (name, size) = (printable_line(&one.record), size(one.rows, one.duration_s));
    let mut text = format!("{name}: {size}");
    if let Some(averaged) = &one.averaged {
        text += &format!(", {}", means(averaged));
    }
    text
}

fn determined(report: &CalibrationReport) -> String {
    let ids = |determined: bool| {
        let all = report.coefficients.iter();
        let those = all.filter(|one| one.determined == determined);
        joined(those.map(|one| &one.name), ", ")
    };
    let records = by_number(report, ["record determines", "records determine"]);
    match (&*ids(true), &*ids(false)) {
        (_, "") => format!("The {records} all nine coefficients."),
        ("", _) => format!(
            "The {records} none of the coefficients: estimates and sigmas below are mostly those of \
             the prior."
        ),
        (yes, no) => format!("The {records} {yes}. Not determined: {no}."),
    }
}

fn undetermined(report: &CalibrationReport) -> Option<Words> {
    let entries = report.undetermined.iter().map(|one| {
        let (text, share) = (&one.text, format::percent(one.share_of_prior));
        format!("{text}: its sigma is {share} of that before the record")
    });
    let title = "Unobservable combinations, each coefficient over its prior sigma";
    Words::list(title, entries)
}

/// Attitude and noise of a record.
fn of_run(report: &CalibrationReport, run: &RunReport, words: &mut Vec<Words>) {
    let of = match has_several(report) {
        true => format!(" of {}", printable_line(&run.record)),
        false => String::new(),
    };
    let mut tell = |text: String| words.push(Words::Paragraph(text));
    if let Some(search) = &run.azimuth {
        tell(azimuth(run, search, &of));
    }
    if let Some(noise) = &run.noise {
        let is_correlated = is_correlated(report, &run.record);
        tell(format!(
            "Estimated over declared noise{of} (95 % interval): {}.",
            ratios(noise, is_correlated)
        ));
        tell(match is_correlated {
            true => "No ratio for the gyros: the noise of the accelerometers is correlated, and its slow part \
                     would be taken for theirs."
                .to_owned(),
            false => noise_differences(noise),
        });
    }
    if run.bounded_values > 0 {
        tell(format!(
            "Robust estimation{of}: reduced weight of {} values beyond the bound of --robust.",
            run.bounded_values
        ));
    }
}

/// Whether the noise of the accelerometers of a record is correlated.
fn is_correlated(report: &CalibrationReport, record: &str) -> bool {
    let mut own = report.effects.iter().filter(|one| one.record == record);
    own.any(|one| one.noise.iter().any(|id| is_correlation(id)))
}

fn azimuth(run: &RunReport, search: &AzimuthReport, of: &str) -> String {
    let [x, y, z] = run.initial_angles_deg;
    let found = format!(
        "Initial attitude{of}: not declared. Levelled by the first samples, azimuth from a search over {} starts: \
         {x:.4}, {y:.4}, {z:.4} deg about x, y, z",
        search.starts
    );
    let Some(other) = &search.other else {
        return format!("{found}; no other azimuth fits.");
    };
    let (angle, margin) = (other.relative_deg, other.log_likelihood_deficit);
    match search.ambiguous {
        true => format!(
            "{found}. The azimuth is ambiguous: another one at {angle:+.1} deg from it has a log-likelihood lower \
             by only {margin:.1}, with other coefficients. Give initial_angles_deg, or record for longer."
        ),
        false => format!(
            "{found}; the next best, at {angle:+.1} deg from it, has a log-likelihood lower by {margin:.0}."
        ),
    }
}

/// The ratios of the instruments; without those of the gyros where the noise is correlated.
fn ratios(noise: &NoiseEstimate, is_correlated: bool) -> String {
    let each = |found: &[NoiseRatio; 3]| {
        let each = AXES.into_iter().zip(found).map(|(axis, one)| {
            let [low, high] = one.interval;
            match one.is_observable() {
                true => format!("{axis} {:.3} ({low:.3} to {high:.3})", one.ratio),
                false => format!("{axis} not observable"),
            }
        });
        joined(each, ", ")
    };
    let accelerometers = format!("accelerometers {}", each(&noise.accel));
    match is_correlated {
        true => accelerometers,
        false => format!("{accelerometers}; gyros {}", each(&noise.gyro)),
    }
}

/// Names the noises whose interval excludes the declared one.
fn noise_differences(noise: &NoiseEstimate) -> String {
    let named = |kind: &'static str, found: [NoiseRatio; 3]| {
        let each = AXES.into_iter().zip(found);
        each.filter_map(move |(axis, ratio)| {
            let difference = match ratio.difference()? {
                NoiseDifference::Larger => "larger",
                NoiseDifference::Smaller => "smaller",
            };
            Some(format!("{kind}_{axis} ({difference})"))
        })
    };
    let different = named("accel", noise.accel).chain(named("gyro", noise.gyro));
    match &*joined(different, ", ") {
        "" => "All noise levels agree with the declared ones.".to_owned(),
        named => format!(
            "Noise levels other than declared: {named}. By chance one of six intervals excludes 1 in every fourth \
             record."
        ),
    }
}

/// The sensitivity to the latitude.
fn latitude(report: &CalibrationReport) -> Option<&SiteReport> {
    report.site.iter().find(|one| one.quantity == "latitude")
}

fn site(report: &CalibrationReport) -> String {
    if report.method != CalibrationMethod::Batch {
        return "The streaming filter takes latitude, Earth rate and gravity as exact; latitude must be the \
                astronomic one. The batch estimator reports the sensitivity to their errors."
            .to_owned();
    }
    let Some(latitude) = latitude(report) else {
        return String::new();
    };
    let assumed = match latitude.declared_sigma {
        Some(sigma) => format!(
            "Latitude is known to {:.3} arcsec (latitude_sigma_deg); the sigmas include its uncertainty.",
            3600.0 * sigma
        ),
        None => exact_latitude(report, latitude),
    };
    let [records, verb] = match has_several(report) {
        true => ["The records alone", "determine"],
        false => ["The record alone", "determines"],
    };
    let alone = match latitude.from_record_sigma {
        None => format!("{records} cannot determine latitude."),
        Some(sigma) => {
            let better = match latitude.declared_sigma {
                Some(declared) if sigma < declared => ", better than declared",
                _ => "",
            };
            let arcsec = 3600.0 * sigma;
            format!("{records} {verb} latitude to {arcsec:.1} arcsec (1 sigma){better}.")
        }
    };
    format!("{assumed} {alone}")
}

fn exact_latitude(report: &CalibrationReport, latitude: &SiteReport) -> String {
    let biases = tables::biases(report, latitude);
    let of_g = tables::MASS_UNBALANCES
        .iter()
        .filter_map(|place| biases.get(*place));
    let mean = of_g.map(|[bias, _]| bias).sum::<f64>() / 3.0;
    let told = tables::largest_bias(report, latitude);
    let told = told.map_or_else(String::new, |(one, [bias, in_sigmas])| {
        let (name, unit) = (&one.name, &one.unit);
        let (bias, in_sigmas) = (bias.abs(), in_sigmas.abs());
        format!(" and {name} by {bias:.1e} {unit} ({in_sigmas:.2} sigma)")
    });
    format!(
        "Latitude is taken as exact, because the bench file gives no latitude_sigma_deg, and must be the \
         astronomic one: an error of 1 arcsec shifts the mean of the three D_I by {:.1e} deg/h/g{told}, which no \
         sigma includes.",
        mean.abs()
    )
}

fn overlaps(report: &CalibrationReport) -> Vec<String> {
    let pairs = report.records.iter();
    let pairs = pairs.flat_map(|one| one.overlaps.iter().map(|earlier| (&one.record, earlier)));
    let told = pairs.map(|(one, earlier)| {
        let [earlier, one] = [earlier, one].map(|name| printable_line(name));
        format!("The times of {earlier} and {one} overlap: they are treated as turn-ons with separate clocks.")
    });
    told.collect()
}

fn final_angles(report: &CalibrationReport) -> String {
    let of = by_number(report, ["", " of the last record"]);
    report.final_angles_deg.map_or_else(String::new, |[x, y, z]| {
        format!(
            "Platform angles against east, north, up at the last row{of}: {x:.4}, {y:.4}, {z:.4} deg about x, y, z."
        )
    })
}
