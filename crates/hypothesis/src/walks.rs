//! Random walks of the rates against deterministic effects.
//!
//! Both are slow, and either can stand for the other. Neither is tested first: the model with the best
//! deterministic effects and the model with walks are both fitted, each with its own noise, and their
//! likelihoods are compared.

use gyrocal_scalar::effect::Effect;
use gyrocal_statistics::chi_square_tail;

use crate::accepted::value_places;
use crate::bank::NominalEstimate;
use crate::context::SearchContext;
use crate::forward::{Beside, FirstRound, forward};
use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::rate_noise::RateNoiseFit;
use crate::result::{Alternative, EffectEstimate, Finding, FittedStage};
use crate::score::Ranked;
use crate::state::{SearchState, settled};

/// Twice the log-likelihood that deterministic effects must be better by, penalties subtracted, to stand
/// without walks in their set.
pub const WALK_SET_DEVIANCE: f64 = 12.0;

/// The same for an effect that is added beside walks, which absorb most of what is not named; and the
/// advantage of walks in the order of a set.
pub const BESIDE_WALKS: f64 = 6.0;

/// Twice the log-likelihood that a walk of one rate gains, the others being there, from which on it is
/// named: the 5 % point of a variance that may be zero, ½ χ²(1).
const NAMED_WALK: f64 = 2.71;

/// What a search says of walks.
#[derive(Clone, Default)]
pub(crate) struct Walks {
    /// Walks in the model, as findings.
    pub(crate) named: Vec<Finding>,
    /// Walks that stand in the set of every effect of the model but for `beside`.
    pub(crate) rivals: Vec<Alternative>,
    /// Hypotheses that stand beside walks too.
    pub(crate) beside: Vec<usize>,
}

/// Result of the comparison.
pub(crate) struct Compared<F> {
    pub(crate) state: SearchState<F>,
    pub(crate) walks: Walks,
    /// The walks in the first round.
    pub(crate) ranking: Vec<Ranked>,
}

impl<F> Compared<F> {
    /// Of a search without walks.
    pub(crate) fn without_walks(state: SearchState<F>) -> Self {
        Self {
            state,
            walks: Walks::default(),
            ranking: Vec::new(),
        }
    }
}

/// The walks that a search may name, with the nominal model that has all of them.
pub(crate) struct Candidates {
    effects: Vec<&'static Effect>,
    rates: Vec<usize>,
    /// Noise of the nominal model with all walks.
    fit: RateNoiseFit,
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

    /// The effect of the largest walk.
    pub(crate) fn largest(&self) -> Option<&'static str> {
        let sizes = self.rates.iter().map(|rate| self.fit.noise.walk[*rate]);
        let all = self.effects.iter().zip(sizes);
        all.max_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(effect, _)| effect.id)
    }

    /// Log-likelihood of the nominal model with all walks.
    pub(crate) fn log_likelihood(&self) -> f64 {
        self.fit.log_likelihood
    }

    /// Probability that walks gain as much where there are none.
    fn p_value(&self, gained: f64) -> f64 {
        tail(gained, self.rates.len())
    }

    /// All walks have the statistic of the test, which is one for them together.
    fn ranking(&self, gained: f64) -> Vec<Ranked> {
        let effects = self.effects.iter();
        effects
            .map(|effect| Ranked {
                effect: effect.id,
                statistic: gained.max(0.0),
            })
            .collect()
    }
}

/// Compares the best deterministic effects with walks.
pub(crate) fn compare<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    nominal: &FittedStage<F>,
    state: SearchState<F>,
    first: &FirstRound,
    draws: &mut GaussianDraws,
) -> Result<Compared<F>, F::Error> {
    let probability = context.options.walk_probability;
    let (gained, p_value) = candidates.test(nominal);
    let ranking = candidates.ranking(gained);
    let only = |state| Compared {
        ranking: ranking.clone(),
        ..Compared::without_walks(state)
    };
    let has_effects = !(state.accepted.is_empty() && state.unmodelled.is_empty());
    if !has_effects {
        if p_value >= probability {
            return Ok(only(state));
        }
        // Walks that no fit converges with are not what the record has.
        return match walking(context, candidates, nominal, draws) {
            Ok(walking) => with_walks(candidates, walking, (p_value, Vec::new()), ranking),
            Err(_) => Ok(only(state)),
        };
    }
    let own = state.stage.noise.log_likelihood;
    let beside = state.stage.fitted.fit_rate_noise(&candidates.rates, &[])?;
    let p_beside = candidates.p_value(2.0 * (beside.log_likelihood - own));
    let penalties = state.penalties(first.threshold, 0.0, 1);
    let alone = 2.0 * (own - candidates.fit.log_likelihood) - penalties;
    let stand_out = alone > WALK_SET_DEVIANCE
        && p_beside >= probability
        && least_advantage(candidates, &state, first.threshold, &context.set.hypotheses)?
            > WALK_SET_DEVIANCE;
    if stand_out {
        return Ok(only(state));
    }
    let Ok(walking) = walking(context, candidates, nominal, draws) else {
        return Ok(only(state));
    };
    let advantage = 2.0 * (own - walking.stage.noise.log_likelihood) - penalties
        + walking.penalties(first.threshold, BESIDE_WALKS, 0);
    if advantage > WALK_SET_DEVIANCE {
        if p_beside >= probability {
            return Ok(only(state));
        }
        let with_them = state.stage.fitted.with_rate_noise(&beside.noise);
        let staged = with_them.and_then(|fitted| settled(context, fitted, &state.accepted));
        let Ok(stage) = staged else {
            return Ok(only(state));
        };
        let state = SearchState { stage, ..state };
        return with_walks(candidates, state, (p_beside, Vec::new()), ranking);
    }
    if advantage > BESIDE_WALKS {
        let deficit = 0.5 * (advantage - BESIDE_WALKS);
        return Ok(Compared {
            walks: Walks {
                named: Vec::new(),
                rivals: alternatives(
                    needed(candidates, &walking)?
                        .into_iter()
                        .map(|(effect, ..)| effect.id),
                    deficit,
                    &walking.stage.fitted,
                ),
                beside: walking.accepted.iter().map(|own| own.hypothesis).collect(),
            },
            state,
            ranking,
        });
    }
    let rivals = if advantage > 0.0 {
        effects_in_place(context, &state, &walking, 0.5 * (BESIDE_WALKS - advantage))
    } else {
        Vec::new()
    };
    with_walks(candidates, walking, (p_value, rivals), ranking)
}

