//! Each random walk of a model against effects in its place, the walks of the other rates staying.
//!
//! Walks of all rates together take up an effect of a rate that does not walk; effects without walks
//! do not explain the others. Only with the walks of the others in the model is the question fair.

use crate::accepted::{Accepted, value_places};
use crate::bank::NominalEstimate;
use crate::context::{MOST_EFFECTS, SearchContext};
use crate::finding::Alternative;
use crate::fitted_stage::FittedStage;
use crate::forward::{Beside, Walking, forward};
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::state::{SearchState, settled};
use crate::walk_candidates::{
    BESIDE_WALKS, Candidates, Needed, Rival, WALK_SET_DEVIANCE, needed, with_their_sets,
};

/// Most effects in the place of one walk: a slow one, and one whose onset it hides.
const MOST_IN_PLACE: usize = 2;

/// The model that is left, the walks that it needs, the walks that stand in sets of effects, and the
/// effects that stand in sets of walks, by rates.
pub(crate) struct ByRate<F> {
    pub(crate) state: SearchState<F>,
    pub(crate) walks: Vec<Needed>,
    pub(crate) rivals: Vec<Rival>,
    pub(crate) in_place_of: Vec<(usize, Vec<Alternative>)>,
}

/// A model with effects in the place of one walk.
struct InPlace<F> {
    walk: Needed,
    state: SearchState<F>,
    /// Twice the log-likelihood that it is better by, penalties subtracted.
    advantage: f64,
}

/// A walk that effects were tried in the place of, and by how much they were better.
struct Tried {
    walk: Needed,
    advantage: f64,
}

impl Tried {
    /// Whether effects could be better beside another model, where the walk gains less.
    fn is_open(&self, walk: &Needed) -> bool {
        self.advantage + (self.walk.gain - walk.gain).max(0.0) > 0.0
    }
}

/// Replaces walks by effects as long as effects are better.
pub(crate) fn replaced<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: &Candidates,
    mut state: SearchState<F>,
    threshold: f64,
    draws: &mut GaussianDraws,
) -> Result<ByRate<F>, F::Error> {
    let mut rivals: Vec<Rival> = Vec::new();
    let mut tried: Vec<Tried> = Vec::new();
    loop {
        let mut others = Vec::new();
        let walks = needed(candidates, &state)?;
        // What an effect stands for is seldom the largest walk.
        let mut by_gain = walks.clone();
        by_gain.sort_by(|a, b| a.gain.total_cmp(&b.gain));
        for walk in by_gain {
            let mut same = tried.iter().filter(|one| one.walk.rate == walk.rate);
            if same.any(|one| !one.is_open(&walk)) {
                continue;
            }
            if context.budget.is_spent(state.stage.fitted.work()) {
                break;
            }
            // What cannot be fitted does not stand in the place of a walk.
            let other = in_place(context, &state, walk, threshold, draws);
            let other = other.ok().flatten();
            let advantage = other
                .as_ref()
                .map_or(f64::NEG_INFINITY, |one| one.advantage);
            tried.push(Tried { walk, advantage });
            others.extend(other);
        }
        others.sort_by(|a, b| b.advantage.total_cmp(&a.advantage));
        if others
            .first()
            .is_none_or(|best| best.advantage <= BESIDE_WALKS)
        {
            let in_place_of = others
                .iter()
                .filter(|other| other.advantage > -BESIDE_WALKS);
            let in_place_of = in_place_of.map(|other| {
                let deficit = 0.5 * (BESIDE_WALKS - other.advantage);
                let added: Vec<usize> =
                    (state.accepted.len()..other.state.accepted.len()).collect();
                let own = context.of_rate(other.walk.rate);
                let effects = with_their_sets(&own, &other.state, &added, deficit, draws);
                (other.walk.rate, effects)
            });
            return Ok(ByRate {
                in_place_of: in_place_of.collect(),
                state,
                walks,
                rivals,
            });
        }
        let best = others.swap_remove(0);
        if best.advantage <= WALK_SET_DEVIANCE {
            let added = best.state.accepted[state.accepted.len()..].iter();
            rivals.push(Rival {
                alternatives: vec![Alternative {
                    effect: best.walk.effect.id,
                    log_likelihood_deficit: 0.5 * (best.advantage - BESIDE_WALKS),
                    nominal: Some(NominalEstimate::of(&state.stage.fitted)),
                }],
                of: added.map(|own| own.hypothesis).collect(),
            });
        }
        // The signatures of all effects again.
        let fitted = best.state.stage.fitted.clone();
        let noise = best.state.stage.noise.clone();
        let accepted = &best.state.accepted;
        state = SearchState {
            stage: FittedStage::new(fitted, noise, &context.set, &context.rows, accepted)?,
            ..best.state
        };
    }
}

