//! What a record of a plant cannot tell.

use gyrocal_answer::Answer;
use gyrocal_document::{Item, List, Section, Table};

use crate::unlisted::unlisted;
use crate::words::section;

pub(super) fn cannot_tell(answer: &Answer) -> Section {
    let directions = |is_gauge: bool| {
        let all = answer.undetermined.iter();
        let own = all.filter(move |one| one.is_gauge == is_gauge);
        own.map(gyrocal_words::plant::direction)
    };
    let still = answer.still_inputs.iter();
    let still = still
        .map(|input| format!("{input}: nothing that depends on it can be told from a constant"));
    let gauges = "Gauges: no record of this plant shows them";
    let lists = [
        List::of(gauges, directions(true)),
        List::of("Not excited in this record", directions(false)),
        List::of("Inputs that never move", still),
    ];
    let mut items: Vec<Item> = lists.into_iter().flatten().map(Item::from).collect();
    let rows = answer.not_searched.iter();
    let rows = rows.map(|one| [one.effect.clone(), one.why.clone()]);
    let untested = Table::of("Effects that were not tested", "effect | reason", rows);
    items.extend(untested.filled().map(Item::from));
    if items.is_empty() {
        let all = match answer.is_settled() {
            true => {
                "The record determines all parameters and initial states, and every effect of the catalogue was \
                 tested."
            }
            false => {
                "The record determines all parameters and initial states. Names are not settled: effects were not \
                 compared to the end, or not beside a white rest."
            }
        };
        items.push(Item::text(all.to_owned()));
    }
    items.extend(unlisted(answer));
    let lead = "Directions of parameters and initial states without information, and effects that these take up.";
    section("cannot-tell", "What cannot be told apart", lead, items)
}
