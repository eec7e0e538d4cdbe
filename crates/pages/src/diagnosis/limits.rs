//! What a diagnosis cannot tell, and the next run.

use gyrocal_answer::{Answer, Verdict};
use gyrocal_document::{Column, Item, List, Section, Table};
use gyrocal_statistics::format;

use super::section;
use crate::unlisted::unlisted;
use crate::words::listed;

pub(super) fn cannot_tell(result: &Answer) -> Section {
    let groups = gyrocal_words::groups(result).into_iter();
    let groups = groups.map(|[members, why, words]| {
        Item::from(List {
            title: members,
            entries: vec![format!("Why: {why}."), format!("Experiment: {words}.")],
        })
    });
    let mut items: Vec<Item> = groups.collect();
    if items.is_empty() {
        let words = match result.is_settled() {
            true => "No reported effect has an alternative in the catalogue.",
            false => {
                "Names are not settled: alternatives were not compared to the end, or not beside a white rest."
            }
        };
        items.push(Item::text(words.to_owned()));
    }
    items.extend(unlisted(result));
    items.extend(undetected(result).map(Item::from));
    section(
        "limits",
        "What cannot be told apart",
        "Effects of one group explain this record equally well, or nearly so. Effects in the table were \
         not tested, or would not show.",
        items,
    )
}

/// Effects that were not tested or would not be detected.
fn undetected(result: &Answer) -> Option<Table> {
    let rows = result.not_searched.iter().map(|effect| {
        let mut power = result.power.iter();
        let power = power.find(|power| power.effect == effect.effect);
        let size = power.map_or_else(String::new, |power| {
            format!("{} {}", format::short(power.typical_size, 3), power.unit)
        });
        let chance = power.and_then(|power| power.power);
        let chance = chance.map_or_else(String::new, format::percent);
        [effect.effect.clone(), effect.why.clone(), size, chance]
    });
    let columns = Column::heads("effect | reason | > typical size | > chance of detection");
    let title = "Not tested, or not detectable in this record";
    (!result.not_searched.is_empty()).then(|| Table::new(title, columns, rows))
}

/// The command that plans the next run.
fn plan_command(result: &Answer) -> String {
    format!("gyrocal plan {}", gyrocal_words::files(result))
}

/// What reduces the sigmas.
const FOR_SMALLER_SIGMAS: &str = "The command finds the run that reduces the sigmas most.";

/// What to do next, in a sentence.
fn advice(result: &Answer) -> String {
    let findings = result.findings.iter();
    let experiment = findings.flat_map(|one| &one.separations).next();
    match (result.verdict, experiment) {
        (Verdict::Setup, _) => "Mend the set-up, and diagnose the record again.".to_owned(),
        (Verdict::Unexplained, _) => {
            "Look at the residuals below, and record again under other conditions.".to_owned()
        }
        (Verdict::NotSettled, None) => {
            "Look at the residuals below, mend the largest fault, and record again.".to_owned()
        }
        (_, Some(experiment)) => format!("To tell what remains apart: {}.", experiment.words),
        (Verdict::Clean, None) if result.hides_most() => "Record for a day or longer.".to_owned(),
        (Verdict::Clean, None) => format!("Use the coefficients. {FOR_SMALLER_SIGMAS}"),
        (Verdict::EffectsFound, None) => {
            format!("No alternative of the catalogue is left. {FOR_SMALLER_SIGMAS}")
        }
    }
}

pub(super) fn next_run(result: &Answer) -> Section {
    let mut items = vec![
        Item::text(advice(result)),
        Item::command(plan_command(result)),
    ];
    let effects: Vec<&str> = result.causes().map(|cause| &*cause.effect).collect();
    // Of several records the command has no such model.
    if !effects.is_empty() && result.records.is_empty() {
        items.push(Item::text(format!(
            "Coefficients with {} in the model:",
            listed(&effects)
        )));
        items.push(Item::command(format!(
            "gyrocal calibrate {} --with {}",
            gyrocal_words::files(result),
            effects.join(",")
        )));
    }
    if !result.search_complete {
        items.push(Item::text(
            "The search ended at its budget of work: there may be more in the record than the effects found, \
             and effects that they were not compared with."
                .to_owned(),
        ));
    }
    section(
        "next",
        "Next run",
        if result.is_strapdown() {
            "The log that tells most, of the unit at rest in another attitude."
        } else {
            "The run that tells most, within the limits of the gimbals."
        },
        items,
    )
}
