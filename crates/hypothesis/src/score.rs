//! The statistics of all hypotheses, and the choice of the one that is named.

use crate::bank::ScoreBank;
use crate::context::SearchContext;
use crate::hypothesis::Hypothesis;
use crate::jump::BestJump;
use crate::model::FittedModel;
use crate::null_distribution::NullDistribution;
use crate::random_walk::WalkScore;
use crate::shape::best_shape;

/// The 5 % point of chi-square with one degree of freedom: an effect replaces a nested one only if
/// its statistic is larger by this.
pub const NESTED_MODEL_CHI2: f64 = 3.84;

/// Share of the largest statistic above which a hypothesis is refined: midway between two variants of
/// a grid an effect has at least this share of its statistic.
const NEAR_LARGEST: f64 = 0.8;

/// One hypothesis in the first round of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// Public id of the effect.
    pub effect: &'static str,
    /// Its largest statistic less the detection penalty.
    pub statistic: f64,
}

/// The best variant of a hypothesis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best {
    pub(crate) hypothesis: usize,
    pub(crate) variant: usize,
    pub(crate) statistic: f64,
    /// Variance of the increments of a random walk; onset of a jump, s; shape between those of the
    /// variants, if it was refined.
    pub(crate) shape: f64,
    /// Whether `shape` replaces that of the variant.
    pub(crate) refined: bool,
    /// Penalty of a jump for the test of every step.
    pub(crate) searched: f64,
}

impl Best {
    /// Onset or time constant of the variant, variance of a random walk, onset of a jump; `None` of a
    /// hypothesis without any of them.
    pub(crate) fn shape(&self, hypotheses: &[Hypothesis]) -> Option<f64> {
        let own = &hypotheses[self.hypothesis];
        if own.walk.is_some() || own.is_jump || self.refined {
            return Some(self.shape);
        }
        own.variants.get(self.variant)?.shape
    }
}

/// The best variant of every hypothesis, with the search penalties.
pub(crate) struct Scores<'a> {
    pub(crate) best: Vec<Option<Best>>,
    null: &'a NullDistribution,
}

impl<'a> Scores<'a> {
    pub(crate) fn of(
        bank: &ScoreBank,
        hypotheses: &[Hypothesis],
        null: &'a NullDistribution,
        jump: Option<BestJump>,
    ) -> Self {
        let all = hypotheses.iter().enumerate();
        let best = all.map(|(index, one)| best_variant(bank, index, one, jump));
        Self {
            best: best.collect(),
            null,
        }
    }

    /// Replaces the best variants of hypotheses with a shape that are near the largest statistic by
    /// the best shapes between the variants: those of the largest effects are far apart in likelihood.
    /// `absent` are places of values of the fit that the bank was made without.
    pub(crate) fn refine<F: FittedModel>(
        &mut self,
        fitted: &F,
        context: &SearchContext<'_>,
        hypotheses: &[Hypothesis],
        absent: &[usize],
    ) -> Result<(), F::Error> {
        let statistics = self.best.iter().flatten().map(|best| best.statistic);
        let least = NEAR_LARGEST * statistics.fold(0.0, f64::max);
        for (best, hypothesis) in self.best.iter_mut().zip(hypotheses) {
            let Some(best) = best else { continue };
            let Some(shape) = best.shape(hypotheses).filter(|_| best.statistic > least) else {
                continue;
            };
            if let Some(found) = best_shape(fitted, context, hypothesis, shape, absent)?
                && found.statistic > best.statistic
            {
                *best = Best {
                    statistic: found.statistic,
                    shape: found.shape,
                    refined: true,
                    ..*best
                };
            }
        }
        Ok(())
    }

    /// The statistic for ranking: less the whole search penalty.
    pub(crate) fn penalised(&self, hypothesis: usize) -> f64 {
        self.best[hypothesis].map_or(f64::NEG_INFINITY, |best| {
            best.statistic - self.null.penalties[hypothesis]
        })
    }

    /// The statistic for detection: less the detection penalty.
    pub(crate) fn tested(&self, hypothesis: usize) -> f64 {
        self.best[hypothesis].map_or(f64::NEG_INFINITY, |best| {
            best.statistic - self.null.detection_penalties[hypothesis]
        })
    }

