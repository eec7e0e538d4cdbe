//! Effects by their statistic in the first search: each that is reported with what it cannot be told from,
//! then others. Bars of a page and a picture show the same.

use gyrocal_diagnosis::{DiagnosisResult, prose};
use gyrocal_plant::answer::Diagnosis;
use gyrocal_report::page::{Bar, BarGroup, Bars, Tint};
use gyrocal_report::{Omitted, RankedEffect, Ranking, RankingGroup, Role};
use gyrocal_statistics::format;

use crate::words::listed;

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS: usize = 10;

/// Remark beside an effect that no record tells from the reported one.
const EQUIVALENT: &str = "exact equivalent";

/// A search with its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    threshold: f64,
    false_alarm_probability: f64,
    /// Effects with their statistics, the largest first.
    statistics: Vec<(String, f64)>,
    causes: Vec<Cause>,
}

/// A reported effect.
#[derive(Clone, Debug, PartialEq)]
struct Cause {
    effect: String,
    /// Its size in standard deviations.
    z: f64,
    equivalents: Vec<String>,
    /// Alternatives with their likelihood in words.
    alternatives: Vec<(String, String)>,
}

impl Ranked {
    /// Of a diagnosis of the platform; `None` if nothing was searched.
    #[must_use]
    pub fn of_result(result: &DiagnosisResult) -> Option<Self> {
        let threshold = result.threshold.filter(|threshold| *threshold > 0.0)?;
        let statistics = result.ranking.iter();
        let causes = result.causes().map(|finding| Cause {
            effect: finding.effect.clone(),
            z: finding.z,
            equivalents: finding
                .equivalents
                .iter()
                .map(|equal| equal.effect.clone())
                .collect(),
            alternatives: finding
                .alternatives
                .iter()
                .map(|other| (other.effect.clone(), prose::likelihood(other)))
                .collect(),
        });
        let ranked = Self {
            threshold,
            false_alarm_probability: result.false_alarm_shares.search,
            statistics: statistics
                .map(|one| (one.effect.clone(), one.statistic))
                .collect(),
            causes: causes.collect(),
        };
        (!ranked.statistics.is_empty()).then_some(ranked)
    }

    /// Of a diagnosis of a plant; `None` if nothing was searched.
    #[must_use]
    pub fn of_plant(answer: &Diagnosis) -> Option<Self> {
        let causes = answer.findings.iter().map(|found| Cause {
            effect: found.effect.clone(),
            z: found.z,
            equivalents: found.equivalents.clone(),
            alternatives: found
                .rivals
                .iter()
                .map(|(id, deficit)| (id.clone(), format!("{deficit:.1} nats less likely")))
                .collect(),
        });
        let statistics = answer.ranking.iter();
        if answer.threshold <= 0.0 {
            return None;
        }
        let ranked = Self {
            threshold: answer.threshold,
            false_alarm_probability: answer.false_alarm_probability,
            statistics: statistics
                .map(|one| (one.effect.clone(), one.statistic))
                .collect(),
            causes: causes.collect(),
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
            let equal = cause.equivalents.iter();
            effects.extend(equal.map(|equal| bar(equal, Role::Alternative, EQUIVALENT)));
            let others = cause.alternatives.iter();
            effects.extend(others.map(|(id, note)| bar(id, Role::Alternative, note)));
            shown.push(&cause.effect);
            shown.extend(cause.equivalents.iter().map(String::as_str));
            shown.extend(cause.alternatives.iter().map(|(id, _)| id.as_str()));
            groups.push(RankingGroup {
                label: match effects.len() {
                    1 => format!("{}, no alternatives", cause.effect),
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
            "Not reported: excluded, or below the threshold".clone_into(&mut last.label);
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
            group.effects.retain(|effect| {
                // What was not tested has no bar, but alternatives are named.
                effect.statistic.is_finite() || effect.note != EQUIVALENT
            });
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
