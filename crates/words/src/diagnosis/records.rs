//! Several records of one platform.

use gyrocal_statistics::format::with_sigma;

use crate::files::{input_files, joined};
use crate::format::behind;
use gyrocal_answer::{Answer, Finding, SizeChoice, Verdict};

/// Whether an effect has one size in all records, and its sizes in each.
#[must_use]
pub fn sizes(finding: &Finding) -> Option<String> {
    let found = finding.by_record.as_ref()?;
    let odds = found.log_odds_nats.abs();
    let words = match found.choice {
        SizeChoice::Shared => {
            format!("one size in all records ({odds:.1} nats better than one for each)")
        }
        SizeChoice::PerTurnOn => {
            format!("a size for each turn-on ({odds:.1} nats better than one size)")
        }
        SizeChoice::Undecided => {
            format!("one size or one for each turn-on: cannot be told apart ({odds:.1} nats)")
        }
    };
    let unit = behind(finding.parameters.first().map_or("1", |size| &size.unit));
    let sizes = found.sizes.iter().map(|one| {
        let own = one.estimates.iter();
        let own = own.map(|size| with_sigma(size.estimate, size.sigma));
        format!("{} in record {}", joined(own, ", "), one.record + 1)
    });
    Some(format!("{words}: {}{unit}", joined(sizes, ", ")))
}

/// The answer of a record alone, in a few words.
#[must_use]
pub fn alone(result: &Answer) -> String {
    match result.verdict {
        Verdict::Clean if result.hides_most() => "too short to tell".to_owned(),
        Verdict::Clean => "no fault found".to_owned(),
        Verdict::Unexplained => "unexplained".to_owned(),
        Verdict::Setup => "wrong set-up".to_owned(),
        verdict => {
            let findings = result.findings.iter();
            let ids = joined(findings.map(|finding| &finding.effect), ", ");
            match (verdict, ids.is_empty()) {
                (Verdict::NotSettled, true) => "not settled".to_owned(),
                (Verdict::NotSettled, false) => format!("{ids} (not settled)"),
                _ => ids,
            }
        }
    }
}

/// The files of a result as arguments of `calibrate` and `diagnose`, as a shell reads them.
#[must_use]
pub fn files(result: &Answer) -> String {
    input_files(&result.manifest.inputs, result.is_strapdown(), &[])
}
