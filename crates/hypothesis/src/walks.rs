//! Random walks of the rates against deterministic effects.
//!
//! Both are slow, and either can stand for the other. Neither is tested first: the model with the best
//! deterministic effects and the model with walks are both fitted, each with its own noise, and their
//! likelihoods are compared.

mod chosen;

use crate::accepted::value_places;
use crate::bank::NominalEstimate;
use crate::context::SearchContext;
use crate::finding::{Alternative, Finding};
use crate::fitted_stage::FittedStage;
use crate::forward::{Beside, FirstRound, forward};
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::rate_noise::RateNoise;
use crate::score::Ranked;
use crate::state::{SearchState, settled, stage};
use crate::walk_candidates::{
    BESIDE_WALKS, Candidates, Rival, WALK_SET_DEVIANCE, alternatives, needed, with_their_sets,
};
use chosen::Chosen;

/// Advantage of effects over a walk in the place of one of them, the shapes of the others held, above
/// which no full comparison is made: with shapes of their own walks gain some tens at most.
const CLEAR_ADVANTAGE: f64 = 3.0 * WALK_SET_DEVIANCE;

/// What a search says of walks.
#[derive(Clone, Default)]
pub(crate) struct Walks {
    /// Walks in the model, as findings.
    pub(crate) named: Vec<Finding>,
    /// Walks that stand in the sets of effects.
    pub(crate) rivals: Vec<Rival>,
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

/// Compares the best deterministic effects with walks, whose best model may be known.
pub(crate) fn compare<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    nominal: &FittedStage<F>,
    (state, walking_state): (SearchState<F>, Option<SearchState<F>>),
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
    let model = Chosen {
        context,
        candidates,
        threshold: first.threshold,
        ranking: &ranking,
    };
    let has_effects = !(state.accepted.is_empty() && state.unmodelled.is_empty());
    if !has_effects {
        if p_value >= probability {
            return Ok(only(state));
        }
        // Walks that no fit converges with are not what the record has.
        return match walking(context, candidates, nominal, draws) {
            Ok(walking) => model.with_walks(walking, (p_value, Vec::new()), draws),
            Err(_) => Ok(only(state)),
        };
    }
    let own = state.stage.noise.log_likelihood;
    let beside = state.stage.fitted.fit_rate_noise(&candidates.rates, &[])?;
    let p_beside = candidates.p_value(2.0 * (beside.log_likelihood - own));
    if walking_state.is_none() && context.budget.is_spent(state.stage.fitted.work()) {
        return model.uncompared(state, (p_beside, &beside.noise), draws);
    }
    let penalties = state.penalties(first.threshold, 0.0, 1);
    let alone = 2.0 * (own - candidates.fit.log_likelihood) - penalties;
    let weakest = least_advantage(context, candidates, &state)
        .filter(|(_, advantage)| *advantage <= CLEAR_ADVANTAGE)
        .map(|(index, _)| index);
    let is_clear = alone > WALK_SET_DEVIANCE && weakest.is_none();
    if is_clear && p_beside >= probability && walking_state.is_none() {
        return Ok(only(state));
    }
    let best = best_walking(&model, nominal, (&state, walking_state), weakest, draws);
    let Some((advantage, walking)) = best else {
        return Ok(only(state));
    };
    if advantage > BESIDE_WALKS && context.budget.is_spent(state.stage.fitted.work()) {
        return model.uncompared(state, (p_beside, &beside.noise), draws);
    }
    if advantage > WALK_SET_DEVIANCE {
        if p_beside >= probability {
            return Ok(only(state));
        }
        let Ok(state) = state.in_noise(context, &beside.noise) else {
            return Ok(only(state));
        };
        return model.with_walks(state, (p_beside, Vec::new()), draws);
    }
    if advantage > BESIDE_WALKS
        || !are_needed(candidates, &walking, (advantage, p_value), probability)?
    {
        let rival = rival(candidates, &state, &walking, advantage)?;
        let mut compared = only(state);
        compared.walks.rivals.push(rival);
        return Ok(compared);
    }
    let rivals = if advantage > -BESIDE_WALKS {
        let deficit = 0.5 * (BESIDE_WALKS - advantage);
        effects_in_place(context, &state, &walking, deficit, draws)
    } else {
        Vec::new()
    };
    model.with_walks(walking, (p_value, rivals), draws)
}

