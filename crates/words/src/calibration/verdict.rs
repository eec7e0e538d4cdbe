//! The verdict on a calibration in words.

use gyrocal_document::Standing;
use gyrocal_record::{
    CalibrationMethod, CalibrationReport, EffectTest, FitVerdict, printable_line,
};
use gyrocal_statistics::format::p_value;

use super::{by_number, has_several};
use crate::files::joined;
use crate::format::capitalised;

/// The verdict in a word, and what it means in a clause.
pub(super) fn heading(report: &CalibrationReport) -> (Standing, &'static str, String) {
    let of = by_number(report, ["the record shows", "the records show"]);
    let nominal = match report.with_effects {
        None => "the model lacks: the coefficients may be biased",
        Some(_) => "the nominal model lacks",
    };
    let (standing, verdict, what) = match report.verdict {
        FitVerdict::Setup => (Standing::Bad, "SET-UP WRONG", &*report.verdict_text),
        _ if !report.usable => (
            Standing::Bad,
            "NOT USABLE",
            "the innovations are far larger than the noise: the coefficients are not usable",
        ),
        FitVerdict::EffectsFound => {
            let what = format!("{of} an effect that {nominal}");
            return (Standing::Bad, "FAULT", what);
        }
        FitVerdict::NotSettled => (
            Standing::Bad,
            "NOT SETTLED",
            "the diagnosis could not tell what the model lacks: the coefficients may be biased",
        ),
        FitVerdict::TooLarge => (
            Standing::Doubtful,
            "MISFIT",
            "the innovations are larger than the declared noise: the sigmas are too small",
        ),
        FitVerdict::TooSmall => (
            Standing::Doubtful,
            "MISFIT",
            "the innovations are smaller than the declared noise: the sigmas are too large",
        ),
        FitVerdict::Unexplained => (
            Standing::Bad,
            "UNEXPLAINED",
            "the innovations are not white, and no effect of the catalogue is significant",
        ),
        FitVerdict::NoiseDiffers => {
            let ids = noise_found(report).join(", ");
            let what = format!(
                "the noise differs from the declared ({ids}): the sigmas are not those of this noise"
            );
            return (Standing::Doubtful, "MISFIT", what);
        }
        _ if report.effects.is_empty() => (
            Standing::Doubtful,
            "CALIBRATED",
            "innovations and declared noise agree; no diagnosis could be made",
        ),
        _ if report.effects.len() < report.records.len() => (
            Standing::Doubtful,
            "CALIBRATED",
            "innovations and declared noise agree; not all records could be diagnosed",
        ),
        _ => (
            Standing::Good,
            "CALIBRATED",
            "data, model and declared noise agree",
        ),
    };
    (standing, verdict, what.to_owned())
}

/// What the noise audits of the records found.
fn noise_found(report: &CalibrationReport) -> Vec<&str> {
    let all = report.effects.iter().flat_map(|test| &test.noise);
    let mut ids: Vec<&str> = all.map(String::as_str).collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}

/// The verdict in sentences: what it means, what the diagnosis of each record says, and how sure the size of the
/// innovations is.
#[must_use]
pub fn calibration_verdict(report: &CalibrationReport) -> String {
    let (.., what) = heading(report);
    let tests = report.effects.iter();
    let tests = tests.filter_map(|test| of_record(test, has_several(report)));
    let untested = report.records.iter().filter(|record| {
        let mut tests = report.effects.iter();
        !tests.any(|test| test.record == record.record)
    });
    let untested = untested.map(|one| {
        let name = printable_line(&one.record);
        format!(
            "the record {name} could not be diagnosed: it may show effects that the model lacks"
        )
    });
    let size = how_sure(report, ", the 99.9 % band");
    let clauses = core::iter::once(what).chain(tests).chain(untested);
    let clauses = clauses.chain([size]).chain(advice(report));
    let sentences = clauses.filter(|one| !one.is_empty());
    let sentences = sentences.map(|one| format!("{}.", capitalised(&one)));
    sentences.collect::<Vec<_>>().join(" ")
}

/// How sure the verdict is: the size of the innovations, with what stands behind its band, and what the diagnoses say
/// where all agree.
pub(super) fn how_sure(report: &CalibrationReport, of_band: &str) -> String {
    let (Some(mean), Some([low, high])) = (report.nis_mean, report.nis_band) else {
        return String::new();
    };
    let is_clean = |one: &EffectTest| one.causes.is_empty() && one.settled;
    let tests = &report.effects;
    let all_tested = !tests.is_empty() && tests.len() == report.records.len();
    let effects = match report.usable && all_tested && tests.iter().all(is_clean) {
        true if tests.iter().all(|one| one.white == Some(true)) => {
            "; no effect of the catalogue is significant, innovations white"
        }
        true => "; no effect of the catalogue is significant",
        false => "",
    };
    format!("mean NIS {mean:.3} (expected {low:.3} to {high:.3}{of_band}){effects}")
}

/// What the diagnosis of a record says where it is not clean.
fn of_record(test: &EffectTest, several: bool) -> Option<String> {
    let name = match several {
        true => format!("the record {}", printable_line(&test.record)),
        false => "the record".to_owned(),
    };
    let causes = test.causes.iter().map(|one| {
        let also = match one.alternatives.is_empty() {
            true => String::new(),
            false => format!("; may also be {}", one.alternatives.join(", ")),
        };
        let p = one.p_value.map(|p| format!(", family-wise {}", p_value(p)));
        let p = p.unwrap_or_default();
        format!("{} ({:.1} sigma{p}{also})", one.effect, one.z)
    });
    let noise = match test.noise.is_empty() {
        true => String::new(),
        false => format!("noise other than declared ({})", test.noise.join(", ")),
    };
    let p = test.residual_p_value;
    let p = p.map_or_else(String::new, |p| format!(" ({})", p_value(p)));
    let coloured = match test.white {
        Some(false) => format!("innovations that are not white{p}"),
        _ => String::new(),
    };
    let shown = causes
        .chain([noise, coloured])
        .filter(|one| !one.is_empty());
    let shown = joined(shown, ", ");
    // A search that ended by itself is open where innovations are not white.
    let is_cut = !test.settled && test.white != Some(false);
    Some(match (shown.is_empty(), is_cut) {
        (true, false) => return None,
        (true, true) => format!("the search of {name} ended at its budget of work"),
        (false, false) => format!("{name} shows {shown}"),
        (false, true) => format!("{name} shows {shown}; its search ended at its budget of work"),
    })
}

/// What to look at where the innovations are too large.
fn advice(report: &CalibrationReport) -> Option<String> {
    const INPUTS: &str = "check the units of [noise] and time, that up is positive, and the latitude and initial angles \
                          of the bench file";
    let names = report.records.iter().map(|one| printable_line(&one.record));
    Some(match (report.usable, report.verdict) {
        (_, FitVerdict::Setup) => return None,
        (false, _) if has_several(report) => format!(
            "{INPUTS}. If these are records of several platforms, calibrate {} one by one. If only their turn-ons \
             differ, declare `turn_on_sigma_deg_per_h` in [prior]",
            joined(names, ", ")
        ),
        (false, _) => INPUTS.to_owned(),
        (true, FitVerdict::TooLarge) if report.method != CalibrationMethod::Batch => {
            "the model is incomplete, the noise is larger than declared, or the prior is too wide for a filter \
             of one pass"
                .to_owned()
        }
        (true, FitVerdict::TooLarge) => {
            "the model is incomplete, or the noise is larger than declared".to_owned()
        }
        _ => return None,
    })
}
