//! Effects by their statistic in the first search: each that is reported with what it cannot be told from,
//! then others. Bars of a page and a picture show the same.

use gyrocal_answer::Answer;
use gyrocal_report::page::{Bar, BarGroup, Bars, Tint};
use gyrocal_report::{Omitted, RankedEffect, Ranking, RankingGroup, Role};
use gyrocal_statistics::format;

use crate::words::listed;

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS: usize = 10;

/// A search with its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
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
    #[must_use]
    pub fn of(answer: &Answer) -> Option<Self> {
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
    fn groups(&self) -> (Vec<RankingGroup>, Option<Omitted>) {
        let statistic = |effect: &str| {
            let own = self.statistics.iter().find(|(id, _)| id == effect);
            own.map_or(f64::NAN, |(_, statistic)| *statistic)
        };
        let bar = |effect: &str, role: Role, note: &str| RankedEffect {
            effect: effect.to_owned(),
            statistic: statistic(effect),
            role,
            note: note.to_owned(),
        };
        let mut groups = Vec::new();
        let mut shown: Vec<&str> = Vec::new();
        for cause in &self.causes {
            let mut effects = vec![bar(&cause.effect, Role::Reported, "")];
            let others = cause.alternatives.iter();
            effects.extend(others.map(|(id, note)| bar(id, Role::Alternative, note)));
            shown.push(&cause.effect);
            shown.extend(cause.alternatives.iter().map(|(id, _)| id.as_str()));
            groups.push(RankingGroup {
                label: match effects.len() {
                    1 if self.is_settled => format!("{}, no alternatives", cause.effect),
                    1 => cause.effect.clone(),
                    _ => format!("{} and its alternatives", cause.effect),
                },
                effects,
            });
        }
        let rest = self.statistics.iter();
        let rest: Vec<_> = rest
            .filter(|(id, _)| !shown.contains(&id.as_str()))
            .collect();
        let others = rest.iter().take(OTHERS);
        groups.push(RankingGroup {
            label: "not reported".to_owned(),
            effects: others.map(|(id, _)| bar(id, Role::Other, "")).collect(),
        });
        let omitted = rest.get(OTHERS).map(|(_, largest)| Omitted {
            effects: rest.len() - OTHERS,
            largest: *largest,
        });
        (groups, omitted)
    }

    /// The reported effects, or the strongest of none, in a title.
    fn title(&self, of_none: impl Fn(usize, &str) -> String) -> String {
        let causes: Vec<&str> = self.causes.iter().map(|one| one.effect.as_str()).collect();
        let (count, first) = (self.statistics.len(), self.statistics.first());
        if causes.is_empty() {
            of_none(count, first.map_or("", |(id, _)| id))
        } else {
            format!("{} detected among {count} effects tested", listed(&causes))
        }
    }

    /// As bars of a page.
    #[must_use]
    pub fn bars(&self) -> Bars {
        let (groups, omitted) = self.groups();
        let z = |effect: &str| self.causes.iter().find(|one| one.effect == effect);
        let bar = |one: RankedEffect| Bar {
            note: match (one.role, z(&one.effect)) {
                (Role::Reported, Some(cause)) => format!("reported, {:.1} sigma", cause.z),
                _ => one.note,
            },
            tint: match one.role {
                Role::Reported => Tint::Extended,
                Role::Alternative => Tint::Alternative,
                Role::Other => Tint::Other,
            },
            label: one.effect,
            value: one.statistic,
        };
        let mut groups: Vec<BarGroup> = groups
            .into_iter()
            .map(|group| BarGroup {
                label: group.label,
                bars: group.effects.into_iter().map(bar).collect(),
            })
            .collect();
        if let Some(last) = groups.last_mut() {
            let words = match self.is_settled {
                true => "Not reported: excluded, or below the threshold",
                false => "Not reported",
            };
            words.clone_into(&mut last.label);
        }
        Bars {
            title: self.title(|count, first| {
                format!("None of {count} effects exceeds the threshold; the strongest is {first}")
            }),
            quantity: "score statistic, first search (chi-square, penalised for search)".to_owned(),
            threshold: Some((
                self.threshold,
                format!(
                    "detection threshold, false-alarm probability {} over all effects",
                    format::percent(self.false_alarm_probability)
                ),
            )),
            groups,
            omitted: omitted.map_or_else(String::new, |omitted| {
                format!(
                    "{} more effects are not shown; the largest statistic among them is {:.1}.",
                    omitted.effects, omitted.largest
                )
            }),
        }
    }

    /// As a picture; the subtitle is about the record.
    #[must_use]
    pub fn picture(&self, subtitle: &str) -> Ranking {
        let (mut groups, omitted) = self.groups();
        for group in &mut groups {
            for effect in &mut group.effects {
                if effect.role == Role::Other {
                    effect.statistic = effect.statistic.max(0.0);
                }
            }
        }
        Ranking {
            title: self.title(|count, first| {
                format!(
                    "None of {count} effects exceeds the detection threshold; the largest statistic is \
                     that of {first}"
                )
            }),
            subtitle: format!("first search, nominal model; {subtitle}"),
            statistic: "score statistic (chi-square, penalised for search)".to_owned(),
            threshold: self.threshold,
            false_alarm_probability: self.false_alarm_probability,
            tested: self.statistics.len(),
            groups,
            omitted,
        }
    }
}