/// The walks of a model as members of the sets of the effects that they could stand for.
fn rival<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
    walking: &SearchState<F>,
    advantage: f64,
) -> Result<Rival, F::Error> {
    let walks = needed(candidates, walking)?.into_iter();
    let ids = walks.map(|walk| walk.effect.id);
    let deficit = 0.5 * (advantage - BESIDE_WALKS).max(0.0);
    Ok(Rival {
        alternatives: alternatives(ids, deficit, &walking.stage.fitted),
        of: lacking(state, walking),
    })
}

/// Whether the record needs the walks of a model: those that it does not need replace nothing. `advantage` is that of
/// effects, and `p_value` that of walks without effects.
fn are_needed<F: FittedModel>(
    candidates: &Candidates,
    walking: &SearchState<F>,
    (advantage, p_value): (f64, f64),
    probability: f64,
) -> Result<bool, F::Error> {
    // Walks that are clearly better than the effects gain as much at least.
    if advantage < -CLEAR_ADVANTAGE {
        return Ok(true);
    }
    if walking.accepted.is_empty() {
        return Ok(p_value < probability);
    }
    let without = walking.stage.fitted.fit_rate_noise(&[], &[])?;
    let gained = 2.0 * (walking.stage.noise.log_likelihood - without.log_likelihood);
    Ok(candidates.p_value(gained) < probability)
}

/// The model with walks that effects are least better than, and by how much: twice the log-likelihood,
/// penalties subtracted. Walks that stand for several effects hide them, so that one may also stand in
/// the place of the `weakest` effect alone.
fn best_walking<F: FittedModel>(
    model: &Chosen<'_, '_>,
    nominal: &FittedStage<F>,
    (state, known): (&SearchState<F>, Option<SearchState<F>>),
    weakest: Option<usize>,
    draws: &mut GaussianDraws,
) -> Option<(f64, SearchState<F>)> {
    let (context, candidates) = (model.context, model.candidates);
    let found = match known {
        Some(known) => Ok(known),
        None => walking(context, candidates, nominal, draws),
    };
    let in_place = weakest.map(|index| in_place_of_effect(context, candidates, state, index));
    let both = [Some(found), in_place].into_iter().flatten().flatten();
    let advantage = |walking: &SearchState<F>| {
        2.0 * (state.stage.noise.log_likelihood - walking.stage.noise.log_likelihood)
            - state.penalties_beside(walking, model.threshold, 0.0, 1)
            + walking.penalties_beside(state, model.threshold, BESIDE_WALKS, 0)
    };
    let both = both.map(|walking| (advantage(&walking), walking));
    both.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The effect that walks could best stand in the place of, the others beside them, and twice the
/// log-likelihood that is lost by it, with the shapes of the others held: a slow effect may stand for a
/// walk however much the others explain. `None` for a single effect, which walks alone stand against.
fn least_advantage<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    state: &SearchState<F>,
) -> Option<(usize, f64)> {
    if state.accepted.len() < 2 || context.budget.is_spent(state.stage.fitted.work()) {
        return None;
    }
    let all = (0..state.accepted.len()).filter_map(|index| {
        let (lost, _) = walks_in_place(context, candidates, state, index)?;
        Some((index, lost))
    });
    all.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Twice the log-likelihood that is lost with walks in the place of an effect, the shapes of the others held,
/// and the noise with these walks; `None` if they cannot be fitted.
fn walks_in_place<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    state: &SearchState<F>,
    index: usize,
) -> Option<(f64, RateNoise)> {
    let hypothesis = &context.set.hypotheses[state.accepted[index].hypothesis];
    let fitted = &state.stage.fitted;
    let absent = value_places(fitted, hypothesis);
    let walking = fitted.fit_rate_noise(&candidates.rates, &absent).ok()?;
    let lost = 2.0 * (state.stage.noise.log_likelihood - walking.log_likelihood);
    Some((lost, walking.noise))
}

