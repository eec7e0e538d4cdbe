//! The first screen of `gyrocal calibrate`.

use std::path::PathBuf;

use gyrocal_answer::Parameter;
use gyrocal_calibration::{NoiseRatio, RunResult, SiteQuantity};
use gyrocal_document::{Column, Screen, Standing, Table};
use gyrocal_record::{EffectTest, FitVerdict, FittedEffects, InputRole};
use gyrocal_statistics::format;
use gyrocal_words::{command_files, few, parameter_values};

use super::{CalibrateArguments, CalibrationRun};
use crate::extend::known;

/// Records that are told one by one.
const RECORDS_SHOWN: usize = 2;
/// Names of a list that are shown.
const NAMES_SHOWN: usize = 4;

/// Verdict, how sure it is, the nine coefficients, and what to run next.
pub(super) fn first(found: &CalibrationRun, next: Option<String>) -> Screen {
    let mut screen = verdict(found);
    let fit = &found.calibration.fit;
    let shown: Vec<&EffectTest> = found.effects.iter().filter(|one| one.significant).collect();
    for test in shown.iter().take(RECORDS_SHOWN) {
        let largest = test.effect.as_deref().unwrap_or("an effect");
        screen.fact(
            "how large",
            format!(
                "{largest}, {:.1} sigma, search-corrected {}",
                test.z,
                format::p_value(test.p_value)
            ),
        );
    }
    let [low, high] = fit.nis_band();
    let is_white = |test: &EffectTest| test.white == Some(true);
    let effects = match (shown.is_empty(), found.effects.is_empty()) {
        (true, false) if found.effects.iter().all(is_white) => {
            "; no effect of the catalogue is significant, innovations white"
        }
        (true, false) => "; no effect of the catalogue is significant",
        _ => "",
    };
    screen.fact(
        "how sure",
        format!(
            "mean NIS {:.3} (expected {low:.3} to {high:.3}){effects}",
            fit.nis_mean()
        ),
    );
    if let Some(with) = &found.with_effects {
        screen.fact("with it", fitted(with));
    }
    for problem in found.setup().take(RECORDS_SHOWN) {
        screen.fact("set-up mended", problem.placed());
    }
    if fit.is_gross() {
        screen.fact(
            "what to do",
            "check the units of [noise] and time, that up is positive, latitude and initial angles",
        );
    } else {
        results(found, &mut screen);
    }
    for measurement in found.measurements.iter().take(RECORDS_SHOWN) {
        screen.fact("record", super::prose::record_line(measurement));
    }
    if found.measurements.len() > RECORDS_SHOWN {
        let more = found.measurements.len() - RECORDS_SHOWN;
        screen.fact("and", format!("{more} more records"));
    }
    let why = match found.verdict.verdict {
        FitVerdict::Consistent => "all tests, and what could go undetected",
        _ => "looks for the causes",
    };
    if let Some(effects) = found.with_effects.as_ref().and_then(terms) {
        let gyros = match found.gyro_axes.is_empty() {
            true => "",
            false => " --gyros strapdown",
        };
        screen.then(
            format!("gyrocal extend --effects {effects}{gyros} --out NAME.model.toml"),
            "the filter",
        );
    } else if let Some(command) = next {
        screen.then(command, why);
    }
    screen
}

/// The diagnosis of the first record, as a shell reads it.
pub(super) fn diagnose(found: &CalibrationRun, arguments: &CalibrateArguments) -> Option<String> {
    let first = found.measurements.first()?;
    let files = [
        (InputRole::Record, Some(first.path.as_path())),
        (InputRole::Bench, Some(first.bench_path.as_path())),
        (
            InputRole::GyroAxes,
            arguments.gyro_axes.first().map(PathBuf::as_path),
        ),
        (InputRole::Columns, arguments.map.path()),
    ];
    let files: Vec<(InputRole, String)> = files
        .into_iter()
        .filter_map(|(role, path)| Some((role, path?.to_string_lossy().into_owned())))
        .collect();
    let files = files.iter().map(|(role, path)| (*role, path.as_str()));
    Some(format!("gyrocal diagnose {}", command_files(files)))
}

fn verdict(found: &CalibrationRun) -> Screen {
    let of = if found.has_several_records() {
        "the records show"
    } else {
        "the record shows"
    };
    let fit = &found.calibration.fit;
    let (standing, verdict, what) = match found.verdict.verdict {
        _ if fit.is_gross() => (
            Standing::Bad,
            "NOT USABLE",
            "the innovations are far larger than the noise: the coefficients are not usable"
                .to_owned(),
        ),
        FitVerdict::EffectsFound => (
            Standing::Bad,
            "FAULT",
            match &found.with_effects {
                None => {
                    format!("{of} an effect that the model lacks: the coefficients may be biased")
                }
                Some(_) => format!("{of} an effect that the nominal model lacks"),
            },
        ),
        FitVerdict::TooLarge => (
            Standing::Doubtful,
            "MISFIT",
            "the innovations are larger than the declared noise: the sigmas are too small"
                .to_owned(),
        ),
        FitVerdict::TooSmall => (
            Standing::Doubtful,
            "MISFIT",
            "the innovations are smaller than the declared noise: the sigmas are too large"
                .to_owned(),
        ),
        FitVerdict::Unexplained => (
            Standing::Bad,
            "UNEXPLAINED",
            "the innovations are not white, and no effect of the catalogue is significant"
                .to_owned(),
        ),
        FitVerdict::NoiseDiffers => (
            Standing::Doubtful,
            "MISFIT",
            format!(
                "the noise differs from the declared ({}): the sigmas are not those of this noise",
                noise_found(&found.effects).join(", ")
            ),
        ),
        _ => (
            Standing::Good,
            "CALIBRATED",
            "data, model and declared noise agree".to_owned(),
        ),
    };
    Screen::new(standing, verdict, what)
}

