//! What the record shows: effects with their sizes, each record alone, errors of the set-up.

use gyrocal_answer::{AlternativeKind, Answer};
use gyrocal_document::{Item, List, Section, Table};
use gyrocal_statistics::format::percent;

use crate::words::section;

/// `None` without findings.
pub(super) fn findings(result: &Answer) -> Option<Section> {
    let table = gyrocal_words::findings(result)?;
    let names = result.findings.iter().map(|finding| {
        let sizes = gyrocal_words::sizes(finding);
        let sizes = sizes.map_or_else(String::new, |sizes| format!("; {sizes}"));
        let has_rivals = finding
            .of_kind(AlternativeKind::NotExcluded)
            .next()
            .is_some();
        let coverage = finding.coverage.filter(|_| has_rivals);
        let coverage =
            coverage.map(|share| format!("; the {} confidence set has others", percent(share)));
        let coverage = coverage.unwrap_or_default();
        format!("{}: {}{sizes}{coverage}", finding.effect, finding.name)
    });
    let names = List::of("What they are", names).map(Item::from);
    let lead = "Effects that the record shows, with size, significance and gain of the predictive log score. One that \
                does not gain is not in the extended model.";
    let items = [Item::from(table)].into_iter().chain(names).collect();
    Some(section("findings", "Findings", lead, items))
}

/// Each record of several; `None` of one.
pub(super) fn records(result: &Answer) -> Option<Section> {
    let rows = result.records.iter().enumerate().map(|(index, one)| {
        let alone = one.alone.as_ref();
        [
            (index + 1).to_string(),
            one.name.clone(),
            one.record.rows.to_string(),
            alone.map_or_else(|| one.why_not_alone.clone(), gyrocal_words::alone),
        ]
    });
    let heads = "> record | name | > rows | alone";
    let table = Table::of("Each record alone", heads, rows).filled()?.into();
    let lead = "The answer of each record by itself.";
    Some(section("records", "Records", lead, vec![table]))
}

/// Errors of the set-up; `None` without any.
pub(super) fn set_up(result: &Answer) -> Option<Section> {
    let list = gyrocal_words::setup(&result.setup)?;
    let lead = "What of record and bench file is wrong, or was mended.";
    Some(section("setup", "Set-up", lead, vec![Item::Words(list)]))
}
