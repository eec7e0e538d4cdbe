//! Effects by their statistic in the first search: each that is reported with what it cannot be told from,
//! then others.

use gyrocal_answer::Answer;
use gyrocal_document::{Bar, BarGroup, Bars, Item, Section, Tint};
use gyrocal_statistics::format;

use crate::words::listed;

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS: usize = 10;

/// The section of a search; `None` if nothing was searched.
pub(crate) fn section(answer: &Answer) -> Option<Section> {
    let lead = "Each effect of the catalogue was tested against the nominal model. An effect beyond the dashed \
                threshold is significant; those that resemble a stronger one are explained by it.";
    Some(Section {
        id: "ranking".to_owned(),
        title: "Ranking".to_owned(),
        lead: lead.to_owned(),
        items: vec![Item::Bars(Ranked::of(answer)?.bars())],
    })
}

/// A search with its result.
#[derive(Clone, Debug, PartialEq)]
struct Ranked {
    threshold: f64,
    false_alarm_probability: f64,
    /// Effects with their statistics, the largest first.
    statistics: Vec<(String, f64)>,
    causes: Vec<Cause>,
    /// Whether what is not among them is excluded.
    is_settled: bool,
}

/// A reported effect.
#[derive(Clone, Debug, PartialEq)]
struct Cause {
    effect: String,
    /// Its size in standard deviations.
    z: f64,
    /// All that it may also be, with how it stands to it in words.
    alternatives: Vec<(String, String)>,
}

impl Ranked {
    /// Of an answer; `None` if nothing was searched.
    fn of(answer: &Answer) -> Option<Self> {
        let threshold = answer.threshold.filter(|threshold| *threshold > 0.0)?;
        let statistics = answer.ranking.iter();
        let causes = answer.causes().map(|finding| Cause {
            effect: finding.effect.clone(),
            z: finding.z,
            alternatives: finding
                .alternatives
                .iter()
                .map(|other| (other.effect.clone(), gyrocal_words::likelihood(other)))
                .collect(),
        });
        let shares = answer.false_alarm_shares.as_ref();
        let ranked = Self {
            threshold,
            false_alarm_probability: shares
                .map_or(answer.false_alarm_probability, |shares| shares.search),
            statistics: statistics
                .map(|one| (one.effect.clone(), one.statistic))
                .collect(),
            causes: causes.collect(),
            is_settled: answer.is_settled(),
        };
        (!ranked.statistics.is_empty()).then_some(ranked)
    }

    /// Groups of bars, and what is left out of them.
    fn groups(&self) -> (Vec<BarGroup>, String) {
        let statistic = |effect: &str| {
            let own = self.statistics.iter().find(|(id, _)| id == effect);
            own.map_or(f64::NAN, |(_, statistic)| *statistic)
        };
        let bar = |effect: &str, tint: Tint, note: &str| Bar {
            label: effect.to_owned(),
            value: statistic(effect),
            tint,
            note: note.to_owned(),
        };
        let mut groups = Vec::new();
        let mut shown: Vec<&str> = Vec::new();
        for cause in &self.causes {
            let note = format!("reported, {:.1} sigma", cause.z);
            let mut bars = vec![bar(&cause.effect, Tint::Extended, &note)];
            let others = cause.alternatives.iter();
            bars.extend(others.map(|(id, note)| bar(id, Tint::Alternative, note)));
            shown.push(&cause.effect);
            shown.extend(cause.alternatives.iter().map(|(id, _)| id.as_str()));
            groups.push(BarGroup {
                label: match bars.len() {
                    1 if self.is_settled => format!("{}, no alternatives", cause.effect),
                    1 => cause.effect.clone(),
                    _ => format!("{} and its alternatives", cause.effect),
                },
                bars,
            });
        }
        let rest = self.statistics.iter();
        let rest: Vec<_> = rest
            .filter(|(id, _)| !shown.contains(&id.as_str()))
            .collect();
        let others = rest.iter().take(OTHERS);
        let label = match self.is_settled {
            true => "Not reported: excluded, or below the threshold",
            false => "Not reported",
        };
        let others = others.map(|(id, _)| bar(id, Tint::Other, ""));
        groups.push(BarGroup::new(label, others));
        let omitted = rest.get(OTHERS).map(|(_, largest)| {
            format!(
                "{} more effects are not shown; the largest statistic among them is {largest:.1}.",
                rest.len() - OTHERS
            )
        });
        (groups, omitted.unwrap_or_default())
    }

    /// The reported effects, or the strongest of none.
    fn title(&self) -> String {
        let causes: Vec<&str> = self.causes.iter().map(|one| one.effect.as_str()).collect();
        let (count, first) = (self.statistics.len(), self.statistics.first());
        match &*causes {
            [] => format!(
                "None of {count} effects exceeds the threshold; the strongest is {}",
                first.map_or("", |(id, _)| id)
            ),
            found => format!("{} detected among {count} effects tested", listed(found)),
        }
    }

    /// As bars of a page.
    fn bars(&self) -> Bars {
        let (groups, omitted) = self.groups();
        let quantity = "score statistic, first search (chi-square, penalised for search)";
        let threshold = format!(
            "detection threshold, false-alarm probability {} over all effects",
            format::percent(self.false_alarm_probability)
        );
        Bars {
            threshold: Some((self.threshold, threshold)),
            omitted,
            ..Bars::new(&self.title(), quantity, groups)
        }
    }
}
