//! What a diagnosis cannot tell, and the next run.

use std::collections::BTreeMap;

use gyrocal_answer::{Answer, Verdict};
use gyrocal_document::{Item, List, Section, Table};
use gyrocal_statistics::format;
use gyrocal_words::counted;

use crate::unlisted::unlisted;
use crate::words::{listed, section};

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
    items.extend(alternatives(result).map(Item::from));
    items.extend(unlisted(result));
    items.extend(undetected(result));
    let lead = "Effects of one group explain this record equally well, or nearly so. Others were not tested, or would \
                not show.";
    section("limits", "What cannot be told apart", lead, items)
}

/// What each reported effect may also be.
fn alternatives(result: &Answer) -> Option<Table> {
    let rows = result.findings.iter().flat_map(|finding| {
        finding.alternatives.iter().map(|other| {
            [
                other.effect.clone(),
                finding.effect.clone(),
                gyrocal_words::likelihood(other),
                gyrocal_words::parameter_values(&other.parameters),
            ]
        })
    });
    let heads = "effect | in the place of | likelihood | parameters";
    Table::of("Alternatives", heads, rows).filled()
}

/// Effects that would not be detected, and those that were not tested, by reason.
fn undetected(result: &Answer) -> Vec<Item> {
    let mut rows: Vec<[String; 4]> = Vec::new();
    let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for effect in &result.not_searched {
        let mut power = result.power.iter();
        match power.find(|power| power.effect == effect.effect) {
            Some(power) => rows.push([
                effect.effect.clone(),
                effect.why.clone(),
                format!("{} {}", format::short(power.typical_size, 3), power.unit),
                power.power.map_or_else(String::new, format::percent),
            ]),
            None => by_reason
                .entry(&effect.why)
                .or_default()
                .push(&effect.effect),
        }
    }
    let heads = "effect | reason | > typical size | > chance of detection";
    let table = Table::of("Not detectable in this record", heads, rows).filled();
    let untested = by_reason.into_iter().map(|(why, effects)| {
        let count = counted(effects.len(), "effect");
        format!("{count} not tested ({why}): {}", effects.join(", "))
    });
    let untested = List::of("Not tested", untested).map(Item::from);
    let table = table.map(Item::from).into_iter();
    table.chain(untested).collect()
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
    let files = gyrocal_words::files(result);
    let plan = Item::command(format!("gyrocal plan {files}"));
    let mut items = vec![Item::text(advice(result)), plan];
    let effects: Vec<&str> = result.causes().map(|cause| &*cause.effect).collect();
    // Of several records the command has no such model.
    if !effects.is_empty() && result.records.is_empty() {
        items.push(Item::text(format!(
            "Coefficients with {} in the model:",
            listed(&effects)
        )));
        let causes = effects.join(",");
        let command = format!("gyrocal calibrate {files} --with {causes}");
        items.push(Item::command(command));
    }
    if !result.search_complete {
        items.push(Item::text(
            "The search ended at its budget of work: there may be more in the record than the effects found, \
             and effects that they were not compared with."
                .to_owned(),
        ));
    }
    let lead = if result.is_strapdown() {
        "The log that tells most, of the unit at rest in another attitude."
    } else {
        "The run that tells most, within the limits of the gimbals."
    };
    section("next", "Next run", lead, items)
}
