//! The statistics of all hypotheses, and the choice of the one that is named.

use gyrocal_statistics::math::{exp, ln_1p};

use crate::bank::ScoreBank;
use crate::context::SearchContext;
use crate::hypothesis::Hypothesis;
use crate::jump::BestJump;
use crate::model::FittedModel;
use crate::null_distribution::NullDistribution;
use crate::shape::{About, best_shape};

/// The 5 % point of chi-square with one degree of freedom: an effect replaces a nested one only if
/// its statistic is larger by this.
pub const NESTED_MODEL_CHI2: f64 = 3.84;

/// Share of the largest statistic above which a hypothesis is refined: midway between two variants of
/// a grid an effect has at least this share of its statistic.
pub(crate) const NEAR_LARGEST: f64 = 0.8;

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
    /// Onset of a jump, s; shape between those of the variants, if it was refined.
    pub(crate) shape: f64,
    /// Whether `shape` replaces that of the variant.
    pub(crate) refined: bool,
    /// Penalty of a jump for the test of every step.
    pub(crate) searched: f64,
}

impl Best {
    /// Onset or time constant of the variant, onset of a jump; `None` of a hypothesis without any of
    /// them.
    pub(crate) fn shape(&self, hypotheses: &[Hypothesis]) -> Option<f64> {
        let own = &hypotheses[self.hypothesis];
        if own.is_jump || self.refined {
            return Some(self.shape);
        }
        own.variants.get(self.variant)?.shape
    }
}

/// The best variant of every hypothesis, with the search penalties.
pub(crate) struct Scores<'a> {
    pub(crate) best: Vec<Option<Best>>,
    null: &'a NullDistribution,
    /// Effective degrees of freedom of the noise that each was tested with; infinite if it is known.
    degrees: Vec<f64>,
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
            degrees: vec![f64::INFINITY; hypotheses.len()],
        }
    }

    /// Takes the statistics as tested with noise that the model estimated from the same record, with
    /// these effective degrees of freedom for each rate.
    pub(crate) fn with_estimated_noise(
        mut self,
        hypotheses: &[Hypothesis],
        rate_degrees: &[f64],
    ) -> Self {
        for (degrees, hypothesis) in self.degrees.iter_mut().zip(hypotheses) {
            let rate = hypothesis.effect.rate();
            let own = rate.and_then(|rate| rate_degrees.get(rate).copied());
            *degrees = own
                .filter(|own| *own >= LEAST_DEGREES)
                .unwrap_or(f64::INFINITY);
        }
        self
    }

    /// Likelihood-ratio statistic of a hypothesis, its noise estimated with and without it.
    fn likelihood_ratio(&self, hypothesis: usize) -> f64 {
        self.best[hypothesis].map_or(f64::NEG_INFINITY, |best| {
            likelihood_ratio(best.statistic, self.degrees[hypothesis])
        })
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
            if let Some(found) =
                best_shape(fitted, context, hypothesis, (shape, About::Variant), absent)?
                && found.best.statistic > best.statistic
            {
                *best = Best {
                    statistic: found.best.statistic,
                    shape: found.best.shape,
                    refined: true,
                    ..*best
                };
            }
        }
        Ok(())
    }

    /// The statistic for ranking: less the whole search penalty.
    pub(crate) fn penalised(&self, hypothesis: usize) -> f64 {
        self.likelihood_ratio(hypothesis) - self.null.penalties[hypothesis]
    }

    /// The whole search penalty of a hypothesis.
    pub(crate) fn penalty(&self, hypothesis: usize) -> f64 {
        self.null.penalties[hypothesis]
    }

    /// Logarithm of the sum of the likelihoods of a hypothesis and of all that could be in its place over
    /// its own, search penalties subtracted; `own` is twice the logarithm of its own.
    pub(crate) fn ln_likelihood_of_all(&self, hypothesis: usize, own: f64) -> f64 {
        let others = (0..self.best.len())
            .filter(|other| *other != hypothesis && self.best[*other].is_some());
        let each = others.map(|other| exp(0.5 * (self.penalised(other) - own).min(0.0)));
        ln_1p(each.sum())
    }

    /// The statistic for detection: less the detection penalty.
    pub(crate) fn tested(&self, hypothesis: usize) -> f64 {
        self.likelihood_ratio(hypothesis) - self.null.detection_penalties[hypothesis]
    }

    /// The maximum statistic.
    pub(crate) fn largest(&self) -> f64 {
        (0..self.best.len())
            .map(|hypothesis| self.tested(hypothesis))
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The hypothesis to name: the best, or an effect nested in it if it is not significantly better;
    /// of exact equivalents the first in the table.
    pub(crate) fn named(&self, hypotheses: &[Hypothesis]) -> Option<Best> {
        let best = (0..hypotheses.len())
            .filter(|index| self.best[*index].is_some())
            .max_by(|a, b| self.penalised(*a).total_cmp(&self.penalised(*b)))?;
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
            Some(simpler)
                if self.likelihood_ratio(best) - self.likelihood_ratio(simpler.hypothesis)
                    < NESTED_MODEL_CHI2 =>
            {
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

/// Degrees of freedom below which the noise of a rate is so uncertain because another noise hides it:
/// the statistic then does not rest on it.
const LEAST_DEGREES: f64 = 20.0;

/// Share of the degrees of freedom beyond which the likelihood ratio goes on linearly: the noise is then
/// next to nothing but the effect.
const LARGEST_SHARE: f64 = 0.9;

/// The value of χ²(1) that is as rare as the score statistic T of an effect, if the variance of its
/// noise was estimated with ν degrees of freedom in the model without the effect. An effect raises
/// that estimate, so that T stays below ν; T (ν − 1)/(ν − T) is the square of Student's t with
/// ν' = ν − 1, whose normal deviate is (8ν' + 1)/(8ν' + 3) √(ν' ln(1 + t²/ν')) (Wallace, Ann. Math.
/// Statist. 30, 1124, 1959).
fn likelihood_ratio(statistic: f64, degrees: f64) -> f64 {
    let share = statistic / degrees;
    if !degrees.is_finite() || share <= 0.0 {
        return statistic;
    }
    let own = (degrees - 1.0).max(1.0);
    let factor = own * ((8.0 * own + 1.0) / (8.0 * own + 3.0)).powi(2);
    let at = share.min(LARGEST_SHARE);
    factor * ((share - at) / (1.0 - LARGEST_SHARE) - ln_1p(-at))
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
                is_jump: false,
                can_be_named: true,
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
            degrees: vec![f64::INFINITY; hypotheses.len()],
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
