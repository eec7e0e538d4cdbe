//! The sentences and tables of what a fleet shows.

use gyrocal_document::{Screen, Standing, Table, Words};
use gyrocal_statistics::format;
use gyrocal_words::{capitalised, counted, few, joined};

use crate::answer::{
    FleetCoefficient, FleetResult, Group, GroupFinding, GroupKind, RecurringCause, WithInterval,
};

/// Units that are named in a sentence.
const NAMED: usize = 5;

/// The answer in sentences, in reading order.
#[must_use]
pub fn all(fleet: &FleetResult) -> Vec<Words> {
    let mut blocks = vec![
        Words::Paragraph(size(fleet)),
        Words::Paragraph(verdict(fleet)),
    ];
    blocks.extend(Words::list(
        "Causes that recur below what units show by themselves",
        fleet.recurring.iter().map(recurring),
    ));
    let groups = fleet.groups.iter().map(group);
    blocks.extend(Words::list("Batches and sites that differ", groups));
    blocks.extend(Words::list("Units outside of the others", outliers(fleet)));
    let found = fleet.found_in_units.iter().map(|one| {
        let units = counted(one.units.len(), "unit");
        format!("`{}` in {units}: {}", one.effect, few(&one.units, NAMED))
    });
    blocks.extend(Words::list("Causes that units show by themselves", found));
    let problems = fleet.problems.iter();
    let problems = problems.map(|one| format!("{}/{}: {}", one.unit, one.record, one.problem));
    blocks.extend(Words::list("Records that are left out", problems));
    blocks
}

/// The first screen: what recurs, and what differs.
#[must_use]
pub fn first_screen(fleet: &FleetResult) -> Screen {
    let is_clean = fleet.recurring.is_empty() && fleet.groups.is_empty();
    let is_whole = fleet.not_settled == 0 && fleet.problems.is_empty();
    let (standing, words) = match (fleet.recurring.is_empty(), is_clean) {
        (false, _) => (Standing::Bad, "UNITS SHARE CAUSES"),
        (true, false) => (Standing::Bad, "GROUPS OF UNITS DIFFER"),
        // Records that are left out or not settled may hide what recurs.
        (true, true) if !is_whole => (Standing::Doubtful, "NOTHING FOUND BEYOND SINGLE UNITS"),
        (true, true) => (Standing::Good, "NOTHING BEYOND SINGLE UNITS"),
    };
    let mut screen = Screen::new(standing, words, verdict(fleet));
    screen.each("recurs", fleet.recurring.iter().map(recurring));
    screen.each("differs", fleet.groups.iter().map(group));
    screen.fact("fleet", size(fleet));
    screen
}

/// Number of units and records.
#[must_use]
pub fn size(fleet: &FleetResult) -> String {
    let units = counted(fleet.units, "unit");
    let records = counted(fleet.records, "record");
    let left_out = match fleet.problems.len() {
        0 => String::new(),
        left_out => format!("; {left_out} more are left out"),
    };
    let open = match fleet.not_settled {
        0 => String::new(),
        1 => " The diagnosis of one record is not settled.".to_owned(),
        open => format!(" The diagnoses of {open} records are not settled."),
    };
    format!("The fleet has {units} with {records}{left_out}.{open}")
}

/// The answer in a sentence.
#[must_use]
pub fn verdict(fleet: &FleetResult) -> String {
    let recurring = fleet.recurring.iter();
    let recurring = joined(recurring.map(|one| format!("`{}`", one.effect)), ", ");
    let causes = match fleet.recurring.len() {
        0 => "No cause recurs below what the units show by themselves".to_owned(),
        1 => format!("One cause recurs below what the units show by themselves, {recurring}"),
        count => {
            format!("{count} causes recur below what the units show by themselves: {recurring}")
        }
    };
    let groups = fleet.groups.iter().map(|one| group_name(&one.group));
    let groups = match &*joined(groups, ", ") {
        "" => "no batch and no site differs".to_owned(),
        groups => format!("the others differ from {groups}"),
    };
    format!(
        "{causes}; {groups}. The false discovery rate of causes is {}, the probability of a false batch or \
         site {}.",
        format::percent(fleet.false_discovery_rate),
        format::percent(fleet.group_probability),
    )
}

