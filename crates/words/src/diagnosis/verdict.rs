//! The record and the verdict on it.

use gyrocal_record::printable_line;
use gyrocal_statistics::format::percent;

use crate::files::few;
use crate::format::{counted, tested};
use gyrocal_answer::{Answer, Finding, FindingKind, ResidualVerdict, SetupProblem, Verdict};
use gyrocal_document::{List, Words};

/// Records that are named.
const RECORDS_SHOWN: usize = 4;

/// The record and its size.
pub(super) fn record(result: &Answer) -> String {
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
pub(super) fn verdict(result: &Answer) -> String {
    let alarm = format!(
        "false-alarm rate of the diagnosis {}",
        percent(result.false_alarm_probability)
    );
    match result.verdict {
        Verdict::EffectsFound => format!(
            "Model mismatch detected: {} (family-wise {}; {alarm}).",
            counted(result.findings.len(), "effect"),
            tested(least_p_value(result)),
        ),
        Verdict::NotSettled => format!("Not settled: {} ({alarm}).", not_settled(result)),
        Verdict::Unexplained => format!(
            "Model mismatch detected: no effect of the catalogue explains it (family-wise {}; \
             {alarm}).",
            tested(result.remainder.p_value)
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
pub(super) fn unfinished(result: &Answer) -> Option<String> {
    (!result.search_complete).then(|| {
        "The search ended at its budget of work: there may be more in the record than these effects, and \
         effects that they were not compared with. Names, sizes and coefficients are what was found until \
         then. Look at the residuals (--figures); if they are not white, mend the largest fault, and record \
         again."
            .to_owned()
    })
}

/// Why names are not settled.
#[must_use]
pub fn not_settled(result: &Answer) -> String {
    let cut = (!result.search_complete).then_some("the search ended at its budget of work");
    let left = result
        .is_unexplained()
        .then_some("what is left is not white");
    let why: Vec<&str> = cut.into_iter().chain(left).collect();
    let found = match result.findings.len() {
        0 => "no effect is named".to_owned(),
        count => format!("{} so far", counted(count, "effect")),
    };
    format!("{found}, {}", why.join(", and "))
}

/// The smallest p-value: of the diagnosis itself, and of a filter only if there is nothing else.
fn least_p_value(result: &Answer) -> Option<f64> {
    let (filter, own): (Vec<&Finding>, Vec<&Finding>) = result
        .findings
        .iter()
        .partition(|finding| finding.kind == FindingKind::Filter);
    let all = if own.is_empty() { filter } else { own };
    let all = all.into_iter().filter_map(|finding| finding.p_value);
    all.reduce(f64::min)
}

/// The caveat on the verdict of a short record.
fn low_power(result: &Answer) -> String {
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
pub fn setup(problems: &[SetupProblem]) -> Option<Words> {
    let entries = problems.iter().map(SetupProblem::text);
    List::of("Errors of the set-up", entries).map(Words::List)
}
