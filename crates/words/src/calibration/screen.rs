//! The first screen of a calibration.

use super::verdict::{heading, how_sure};
use super::{has_several, is_correlated, latitude, record_line, tables};
use crate::diagnosis::parameter_values;
use crate::files::{few, input_files, joined};
use crate::format::{tested, with_sigma};
use gyrocal::EFFECTS;
use gyrocal_answer::Parameter;
use gyrocal_document::{Column, Screen, Table};
use gyrocal_record::{
    CalibrationReport, EffectTest, FitVerdict, FittedEffects, InputRole, NamedCause, NoiseEstimate,
    NoiseRatio, SetupProblem,
};

/// Records that are told one by one.
const RECORDS_SHOWN: usize = 2;
/// Names of a list that are shown.
const NAMES_SHOWN: usize = 4;

/// Verdict, how sure it is, the nine coefficients, and what to run next.
#[must_use]
pub fn calibration_screen(report: &CalibrationReport) -> Screen {
    let (standing, verdict, what) = heading(report);
    let mut screen = Screen::new(standing, verdict, what);
    if report.verdict == FitVerdict::Setup {
        screen.each("what is wrong", report.setup.iter().map(SetupProblem::text));
        return screen;
    }
    let shown = report.effects.iter().filter(|one| !one.causes.is_empty());
    for test in shown.take(RECORDS_SHOWN) {
        // Whoever gives an effect has chosen among them.
        causes(test, report.with_effects.is_none(), &mut screen);
    }
    screen.fact("how sure", how_sure(report, ""));
    if let Some(with) = &report.with_effects {
        screen.fact("with it", fitted(with));
    }
    let mended = report.setup.iter().take(RECORDS_SHOWN);
    screen.each("set-up mended", mended.map(SetupProblem::placed));
    match report.usable {
        true => results(report, &mut screen),
        false => screen.fact(
            "what to do",
            "check the units of [noise] and time, that up is positive, latitude and initial angles",
        ),
    }
    let records = report.records.iter().take(RECORDS_SHOWN);
    screen.each("record", records.map(record_line));
    let more = report.records.len().saturating_sub(RECORDS_SHOWN);
    if more > 0 {
        screen.fact("and", format!("{more} more records"));
    }
    next(report, &mut screen);
    screen
}

/// What to run next: the filter with the effects that were given, or the diagnosis.
fn next(report: &CalibrationReport, screen: &mut Screen) {
    let inputs = &report.manifest.inputs;
    if let Some(effects) = report.with_effects.as_ref().and_then(terms) {
        let mut roles = inputs.iter().map(|one| one.role);
        let gyros = match roles.any(|role| role == Some(InputRole::GyroAxes)) {
            true => " --gyros strapdown",
            false => "",
        };
        let command = format!("gyrocal extend --effects {effects}{gyros} --out NAME.model.toml");
        return screen.then(command, "the filter");
    }
    let why = match report.verdict {
        FitVerdict::Consistent => "all tests, and what could go undetected",
        _ => "looks for the causes",
    };
    let files = input_files(inputs, false, &[]);
    screen.then(format!("gyrocal diagnose {files}"), why);
}

/// What the diagnosis of a record names, and on request what else that may be.
fn causes(test: &EffectTest, alternatives: bool, screen: &mut Screen) {
    let each = test.causes.iter().take(NAMES_SHOWN);
    let each = each.map(|one: &NamedCause| {
        let p = tested(one.p_value);
        format!("{}, {:.1} sigma, search-corrected {p}", one.effect, one.z)
    });
    screen.fact("how large", joined(each, "; "));
    if alternatives {
        let others = test.causes.iter().flat_map(|one| &one.alternatives);
        screen.fact("may also be", few(others, NAMES_SHOWN));
    }
}