/// Smallest advantage of the effects over walks in the place of one of them, the others beside the walks:
/// a slow effect may stand for a walk however much the others explain. Infinite for a single effect, which
/// walks alone stand against.
fn least_advantage<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
    threshold: f64,
    hypotheses: &[Hypothesis],
) -> Result<f64, F::Error> {
    let mut least = f64::INFINITY;
    if state.accepted.len() < 2 {
        return Ok(least);
    }
    let fitted = &state.stage.fitted;
    let own = 2.0 * state.stage.noise.log_likelihood - state.penalties(threshold, 0.0, 1);
    let all = state.penalties(threshold, BESIDE_WALKS, 0);
    for accepted in &state.accepted {
        let absent = value_places(fitted, &hypotheses[accepted.hypothesis]);
        let walking = fitted.fit_rate_noise(&candidates.rates, &absent)?;
        let others = all - (threshold + accepted.penalty + BESIDE_WALKS);
        least = least.min(own - (2.0 * walking.log_likelihood - others));
    }
    Ok(least)
}

/// Effects without walks that stand in the sets of walks: those that do not stand beside them.
fn effects_in_place<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    walking: &SearchState<F>,
    deficit: f64,
) -> Vec<Alternative> {
    let own = state.accepted.iter().map(|own| own.hypothesis);
    let lacking = own.filter(|own| {
        let mut others = walking.accepted.iter();
        !others.any(|other| other.hypothesis == *own)
    });
    let ids = lacking.map(|own| context.set.hypotheses[own].id());
    alternatives(ids, deficit, &state.stage.fitted)
}

/// The nominal model with walks, and the effects that stand beside them.
fn walking<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    nominal: &FittedStage<F>,
    draws: &mut GaussianDraws,
) -> Result<SearchState<F>, F::Error> {
    let fitted = nominal.fitted.with_rate_noise(&candidates.fit.noise)?;
    let state = SearchState::new(settled(context, fitted, &[])?);
    let beside = Beside::Walks {
        margin: BESIDE_WALKS,
    };
    Ok(forward(context, state, beside, draws)?.0)
}

/// The result that a model with walks is chosen, with the rivals of all of them.
fn with_walks<F: FittedModel>(
    candidates: &Candidates,
    state: SearchState<F>,
    (p_value, rivals): (f64, Vec<Alternative>),
    ranking: Vec<Ranked>,
) -> Result<Compared<F>, F::Error> {
    let mut named = named(candidates, &state, p_value)?;
    for finding in &mut named {
        finding.alternatives.clone_from(&rivals);
    }
    Ok(Compared {
        state,
        walks: Walks {
            named,
            ..Walks::default()
        },
        ranking,
    })
}

/// Members of a set that are one model together.
fn alternatives<F: FittedModel>(
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

/// The walks that a model needs, with their rates and what each gains beside the others: each that the
/// likelihood needs, the largest at least.
fn needed<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
) -> Result<Vec<(&'static Effect, usize, f64)>, F::Error> {
    let noise = &state.stage.noise;
    let mut all = Vec::with_capacity(candidates.rates.len());
    for (effect, rate) in candidates.effects.iter().zip(&candidates.rates) {
        let others: Vec<usize> = candidates
            .rates
            .iter()
            .copied()
            .filter(|other| other != rate)
            .collect();
        let without = state.stage.fitted.fit_rate_noise(&others, &[])?;
        let gain = 2.0 * (noise.log_likelihood - without.log_likelihood);
        all.push((*effect, *rate, gain));
    }
    let gains = all.iter().map(|(.., gain)| *gain);
    let least = NAMED_WALK.min(gains.fold(f64::NEG_INFINITY, f64::max));
    all.retain(|(.., gain)| *gain >= least);
    Ok(all)
}

/// The walks of a model that are named.
fn named<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
    p_value: f64,
) -> Result<Vec<Finding>, F::Error> {
    let sizes = &state.stage.noise.noise.walk;
    let needed = needed(candidates, state)?;
    let intervals = state.stage.fitted.walk_intervals()?;
    let finding = |(effect, rate, gain): &(&'static Effect, usize, f64)| {
        let interval = intervals.get(*rate).copied().flatten();
        walk_finding(effect, sizes[*rate], interval, (*gain, p_value))
    };
    Ok(needed.iter().map(finding).collect())
}

fn walk_finding(
    effect: &'static Effect,
    size: f64,
    interval: Option<[f64; 2]>,
    (gain, p_value): (f64, f64),
) -> Finding {
    let parameters = effect.parameters.first().map(|parameter| EffectEstimate {
        name: parameter.name,
        estimate: size,
        sigma: None,
        interval: interval.map(|ends| vec![ends]),
        unit: parameter.unit,
    });
    Finding {
        effect: effect.id,
        parameters: parameters.into_iter().collect(),
        z: gain.max(0.0).sqrt(),
        p_value,
        alternatives: Vec::new(),
        exact_equivalents: Vec::new(),
        none_of_these: None,
    }
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
