//! The record and the verdict on it.

use gyrocal_record::printable_line;
use gyrocal_statistics::format::{p_value, percent};

use super::Block;
use super::format::counted;
use super::screen::few;
use crate::result::{DiagnosisResult, FindingKind, ResidualVerdict, SetupProblem, Verdict};

/// Records that are named.
const RECORDS_SHOWN: usize = 4;

/// The record and its size.
pub(super) fn record(result: &DiagnosisResult) -> String {
    if !result.records.is_empty() {
        let names: Vec<&str> = result.records.iter().map(|one| &*one.name).collect();
        return format!(
            "{} together ({}): {} over {:.2} days",
            counted(names.len(), "record"),
            few(&names, RECORDS_SHOWN),
            counted(result.record.rows, "row"),
            result.record.duration_s / 86_400.0
        );
    }
    let path = result.manifest.inputs.first();
    format!(
        "{}: {} over {:.2} days",
        path.map_or("record".into(), |input| printable_line(&input.path)),
        counted(result.record.rows, "row"),
        result.record.duration_s / 86_400.0
    )
}

/// The verdict with its error probabilities.
pub(super) fn verdict(result: &DiagnosisResult) -> String {
    let alarm = format!(
        "false-alarm rate of the diagnosis {}",
        percent(result.false_alarm_probability)
    );
    match result.verdict {
        Verdict::EffectsFound => format!(
            "Model mismatch detected: {} (family-wise {}; {alarm}).",
            counted(result.findings.len(), "effect"),
            p_value(least_p_value(result)),
        ),
        Verdict::Unexplained if result.remainder.verdict != ResidualVerdict::Unexplained => {
            "Not settled: the search ended at its budget of work, with no effect named.".to_owned()
        }
        Verdict::Unexplained => format!(
            "Model mismatch detected: no effect of the catalogue explains it (family-wise {}; \
             {alarm}).",
            p_value(result.remainder.p_value)
        ),
        Verdict::Setup => "Error of the set-up: the record was not diagnosed.".to_owned(),
        Verdict::Clean => {
            let noise = if result
                .noise_audit
                .is_some_and(|audit| audit.correlation.is_some())
            {
                "noise as declared"
            } else {
                "no outliers, no quantisation (the record is too short for a spectrum of its noise)"
            };
            let white = match result.remainder.verdict {
                ResidualVerdict::White => ", innovations white",
                _ => "",
            };
            format!(
                "No model mismatch detected: {noise}, no effect of the catalogue significant{white} \
                 ({alarm}).{}",
                low_power(result)
            )
        }
    }
}

/// The caveat on a search that ended at its budget of work.
pub(super) fn unfinished(result: &DiagnosisResult) -> Option<String> {
    (!result.search_complete).then(|| {
        "The search ended at its budget of work: there may be more in the record than these effects, and \
         effects that they were not compared with. Names, sizes and coefficients are what was found until \
         then. Look at the residuals (--figures); if they are not white, mend the largest fault, and record \
         again."
            .to_owned()
    })
}

/// The smallest p-value: of the diagnosis itself, and of a filter only if there is nothing else.
fn least_p_value(result: &DiagnosisResult) -> f64 {
    let least = |of_filter: bool| {
        let mut all = result.findings.iter();
        let first = all
            .clone()
            .any(|f| (f.kind == FindingKind::Filter) == of_filter);
        first.then(|| {
            all.by_ref()
                .filter(|finding| (finding.kind == FindingKind::Filter) == of_filter)
                .map(|finding| finding.p_value)
                .fold(1.0, f64::min)
        })
    };
    least(false).or_else(|| least(true)).unwrap_or(1.0)
}

/// The caveat on the verdict of a short record.
fn low_power(result: &DiagnosisResult) -> String {
    match result.low_power().len() {
        0 => String::new(),
        count => format!(
            " Low power: {count} of {} of typical size would go undetected in so short a record. \
             Record for a day or longer.",
            counted(result.ranking.len(), "effect")
        ),
    }
}

/// Gross errors of the set-up, as a list; `None` if there are none.
#[must_use]
pub fn setup(problems: &[SetupProblem]) -> Option<Block> {
    (!problems.is_empty()).then(|| Block::List {
        title: "Errors of the set-up:".to_owned(),
        entries: problems.iter().map(SetupProblem::text).collect(),
    })
}