/// The effects that were given, if a filter can have all of them.
fn terms(with: &FittedEffects) -> Option<String> {
    let ids: Vec<&str> = with.effects.iter().map(|one| &*one.effect).collect();
    let is_term = |id: &&str| EFFECTS.iter().any(|one| one.id == *id && one.has_term());
    ids.iter().all(is_term).then(|| ids.join(","))
}

/// Sizes of effects that were given, and what they gain.
fn fitted(with: &FittedEffects) -> String {
    let effects = with.effects.iter().map(|one| {
        let parameters = one.parameters.iter().map(|own| Parameter {
            name: own.name.clone(),
            estimate: own.estimate,
            sigma: own.sigma,
            interval: own.interval.clone(),
            unit: own.unit.clone(),
        });
        let parameters: Vec<Parameter> = parameters.collect();
        format!("{}: {}", one.effect, parameter_values(&parameters))
    });
    format!("{}; {:+.1} nats", joined(effects, "; "), with.gained_nats)
}

fn results(report: &CalibrationReport, screen: &mut Screen) {
    let open = report.coefficients.iter().filter(|one| !one.determined);
    let open = few(open.map(|one| &one.name), NAMES_SHOWN);
    screen.fact("not determined", open);
    for run in report.runs.iter().take(RECORDS_SHOWN) {
        // Of several records the details have it.
        if let Some(found) = run.noise.as_ref().filter(|_| !has_several(report)) {
            screen.fact("noise", noise(found, is_correlated(report, &run.record)));
        }
        if run.azimuth.as_ref().is_some_and(|search| search.ambiguous) {
            let words = "ambiguous: give initial_angles_deg, or record for longer";
            screen.fact("azimuth", words);
        }
    }
    screen.fact("latitude", latitude_taken(report));
    screen.table = Some(table(report));
}

/// Estimated over declared noise; of the gyros not where the noise of the accelerometers is correlated.
fn noise(found: &NoiseEstimate, is_correlated: bool) -> String {
    let list = |ratios: &[NoiseRatio; 3]| {
        let each = ratios.map(|one| match one.is_observable() {
            true => format!("{:.2}", one.ratio),
            false => "?".to_owned(),
        });
        each.join(", ")
    };
    let (accelerometers, gyros) = (list(&found.accel), list(&found.gyro));
    match is_correlated {
        true => format!("of the declared one: accelerometers {accelerometers} times, correlated"),
        false => {
            format!("of the declared one: accelerometers {accelerometers}, gyros {gyros} times")
        }
    }
}

/// What an error of the latitude does.
fn latitude_taken(report: &CalibrationReport) -> String {
    let Some(latitude) = latitude(report) else {
        return String::new();
    };
    if latitude.declared_sigma.is_some() {
        return "its declared sigma is in the sigmas".to_owned();
    }
    tables::largest_bias(report, latitude).map_or_else(String::new, |(one, [_, in_sigmas])| {
        let (name, sigmas) = (&one.name, in_sigmas.abs());
        format!("taken as exact: 1 arcsec would shift {name} by {sigmas:.2} sigma")
    })
}

fn table(report: &CalibrationReport) -> Table {
    let with = report.with_effects.as_ref();
    let mut columns = vec![Column::words("coefficient"), Column::words("estimate")];
    columns.extend(with.map(|_| Column::words("with the effects")));
    columns.push(Column::words(""));
    let rows = report.coefficients.iter().enumerate().map(|(place, one)| {
        let estimate = with_sigma(one.estimate, one.sigma);
        let mut row = vec![one.name.clone(), format!("{estimate} {}", one.unit)];
        let with = with.and_then(|with| with.coefficients.get(place));
        row.extend(with.map(|with| with_sigma(with.estimate, with.sigma)));
        let meaning = tables::meaning(&one.name);
        let remark = match (one.determined, with) {
            (false, _) => "not determined",
            (true, None) => meaning.split(':').next().unwrap_or_default(),
            (true, Some(_)) => "",
        };
        row.push(remark.to_owned());
        row
    });
    Table::new("", columns, rows)
}