/// A recurring cause in a sentence.
#[must_use]
pub fn recurring(cause: &RecurringCause) -> String {
    let mut text = format!("`{}`, {}: ", cause.effect, format::p_value(cause.p_value));
    match (cause.is_common, cause.size, cause.size_sigma) {
        (true, Some(size), Some(sigma)) => {
            text += &format!(
                "one size in all units, {} {}",
                format::with_sigma(size, sigma),
                cause.unit
            );
        }
        _ => {
            text += &format!(
                "in about {} of the units, at {} standard deviations of a unit",
                format::percent((100.0 * cause.share).round() / 100.0),
                format::short(cause.strength, 2)
            );
        }
    }
    if !cause.is_common && !cause.units.is_empty() {
        let units = few(cause.units.iter().map(|one| &one.unit), NAMED);
        text += &format!(", more likely than not in {units}");
    }
    if !cause.alternatives.is_empty() {
        text += &format!(
            "; the fleet does not tell it from {}",
            cause.alternatives.join(", ")
        );
    }
    if !cause.by_e_value {
        text +=
            "; its rate of false discoveries rests on tests that depend positively on one another";
    }
    text + "."
}

/// A batch or site in a sentence.
#[must_use]
pub fn group(finding: &GroupFinding) -> String {
    let mut text = format!(
        "{} ({}) differs in `{}` by {} {}, {}",
        capitalised(&group_name(&finding.group)),
        counted(finding.units, "unit"),
        finding.coefficient,
        interval(&finding.offset),
        finding.unit,
        format::p_value(finding.p_value)
    );
    for other in &finding.alternatives {
        text += &format!(
            "; {} explains it as well, {} of its {} are the same",
            group_name(&other.group),
            other.shared,
            counted(other.units, "unit")
        );
    }
    text + "."
}

fn group_name(group: &Group) -> String {
    match group.kind {
        GroupKind::Batch => format!("batch {}", group.name),
        GroupKind::Site => format!("site {}", group.name),
    }
}

fn outliers(fleet: &FleetResult) -> Vec<String> {
    let of = |one: &FleetCoefficient| {
        let level = one.outliers.iter().map(|outlier| (outlier, "", ""));
        let ageing = one.ageing_outliers.iter();
        let ageing = ageing.map(|outlier| (outlier, "a change of ", " in a year"));
        let entries = level.chain(ageing).map(|(outlier, before, after)| {
            format!(
                "{}: `{}` is {before}{} {}{after}, {} standard deviations from the mean of the others, {}",
                outlier.unit,
                one.name,
                format::short(outlier.estimate, 4),
                one.unit,
                format::short(outlier.t, 3),
                format::p_value(outlier.p_value)
            )
        });
        entries.collect::<Vec<String>>()
    };
    fleet.coefficients.iter().flat_map(of).collect()
}

/// Estimate and interval with the digits that the interval allows.
fn interval(found: &WithInterval) -> String {
    let [low, high] = found.interval;
    let [estimate, _] = format::estimate(found.estimate, 0.25 * (high - low));
    let decimals = estimate
        .split_once('.')
        .map_or(0, |(_, digits)| digits.len());
    format!("{estimate} ({low:.decimals$} to {high:.decimals$})")
}

/// Mean, spread and ageing of each coefficient.
#[must_use]
pub fn coefficients(fleet: &FleetResult) -> Table {
    let cell = |found: &Option<WithInterval>| found.as_ref().map_or_else(String::new, interval);
    let rows = fleet.coefficients.iter().map(|one| {
        vec![
            one.name.clone(),
            cell(&one.mean),
            cell(&one.spread),
            cell(&one.repeatability),
            cell(&one.ageing),
            one.unit.clone(),
        ]
    });
    Table::of(
        "Drift coefficients over the units, with 95 % intervals",
        "coefficient | > mean | > spread of units | > record to record | > change in a year | unit",
        rows,
    )
}
