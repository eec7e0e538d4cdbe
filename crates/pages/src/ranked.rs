//! Effects by their statistic in the first search: each that is reported with what it cannot be told from,
//! then others.

use gyrocal_answer::Answer;
use gyrocal_document::{Bar, BarGroup, Bars, Item, Section, Tint};
use gyrocal_statistics::format;

use crate::words::{listed, section as titled};

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS: usize = 10;

/// The section of a search; `None` if nothing was searched.
pub(crate) fn section(answer: &Answer) -> Option<Section> {
    let lead = "Each effect of the catalogue was tested against the nominal model. An effect beyond the dashed \
                threshold is significant; those that resemble a stronger one are explained by it.";
    let threshold = answer.threshold.filter(|threshold| *threshold > 0.0)?;
    let bars = (!answer.ranking.is_empty()).then(|| Item::Bars(bars(answer, threshold)))?;
    Some(titled("ranking", "Ranking", lead, vec![bars]))
}

/// The reported effects, or the strongest of none.
fn title(answer: &Answer) -> String {
    let causes: Vec<&str> = answer.causes().map(|one| &*one.effect).collect();
    let (count, first) = (answer.ranking.len(), answer.ranking.first());
    match &*causes {
        [] => format!(
            "None of {count} effects exceeds the threshold; the strongest is {}",
            first.map_or("", |one| &one.effect)
        ),
        found => format!("{} detected among {count} effects tested", listed(found)),
    }
}

/// Groups of bars, and what is left out of them.
fn groups(answer: &Answer) -> (Vec<BarGroup>, String) {
    let bar = |effect: &str, tint: Tint, note: String| {
        let own = answer.ranking.iter().find(|one| one.effect == effect);
        Bar {
            label: effect.to_owned(),
            value: own.map_or(f64::NAN, |one| one.statistic),
            tint,
            note,
        }
    };
    let is_settled = answer.is_settled();
    let mut groups = Vec::new();
    let mut shown: Vec<&str> = Vec::new();
    for cause in answer.causes() {
        let effect = &cause.effect;
        let note = format!("reported, {:.1} sigma", cause.z);
        let mut bars = vec![bar(effect, Tint::Extended, note)];
        shown.push(effect);
        for other in &cause.alternatives {
            let note = gyrocal_words::likelihood(other);
            bars.push(bar(&other.effect, Tint::Alternative, note));
            shown.push(&other.effect);
        }
        let label = match bars.len() {
            1 if is_settled => format!("{effect}, no alternatives"),
            1 => effect.clone(),
            _ => format!("{effect} and its alternatives"),
        };
        groups.push(BarGroup { label, bars });
    }
    let rest = answer.ranking.iter();
    let rest: Vec<_> = rest.filter(|one| !shown.contains(&&*one.effect)).collect();
    let label = match is_settled {
        true => "Not reported: excluded, or below the threshold",
        false => "Not reported",
    };
    let others = rest.iter().take(OTHERS);
    let others = others.map(|one| bar(&one.effect, Tint::Other, String::new()));
    groups.push(BarGroup::new(label, others));
    let omitted = rest.get(OTHERS).map(|largest| {
        format!(
            "{} more effects are not shown; the largest statistic among them is {:.1}.",
            rest.len() - OTHERS,
            largest.statistic
        )
    });
    (groups, omitted.unwrap_or_default())
}

fn bars(answer: &Answer, threshold: f64) -> Bars {
    let (groups, omitted) = groups(answer);
    let quantity = "score statistic, first search (chi-square, penalised for search)";
    let shares = answer.false_alarm_shares.as_ref();
    let probability = shares.map_or(answer.false_alarm_probability, |shares| shares.search);
    let meaning = format!(
        "detection threshold, false-alarm probability {} over all effects",
        format::percent(probability)
    );
    Bars {
        threshold: Some((threshold, meaning)),
        omitted,
        ..Bars::new(&title(answer), quantity, groups)
    }
}