/// The effects that were given, if a filter can have all of them; random walks and attitude jumps are no terms.
fn terms(with: &FittedEffects) -> Option<String> {
    let known = known();
    let ids: Vec<&str> = with.effects.iter().map(|one| one.effect.as_str()).collect();
    let is_term = |id: &&str| {
        let mut terms = known.iter().filter(|one| one.objection().is_none());
        terms.any(|one| one.id == *id)
    };
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
    let effects: Vec<String> = effects.collect();
    format!("{}; {:+.1} nats", effects.join("; "), with.gained_nats)
}

/// What the noise audits of the records found.
fn noise_found(effects: &[EffectTest]) -> Vec<&str> {
    let all = effects.iter().flat_map(|test| &test.noise);
    let mut ids: Vec<&str> = all.map(String::as_str).collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}

fn results(found: &CalibrationRun, screen: &mut Screen) {
    let coefficients = found.calibration.coefficients();
    let open = coefficients.iter().filter(|one| !one.determined);
    let open: Vec<&str> = open.map(|one| one.id).collect();
    screen.fact("not determined", few(&open, NAMES_SHOWN));
    let runs = found.calibration.runs.iter().enumerate();
    for (index, run) in runs.take(RECORDS_SHOWN) {
        // Of several records the details have it.
        if !found.has_several_records() {
            screen.fact("noise", noise(run, found.is_correlated(index)));
        }
        if run
            .azimuth
            .as_ref()
            .is_some_and(|search| search.is_ambiguous())
        {
            screen.fact(
                "azimuth",
                "ambiguous: give initial_angles_deg, or record for longer",
            );
        }
    }
    screen.fact("latitude", latitude(found));
    screen.table = Some(table(found));
}

/// Estimated over declared noise; of the gyros not where the noise of the accelerometers is correlated.
fn noise(run: &RunResult, is_correlated: bool) -> String {
    let Some(noise) = &run.noise else {
        return String::new();
    };
    let list = |ratios: &[NoiseRatio; 3]| {
        let each = ratios.map(|found| match found.is_observable() {
            true => format!("{:.2}", found.ratio),
            false => "?".to_owned(),
        });
        each.join(", ")
    };
    let accelerometers = list(&noise.accel);
    match is_correlated {
        true => format!("of the declared one: accelerometers {accelerometers} times, correlated"),
        false => format!(
            "of the declared one: accelerometers {accelerometers}, gyros {} times",
            list(&noise.gyro)
        ),
    }
}

/// What an error of the latitude does.
fn latitude(found: &CalibrationRun) -> String {
    let calibration = &found.calibration;
    let Some(latitude) = calibration.site_sensitivity(SiteQuantity::Latitude) else {
        return String::new();
    };
    if latitude.declared_sigma.is_some() {
        return "its declared sigma is in the sigmas".to_owned();
    }
    let largest = calibration.largest_bias(latitude);
    let coefficient = calibration.coefficients()[largest.coefficient];
    format!(
        "taken as exact: 1 arcsec would shift {} by {:.2} sigma",
        coefficient.id,
        largest.in_sigmas.abs()
    )
}

fn table(found: &CalibrationRun) -> Table {
    let mut columns = vec![Column::words("coefficient"), Column::words("estimate")];
    let with = found.with_effects.as_ref();
    if with.is_some() {
        columns.push(Column::words("with the effects"));
    }
    columns.push(Column::words(""));
    let value = |estimate: f64, sigma: f64| format::estimate(estimate, sigma).join(" ± ");
    let coefficients = found.calibration.coefficients();
    let rows = coefficients.iter().enumerate().map(|(index, one)| {
        let mut row = vec![
            one.id.to_owned(),
            format!("{} {}", value(one.estimate, one.sigma), one.unit),
        ];
        if let Some(with) = with.and_then(|with| with.coefficients.get(index)) {
            row.push(value(with.estimate, with.sigma));
        }
        let meaning = one.meaning.split(':').next().unwrap_or_default();
        row.push(match (one.determined, with) {
            (false, _) => "not determined".to_owned(),
            (true, None) => meaning.to_owned(),
            (true, Some(_)) => String::new(),
        });
        row
    });
    Table::new("", columns, rows)
}
