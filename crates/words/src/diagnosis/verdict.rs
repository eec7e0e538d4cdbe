//! The record, its set-up, and why names are not settled.

use gyrocal_record::printable_line;

use crate::files::{few, joined};
use crate::format::{counted, size};
use crate::means::means;
use gyrocal_answer::{Answer, SetupProblem};
use gyrocal_document::Words;

/// Records that are named.
const RECORDS_SHOWN: usize = 4;

/// The record and its size.
pub(super) fn record(result: &Answer) -> String {
    let mut size = size(result.record.rows, result.record.duration_s);
    if let Some(averaged) = &result.record.averaged {
        size += &format!(", {}", means(averaged));
    }
    if result.records.is_empty() {
        let path = result.manifest.inputs.first();
        let name = path.map_or("record".into(), |input| printable_line(&input.path));
        return format!("{name}: {size}");
    }
    let count = counted(result.records.len(), "record");
    let names = few(result.records.iter().map(|one| &one.name), RECORDS_SHOWN);
    format!("{count} together ({names}): {size}")
}

/// Why names are not settled.
#[must_use]
pub fn not_settled(result: &Answer) -> String {
    let cut = (!result.search_complete).then_some("the search ended at its budget of work");
    let left = result.is_unexplained();
    let left = left.then_some("what is left is not white");
    let why = joined(cut.into_iter().chain(left), ", and ");
    let found = match result.findings.len() {
        0 => "no effect is named".to_owned(),
        count => format!("{} so far", counted(count, "effect")),
    };
    format!("{found}, {why}")
}

/// Gross errors of the set-up, as a list; `None` if there are none.
#[must_use]
pub fn setup(problems: &[SetupProblem]) -> Option<Words> {
    Words::list(
        "Errors of the set-up",
        problems.iter().map(SetupProblem::text),
    )
}