/// The walks that may stand in the place of effects that no model with walks was searched against: for each
/// effect those of its own rate, unless the others with their shapes leave far less to walks.
fn uncompared_rivals<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    state: &SearchState<F>,
) -> Vec<Rival> {
    let of_effect = |index: usize| {
        let (lost, noise) = walks_in_place(context, candidates, state, index)?;
        if lost > CLEAR_ADVANTAGE {
            return None;
        }
        let mut others = state.accepted.clone();
        let own = others.remove(index).hypothesis;
        let nominal = match context.budget.is_exhausted(state.stage.fitted.work()) {
            true => None,
            false => {
                let without = context.fitted(&state.stage.fitted, &others, &state.unmodelled);
                let walking = without.and_then(|fitted| fitted.with_rate_noise(&noise));
                Some(NominalEstimate::of(&walking.ok()?))
            }
        };
        let rate = context.set.hypotheses[own].effect.rate();
        let walks = candidates.effects.iter().filter(|walk| match rate {
            Some(rate) => walk.rate() == Some(rate),
            None => true,
        });
        let deficit = 0.5 * (lost - BESIDE_WALKS).max(0.0);
        let walks = walks.map(|walk| Alternative {
            effect: walk.id,
            log_likelihood_deficit: deficit,
            nominal: nominal.clone(),
        });
        Some(Rival {
            alternatives: walks.collect(),
            of: vec![own],
        })
    };
    (0..state.accepted.len()).filter_map(of_effect).collect()
}

/// The model with walks in the place of an effect.
fn in_place_of_effect<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    state: &SearchState<F>,
    index: usize,
) -> Result<SearchState<F>, F::Error> {
    let mut accepted = state.accepted.clone();
    accepted.remove(index);
    let fitted = context.fitted(&state.stage.fitted, &accepted, &state.unmodelled)?;
    let noise = fitted.fit_rate_noise(&candidates.rates, &[])?.noise;
    let fitted = fitted.with_rate_noise(&noise)?;
    let stage = stage(context, &fitted, &mut accepted, &state.unmodelled)?;
    Ok(SearchState {
        stage,
        accepted,
        ..state.clone()
    })
}

/// Effects without walks that stand in the sets of walks: those that do not stand beside them.
fn effects_in_place<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    walking: &SearchState<F>,
    deficit: f64,
    draws: &mut GaussianDraws,
) -> Vec<Alternative> {
    let lacking = lacking(state, walking);
    let own = state.accepted.iter().enumerate();
    let own = own.filter(|(_, own)| lacking.contains(&own.hypothesis));
    let of: Vec<usize> = own.map(|(index, _)| index).collect();
    let beside: Vec<&str> = walking
        .accepted
        .iter()
        .map(|own| context.set.hypotheses[own.hypothesis].id())
        .collect();
    let mut members = with_their_sets(context, state, &of, deficit, draws);
    members.retain(|member| !beside.contains(&member.effect));
    members
}

/// Effects of a model that another one lacks.
fn lacking<F>(of: &SearchState<F>, other: &SearchState<F>) -> Vec<usize> {
    let own = of.accepted.iter().map(|own| own.hypothesis);
    own.filter(|own| {
        let mut others = other.accepted.iter();
        !others.any(|other| other.hypothesis == *own)
    })
    .collect()
}

/// The nominal model with walks, and the effects that stand beside them.
pub(crate) fn walking<F: FittedModel>(
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
    Ok(forward(context, state, beside, draws)?.state)
}