    /// The maximum statistic.
    pub(crate) fn largest(&self) -> f64 {
        (0..self.best.len())
            .map(|hypothesis| self.tested(hypothesis))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The penalised statistic, with random walks behind effects that follow a law.
    fn preferred(&self, hypotheses: &[Hypothesis], index: usize) -> f64 {
        let is_walk = hypotheses[index].walk.is_some();
        self.penalised(index) - if is_walk { NESTED_MODEL_CHI2 } else { 0.0 }
    }

    /// The hypothesis to name: the best, or an effect nested in it if it is not significantly better;
    /// of exact equivalents the first in the table.
    pub(crate) fn named(&self, hypotheses: &[Hypothesis]) -> Option<Best> {
        let best = (0..hypotheses.len())
            .filter(|index| self.best[*index].is_some())
            .max_by(|a, b| {
                self.preferred(hypotheses, *a)
                    .total_cmp(&self.preferred(hypotheses, *b))
            })?;
        let equivalents = hypotheses[best].effect.equivalents;
        let best = (0..best)
            .find(|other| {
                self.best[*other].is_some() && equivalents.contains(&hypotheses[*other].id())
            })
            .unwrap_or(best);
        let nested = hypotheses[best].effect.nested;
        let simpler = (0..hypotheses.len())
            .filter(|other| nested.contains(&hypotheses[*other].id()))
            .filter_map(|other| self.best[other])
            .max_by(|a, b| a.statistic.total_cmp(&b.statistic));
        let richer = self.best[best]?;
        match simpler {
            Some(simpler) if richer.statistic - simpler.statistic < NESTED_MODEL_CHI2 => {
                Some(simpler)
            }
            _ => Some(richer),
        }
    }

    pub(crate) fn ranking(&self, hypotheses: &[Hypothesis]) -> Vec<Ranked> {
        let mut ranking: Vec<Ranked> = hypotheses
            .iter()
            .enumerate()
            .filter(|(index, _)| self.best[*index].is_some())
            .map(|(index, hypothesis)| Ranked {
                effect: hypothesis.id(),
                statistic: self.tested(index),
            })
            .collect();
        ranking.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
        ranking
    }
}

fn best_variant(
    bank: &ScoreBank,
    index: usize,
    hypothesis: &Hypothesis,
    jump: Option<BestJump>,
) -> Option<Best> {
    let plain = Best {
        hypothesis: index,
        variant: 0,
        statistic: 0.0,
        shape: 0.0,
        refined: false,
        searched: 0.0,
    };
    if hypothesis.is_jump && hypothesis.variants.is_empty() {
        return jump.map(|jump| Best {
            statistic: jump.equivalent,
            shape: jump.onset_s,
            searched: jump.statistic - jump.equivalent,
            ..plain
        });
    }
    if let Some(steps) = &hypothesis.walk {
        let (information, score) = bank.part(steps);
        let (statistic, variance) = WalkScore::new(information).best(&score);
        return Some(Best {
            statistic,
            shape: variance,
            ..plain
        });
    }
    let variants = hypothesis.variants.iter().enumerate();
    variants
        .filter_map(|(variant, content)| {
            bank.joint(&content.columns).map(|joint| Best {
                variant,
                statistic: joint.statistic,
                ..plain
            })
        })
        .max_by(|a, b| a.statistic.total_cmp(&b.statistic))
}

#[cfg(test)]
mod tests {
    use gyrocal_scalar::effect::{Continuation, Effect, EffectKind, Enters, Equivalence};

    use super::*;

    const fn effect(id: &'static str, nested: &'static [&'static str]) -> Effect {
        Effect {
            id,
            family: id,
            name: "",
            reference: "",
            formula: "",
            kind: EffectKind::Constant,
            enters: Enters::Time,
            parameters: &[],
            typical_size: 1.0,
            is_nominal: false,
            default_search: true,
            needs: &[],
            equivalents: &[],
            equivalence: Equivalence {
                reason: "",
                experiment: "",
            },
            near_twins: &[],
            nested,
            continuation: Continuation::Stays,
            separated_by: &[],
        }
    }

    static EFFECTS: [Effect; 3] = [
        effect("ramp", &[]),
        effect("start", &[]),
        effect("warm_up", &["ramp", "start"]),
    ];

    /// The effect that is named of a warm-up with a statistic of 60, a ramp and an initial state.
    fn named(ramp: f64, start: f64) -> Option<&'static str> {
        let hypotheses: Vec<Hypothesis> = EFFECTS
            .iter()
            .map(|effect| Hypothesis {
                effect,
                variants: Vec::new(),
                walk: None,
                is_jump: false,
            })
            .collect();
        let null = NullDistribution::without_search(hypotheses.len());
        let statistics = [ramp, start, 60.0].into_iter().enumerate();
        let best = statistics.map(|(hypothesis, statistic)| {
            Some(Best {
                hypothesis,
                variant: 0,
                statistic,
                shape: 0.0,
                refined: false,
                searched: 0.0,
            })
        });
        let scores = Scores {
            best: best.collect(),
            null: &null,
        };
        Some(hypotheses[scores.named(&hypotheses)?.hypothesis].id())
    }

    #[test]
    fn an_effect_gives_way_to_the_better_of_its_nested_ones() {
        assert_eq!(named(40.0, 40.0), Some("warm_up"));
        assert_eq!(named(58.0, 40.0), Some("ramp"));
        assert_eq!(named(40.0, 58.0), Some("start"));
        assert_eq!(named(57.0, 58.0), Some("start"));
        // By less than the 5 % point of chi-square, 3.84.
        assert_eq!(named(56.1, 40.0), Some("warm_up"));
        assert_eq!(named(56.2, 40.0), Some("ramp"));
    }
}
