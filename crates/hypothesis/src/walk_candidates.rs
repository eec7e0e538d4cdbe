//! Random walks that a search may name, and what a model needs of them.

use gyrocal_scalar::effect::Effect;
use gyrocal_statistics::chi_square_tail;

use crate::bank::NominalEstimate;
use crate::by_fits::Compared;
use crate::context::SearchContext;
use crate::finding::Alternative;
use crate::fitted_stage::FittedStage;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::rate_noise::RateNoiseFit;
use crate::result::set_by_scores;
use crate::score::Ranked;
use crate::state::SearchState;

/// Twice the log-likelihood that deterministic effects must be better by, penalties subtracted, to stand
/// without walks in their set.
pub const WALK_SET_DEVIANCE: f64 = 12.0;

/// The same for an effect that is added beside walks, which absorb most of what is not named; and the
/// advantage of walks in the order of a set.
pub const BESIDE_WALKS: f64 = 6.0;

/// Twice the log-likelihood that a walk of one rate gains, the others being there, from which on it is
/// named: the 5 % point of a variance that may be zero, ½ χ²(1).
const NAMED_WALK: f64 = 2.71;

/// Walks that stand in the sets of effects.
#[derive(Clone)]
pub(crate) struct Rival {
    pub(crate) alternatives: Vec<Alternative>,
    /// Hypotheses of the effects.
    pub(crate) of: Vec<usize>,
}

/// A walk that a model needs.
#[derive(Clone, Copy)]
pub(crate) struct Needed {
    pub(crate) effect: &'static Effect,
    pub(crate) rate: usize,
    /// Twice the log-likelihood that it gains beside the other walks.
    pub(crate) gain: f64,
}

/// The walks that a search may name, with the nominal model that has all of them.
pub(crate) struct Candidates {
    pub(crate) effects: Vec<&'static Effect>,
    pub(crate) rates: Vec<usize>,
    /// Noise of the nominal model with all walks.
    pub(crate) fit: RateNoiseFit,
}

impl Candidates {
    /// `None` if the search has no walk.
    pub(crate) fn new<F: FittedModel>(
        context: &SearchContext<'_>,
        nominal: &FittedStage<F>,
    ) -> Result<Option<Self>, F::Error> {
        let walks = context.walks.iter();
        let pairs = walks.filter_map(|effect| Some((*effect, effect.rate()?)));
        let (effects, rates): (Vec<&'static Effect>, Vec<usize>) = pairs.unzip();
        if rates.is_empty() {
            return Ok(None);
        }
        let fit = nominal.fitted.fit_rate_noise(&rates, &[])?;
        Ok(Some(Self {
            effects,
            rates,
            fit,
        }))
    }

    /// Twice the log-likelihood that the walks gain over the nominal model without them, and its
    /// p-value.
    pub(crate) fn test<F>(&self, nominal: &FittedStage<F>) -> (f64, f64) {
        let gained = 2.0 * (self.fit.log_likelihood - nominal.noise.log_likelihood);
        (gained, self.p_value(gained))
    }

    /// Log-likelihood of the nominal model with all walks.
    pub(crate) fn log_likelihood(&self) -> f64 {
        self.fit.log_likelihood
    }

    /// Probability that walks gain as much where there are none.
    pub(crate) fn p_value(&self, gained: f64) -> f64 {
        tail(gained, self.rates.len())
    }

    /// All walks have the statistic of the test, which is one for them together.
    pub(crate) fn ranking(&self, gained: f64) -> Vec<Ranked> {
        let effects = self.effects.iter();
        effects
            .map(|effect| Ranked {
                effect: effect.id,
                statistic: gained.max(0.0),
            })
            .collect()
    }
}

/// Members of a set that are one model together.
pub(crate) fn alternatives<F: FittedModel>(
    ids: impl Iterator<Item = &'static str>,
    deficit: f64,
    fitted: &F,
) -> Vec<Alternative> {
    let nominal = NominalEstimate::of(fitted);
    ids.map(|effect| Alternative {
        effect,
        log_likelihood_deficit: deficit,
        nominal: Some(nominal.clone()),
    })
    .collect()
}

/// Effects of a model as members of the set of a walk, with all that could be in the place of each: `of` are
/// their places among those of the model, `deficit` is what the walk is better by.
pub(crate) fn with_their_sets<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    of: &[usize],
    deficit: f64,
    draws: &mut GaussianDraws,
) -> Vec<Alternative> {
    let hypotheses = &context.set.hypotheses;
    let named = of
        .iter()
        .map(|index| hypotheses[state.accepted[*index].hypothesis].id());
    let mut members = alternatives(named, deficit, &state.stage.fitted);
    for index in of {
        let compared = Compared {
            stage: &state.stage,
            accepted: &state.accepted,
            unmodelled: &state.unmodelled,
            index: *index,
        };
        // Without its set an effect stands alone.
        let Ok(others) = set_by_scores(&compared, context, draws) else {
            continue;
        };
        for mut other in others {
            if members.iter().all(|member| member.effect != other.effect) {
                other.log_likelihood_deficit += deficit;
                members.push(other);
            }
        }
    }
    members
}

/// Probability that walks of so many rates gain as much where there are none: each variance is zero
/// with a probability of one half (Self, Liang, J. Amer. Statist. Assoc. 82, 605, 1987).
fn tail(gained: f64, rates: usize) -> f64 {
    if gained <= 0.0 {
        return 1.0;
    }
    let mut weight = 0.5_f64.powi(rates as i32);
    let mut sum = 0.0;
    for degrees in 1..=rates {
        weight *= (rates + 1 - degrees) as f64 / degrees as f64;
        sum += weight * chi_square_tail(gained, degrees as f64).unwrap_or(0.0);
    }
    sum
}

/// The walks that a model needs: each that the likelihood needs beside the others, the largest at least.
pub(crate) fn needed<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
) -> Result<Vec<Needed>, F::Error> {
    let noise = &state.stage.noise;
    let walking = noise.noise.walking();
    let mut all = Vec::with_capacity(walking.len());
    for (effect, rate) in candidates.effects.iter().zip(&candidates.rates) {
        if !walking.contains(rate) {
            continue;
        }
        let others: Vec<usize> = walking
            .iter()
            .copied()
            .filter(|other| other != rate)
            .collect();
        let without = state.stage.fitted.fit_rate_noise(&others, &[])?;
        all.push(Needed {
            effect,
            rate: *rate,
            gain: 2.0 * (noise.log_likelihood - without.log_likelihood),
        });
    }
    let largest = all
        .iter()
        .map(|walk| walk.gain)
        .fold(f64::NEG_INFINITY, f64::max);
    all.retain(|walk| walk.gain >= NAMED_WALK.min(largest));
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::tail;

    #[test]
    fn the_tail_of_walks_is_that_of_the_mixture() {
        // χ²(1) at 2.706 is 0.1, halved; three walks at 8.7: 3/8 of 0.003 18, 3/8 of 0.012 9, 1/8 of
        // 0.033 6, by tables of χ².
        assert!((tail(2.705_543, 1) - 0.05).abs() < 1e-6);
        assert!((tail(8.7, 3) - 0.010_23).abs() < 2e-4, "{}", tail(8.7, 3));
        assert!((tail(0.0, 3) - 1.0).abs() < 1e-15);
    }
}
