//! What the families' statistics say: the best of each, and which of them is named.

use super::bank::Bank;
use super::family::Family;
use super::knock::Knock;
use super::null::Null;
use super::walk::Walk;

/// A richer effect than one that it contains must be better by the 5 % point of chi-square with
/// one degree of freedom.
pub(crate) const RICHER: f64 = 3.84;

/// One family in the first search.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Public id of the effect.
    pub effect: &'static str,
    /// Its largest statistic, as the test of whether anything is there takes it.
    pub statistic: f64,
}

/// The best candidate of a family.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    pub(super) family: usize,
    pub(super) candidate: usize,
    pub(super) statistic: f64,
    /// Variance of the increments of a random walk; onset of a knock, s.
    pub(super) shape: f64,
    /// What a knock's statistic loses for having been looked for in every step.
    pub(super) searched: f64,
}

/// The best candidate of every family, and what searching alone reaches.
pub(super) struct Scores<'a> {
    pub(super) best: Vec<Option<Best>>,
    null: &'a Null,
}

impl<'a> Scores<'a> {
    pub(super) fn of(
        bank: &Bank,
        families: &[Family],
        null: &'a Null,
        knock: Option<Knock>,
    ) -> Self {
        let best = families
            .iter()
            .enumerate()
            .map(|(family, content)| {
                if content.knock && content.candidates.is_empty() {
                    return knock.map(|knock| Best {
                        family,
                        candidate: 0,
                        statistic: knock.equivalent,
                        shape: knock.onset_s,
                        searched: knock.statistic - knock.equivalent,
                    });
                }
                if let Some(steps) = &content.walk {
                    let (information, score) = bank.part(steps);
                    let (statistic, variance) = Walk::new(information).best(&score);
                    return Some(Best {
                        family,
                        candidate: 0,
                        statistic,
                        shape: variance,
                        searched: 0.0,
                    });
                }
                content
                    .candidates
                    .iter()
                    .enumerate()
                    .filter_map(|(candidate, columns)| {
                        bank.joint(&columns.columns).map(|joint| Best {
                            family,
                            candidate,
                            statistic: joint.statistic,
                            shape: 0.0,
                            searched: 0.0,
                        })
                    })
                    .max_by(|a, b| a.statistic.total_cmp(&b.statistic))
            })
            .collect();
        Self { best, null }
    }

    pub(super) fn penalised(&self, family: usize) -> f64 {
        self.best[family].map_or(f64::NEG_INFINITY, |best| {
            best.statistic - self.null.penalties[family]
        })
    }

    /// The statistic of a family as the test takes it.
    pub(super) fn tested(&self, family: usize) -> f64 {
        self.best[family].map_or(f64::NEG_INFINITY, |best| {
            best.statistic - self.null.paid[family]
        })
    }

    /// The statistic of the test: the largest of all.
    pub(super) fn largest(&self) -> f64 {
        (0..self.best.len())
            .map(|family| self.tested(family))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The penalised statistic, a random walk behind what follows a law.
    fn preferred(&self, families: &[Family], family: usize) -> f64 {
        let walk = families[family].walk.is_some();
        self.penalised(family) - if walk { RICHER } else { 0.0 }
    }

    /// The family to be named: the best, or a simpler one that it contains if it is not
    /// significantly better than that; of equivalents the first.
    pub(super) fn named(&self, families: &[Family]) -> Option<Best> {
        let best = (0..families.len())
            .filter(|family| self.best[*family].is_some())
            .max_by(|a, b| {
                self.preferred(families, *a)
                    .total_cmp(&self.preferred(families, *b))
            })?;
        // Of equivalents the first in the table, which the families follow.
        let equivalents = families[best].effect.equivalents;
        let best = (0..best)
            .find(|other| {
                self.best[*other].is_some() && equivalents.contains(&families[*other].id())
            })
            .unwrap_or(best);
        let nested = families[best].effect.nested;
        if !nested.is_empty() {
            let simple = (0..families.len())
                .filter(|family| nested.contains(&families[*family].id()))
                .filter_map(|family| self.best[family])
                .max_by(|a, b| a.statistic.total_cmp(&b.statistic));
            let richer = self.best[best].map_or(0.0, |best| best.statistic);
            if let Some(simple) = simple
                && richer - simple.statistic < RICHER
            {
                return Some(simple);
            }
        }
        self.best[best]
    }

    pub(super) fn ranking(&self, families: &[Family]) -> Vec<Ranked> {
        let mut ranking: Vec<Ranked> = families
            .iter()
            .enumerate()
            .filter(|(index, _)| self.best[*index].is_some())
            .map(|(index, family)| Ranked {
                effect: family.id(),
                statistic: self.tested(index),
            })
            .collect();
        ranking.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
        ranking
    }
}

#[cfg(test)]
mod tests {
    use gyrocal::generated::catalogue::EFFECTS;

    use super::*;

    fn family(id: &str) -> Option<Family> {
        Some(Family {
            effect: EFFECTS.iter().find(|effect| effect.id == id)?,
            candidates: Vec::new(),
            walk: None,
            knock: false,
        })
    }

    /// What is named of a warm-up with a statistic of 60 beside a ramp and a wrong first attitude.
    fn named(ramp: f64, attitude: f64) -> Option<&'static str> {
        let ids = ["gyro_x.ramp", "platform.initial_attitude", "gyro_x.warmup"];
        let families: Vec<Family> = ids.into_iter().filter_map(family).collect();
        let null = Null::of_no_search(families.len());
        let statistics = [ramp, attitude, 60.0].into_iter().enumerate();
        let best = statistics.map(|(family, statistic)| {
            Some(Best {
                family,
                candidate: 0,
                statistic,
                shape: 0.0,
                searched: 0.0,
            })
        });
        let scores = Scores {
            best: best.collect(),
            null: &null,
        };
        Some(families[scores.named(&families)?.family].id())
    }

    #[test]
    fn a_warm_up_gives_way_to_the_better_of_the_simpler_effects() {
        assert_eq!(named(40.0, 40.0), Some("gyro_x.warmup"));
        assert_eq!(named(58.0, 40.0), Some("gyro_x.ramp"));
        assert_eq!(named(40.0, 58.0), Some("platform.initial_attitude"));
        assert_eq!(named(57.0, 58.0), Some("platform.initial_attitude"));
        // By less than the 5 % point of chi-square, 3.84.
        assert_eq!(named(56.1, 40.0), Some("gyro_x.warmup"));
        assert_eq!(named(56.2, 40.0), Some("gyro_x.ramp"));
    }
}