/// The best effects in the place of a walk; `None` if there are none.
fn in_place<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    walk: Needed,
    threshold: f64,
    draws: &mut GaussianDraws,
) -> Result<Option<InPlace<F>>, F::Error> {
    let context = &context.of_rate(walk.rate);
    let own = state.stage.noise.log_likelihood;
    let mut noise = state.stage.noise.noise.clone();
    noise.walk[walk.rate] = 0.0;
    // Where no fit converges without the walk, nothing stands in its place.
    let fitted = state.stage.fitted.with_rate_noise(&noise);
    let Ok(stage) = fitted.and_then(|fitted| settled(context, fitted, &state.accepted)) else {
        return Ok(None);
    };
    let without = SearchState {
        stage,
        seeks_unmodelled: false,
        ..state.clone()
    };
    // Effects of both models are penalised alike; the first in the place of the walk costs its choice.
    let before = state.penalties(threshold, 0.0, 1);
    let first = if state.accepted.is_empty() {
        0.0
    } else {
        threshold
    };
    let beside = Beside::WhiteNoise {
        walks: Some(Walking::Best(own - 0.5 * (before + first))),
        most: MOST_EFFECTS.min(state.accepted.len() + MOST_IN_PLACE),
    };
    let mut with = forward(context, without, beside, draws)?.state;
    with.seeks_unmodelled = state.seeks_unmodelled;
    let added = &with.accepted[state.accepted.len()..];
    if added.is_empty() {
        return Ok(None);
    }
    let walking = state.stage.noise.noise.walking();
    let further = added.iter().skip(1);
    let penalties: f64 = further.map(|own| threshold + own.penalty).sum();
    let choice = choice_of_first(context, &with, &added[0], walking.len())?;
    let advantage = 2.0 * (with.stage.noise.log_likelihood - own) - penalties - choice;
    Ok(Some(InPlace {
        walk,
        state: with,
        advantage,
    }))
}

/// Twice the logarithm of the number of effects among which the first one in the place of a walk was
/// chosen, all of which could have stood for a path of that walk: shapes by the search penalty, walks by
/// their number, and sizes. Of sizes up to its own it resolves as many as it has standard deviations
/// (the Occam factor of a normal prior of that width; Kass and Raftery, J. Amer. Statist. Assoc. 90,
/// 773, 1995).
fn choice_of_first<F: FittedModel>(
    context: &SearchContext<'_>,
    with: &SearchState<F>,
    first: &Accepted,
    walks: usize,
) -> Result<f64, F::Error> {
    let fitted = &with.stage.fitted;
    let absent = value_places(fitted, &context.set.hypotheses[first.hypothesis]);
    let walking = with.stage.noise.noise.walking();
    let without = fitted.fit_rate_noise(&walking, &absent)?;
    let gained = 2.0 * (with.stage.noise.log_likelihood - without.log_likelihood);
    Ok(first.penalty + gained.max(0.0).ln_1p() + 2.0 * (walks as f64).ln())
}
