//! Forward selection: one effect after the other, with a full fit after each.

use core::mem;

use gyrocal_statistics::math::ln;

use crate::accepted::Accepted;
use crate::context::{MOST_EFFECTS, SearchContext};
use crate::hypothesis::Hypothesis;
use crate::jump::best_jump;
use crate::model::FittedModel;
use crate::null_distribution::{GaussianDraws, NullDistribution};
use crate::pattern::Unmodelled;
use crate::score::{Best, NESTED_MODEL_CHI2, Ranked, Scores};
use crate::state::{SearchState, stage};
use crate::unmodelled;

/// Result of the first detection test.
#[derive(Default)]
pub(crate) struct FirstRound {
    /// All hypotheses, largest statistic first.
    pub(crate) ranking: Vec<Ranked>,
    /// Detection threshold.
    pub(crate) threshold: f64,
}

/// Stage of the random-walk hypothesis: a walk can mimic several effects together, so those are
/// tried first.
enum RandomWalkStage<F> {
    /// No walk was named yet.
    Deferred,
    /// A walk would have been named; several effects are tried in its place.
    TryingAlternatives(Box<DeferredWalk<F>>),
    /// A walk may be named.
    Allowed,
}

/// State of a search at which a random walk would have been named.
struct DeferredWalk<F> {
    /// Penalised statistic of the walk.
    score: f64,
    threshold: f64,
    state: SearchState<F>,
}

impl<F: FittedModel> DeferredWalk<F> {
    /// Twice the log-likelihood that the effects found in its place gain, less their search penalties
    /// and, for each but the first, the detection threshold. `None` if there are not several, as one
    /// alone has been compared with the walk before, or not without an unmodelled term.
    fn alternatives_score(&self, state: &SearchState<F>) -> Option<f64> {
        let found = &state.accepted[self.state.accepted.len()..];
        if found.len() < 2 || state.unmodelled.len() > self.state.unmodelled.len() {
            return None;
        }
        let penalties: f64 = found.iter().map(|accepted| accepted.penalty).sum();
        let more = (found.len() - 1) as f64 * self.threshold;
        let gained = self.state.stage.fitted.cost() - state.stage.fitted.cost();
        Some(gained - penalties - more)
    }
}

/// Adds effects until none is significant.
pub(crate) fn forward<F: FittedModel>(
    context: &SearchContext<'_>,
    mut state: SearchState<F>,
    draws: &mut GaussianDraws,
) -> Result<(SearchState<F>, FirstRound), F::Error> {
    let mut first: Option<FirstRound> = None;
    let mut walks = RandomWalkStage::Deferred;
    loop {
        let hypotheses = open_hypotheses(context, &state, &walks);
        let null = NullDistribution::draw(&state.stage.bank, &hypotheses, draws);
        let jumps = state.stage.fitted.state_jumps()?;
        let jump = best_jump(&jumps, &context.rows);
        let mut scores = Scores::of(&state.stage.bank, &hypotheses, &null, jump);
        let threshold = null.threshold(context.options.false_alarm_probability);
        first.get_or_insert_with(|| FirstRound {
            ranking: scores.ranking(&hypotheses),
            threshold,
        });
        let significant = scores.largest() > threshold && state.accepted.len() < MOST_EFFECTS;
        if significant {
            scores.refine(&state.stage.fitted, context, &hypotheses, &[])?;
        }
        let best = scores.named(&hypotheses).filter(|_| significant);
        let is_walk = best.is_some_and(|best| hypotheses[best.hypothesis].walk.is_some());
        // An unmodelled term goes into the model if no effect is significant, or if it explains so
        // much more that a name would be false. A random walk would absorb any curve.
        let stands = |other: &Unmodelled| {
            let explains_more = |best: Best| {
                // Several effects together look like a line at a natural period.
                !other.has_natural_period(context.plant, &context.rows)
                    && other.equivalent() > scores.penalised(best.hypothesis) + NESTED_MODEL_CHI2
            };
            other.ln_probability < ln(context.options.unmodelled_probability)
                && best.is_none_or(explains_more)
        };
        // A polynomial or one jump absorbs most of what bends or switches with a covariate.
        let curves = is_walk
            || !state.accepted.is_empty()
            || best.is_none_or(|best| hypotheses[best.hypothesis].is_jump);
        if state.seeks_unmodelled
            && state.unmodelled.len() < MOST_EFFECTS
            && let Some(other) =
                unmodelled::strongest(&state.stage.fitted, &context.rows, &jumps, curves, stands)?
            && accept_unmodelled(context, &mut state, other)
        {
            continue;
        }
        match (best, mem::replace(&mut walks, RandomWalkStage::Allowed)) {
            (None, RandomWalkStage::TryingAlternatives(deferred)) => {
                let alternatives = deferred.alternatives_score(&state);
                if alternatives.is_none_or(|score| score < deferred.score) {
                    state = deferred.state;
                }
            }
            (None, _) => return Ok((state, first.unwrap_or_default())),
            (Some(best), RandomWalkStage::Deferred) if is_walk => {
                walks = RandomWalkStage::TryingAlternatives(Box::new(DeferredWalk {
                    score: scores.penalised(best.hypothesis) - NESTED_MODEL_CHI2,
                    threshold,
                    state: state.clone(),
                }));
            }
            (Some(best), as_before) => {
                walks = as_before;
                let accepted = Accepted {
                    hypothesis: best.hypothesis,
                    shape: best.shape(&hypotheses),
                    p_value: null.probability(scores.largest()),
                    searched: best.searched,
                    penalty: best.searched + null.penalties[best.hypothesis],
                };
                accept(context, &mut state, accepted);
            }
        }
    }
}

/// Hypotheses that are not in the model and can be distinguished from it.
fn open_hypotheses<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    walks: &RandomWalkStage<F>,
) -> Vec<Hypothesis> {
    let accepted = state.accepted.iter().map(|accepted| accepted.hypothesis);
    let taken: Vec<usize> = accepted.chain(state.inseparable.iter().copied()).collect();
    let without_walks = matches!(walks, RandomWalkStage::TryingAlternatives(_));
    let all = context.set.hypotheses.iter().enumerate();
    all.map(|(index, hypothesis)| {
        let taken = taken.contains(&index) || context.set.is_equivalent(index, &taken);
        hypothesis.masked(taken || without_walks && hypothesis.walk.is_some())
    })
    .collect()
}

/// Adds an effect to the model. One that cannot be fitted beside the others is not separable from
/// them.
fn accept<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    accepted: Accepted,
) {
    let hypothesis = accepted.hypothesis;
    state.accepted.push(accepted);
    match stage(
        context,
        &state.stage.fitted,
        &mut state.accepted,
        &state.unmodelled,
    ) {
        Ok(next) => state.stage = next,
        Err(_) => {
            state.accepted.pop();
            state.inseparable.push(hypothesis);
        }
    }
}

/// Adds an unmodelled term to the model; whether it could be fitted. If not, it is left to the
/// residual tests.
fn accept_unmodelled<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    other: Unmodelled,
) -> bool {
    state.unmodelled.push(other);
    match stage(
        context,
        &state.stage.fitted,
        &mut state.accepted,
        &state.unmodelled,
    ) {
        Ok(next) => {
            state.stage = next;
            true
        }
        Err(_) => {
            state.unmodelled.pop();
            state.seeks_unmodelled = false;
            false
        }
    }
}
