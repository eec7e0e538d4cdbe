//! One effect in the place of two: what a single effect does, two others may share out among themselves, and
//! a forward selection that named one of these first goes on with the other.

use crate::accepted::Accepted;
use crate::bank::ScoreBank;
use crate::context::SearchContext;
use crate::hypothesis::{Hypothesis, Variant};
use crate::model::FittedModel;
use crate::null_distribution::{GaussianDraws, NullDistribution};
use crate::result::unmasked;
use crate::score::{NEAR_LARGEST, Scores};
use crate::state::{SearchState, stage};

/// Share of the statistic of two effects by which scores about their fit may misjudge that of one: the
/// trajectories of both models agree within the noise, so that second orders alone differ.
const MISJUDGED: f64 = 0.05;

/// Two effects that another one replaced, by their hypotheses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Merged {
    pub(crate) pair: [usize; 2],
    pub(crate) by: usize,
}

/// Puts one effect, which may be one of the two with another shape, in the place of two of the model if the
/// model with both is not detectably better.
pub(crate) fn merge<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    threshold: f64,
    draws: &mut GaussianDraws,
) -> Result<Option<Merged>, F::Error> {
    let count = state.accepted.len();
    for first in 0..count {
        for second in first + 1..count {
            if context.budget.is_exhausted(state.stage.fitted.work()) {
                return Ok(None);
            }
            let pair = [first, second];
            let Some(one) = best_of(context, state, pair, threshold, draws)? else {
                continue;
            };
            // A model that cannot be fitted is no better one.
            let Some(found) = with_one(context, state, pair, one) else {
                continue;
            };
            let gained =
                2.0 * (state.stage.noise.log_likelihood - found.stage.noise.log_likelihood);
            let own = &found.accepted[first];
            let searched = detection_penalty(state, pair) - own.detection_penalty();
            if gained - searched <= threshold {
                let merged = Merged {
                    pair: pair.map(|own| state.accepted[own].hypothesis),
                    by: own.hypothesis,
                };
                *state = found;
                return Ok(Some(merged));
            }
        }
    }
    Ok(None)
}

/// The best effect for the place of two, if by its score it may be likelier than both.
fn best_of<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    pair: [usize; 2],
    threshold: f64,
    draws: &mut GaussianDraws,
) -> Result<Option<Accepted>, F::Error> {
    let stage = &state.stage;
    let places = pair.map(|own| &stage.places[own]);
    let absent: Vec<usize> = places.iter().flat_map(|own| own.values.clone()).collect();
    let bank = stage.products.bank(&absent)?;
    let mut hypotheses = unmasked(&context.set, &state.accepted, &pair, &stage.places);
    let Some(both) = of_both(state, pair, &hypotheses, &bank) else {
        return Ok(None);
    };
    let least = (1.0 - MISJUDGED) * both - threshold - detection_penalty(state, pair);
    let null = NullDistribution::without_search(hypotheses.len());
    let coarse = Scores::of(&bank, &hypotheses, &null, None);
    for (index, hypothesis) in hypotheses.iter_mut().enumerate() {
        let has_shape = hypothesis.effect.shape().is_some();
        let mut own = pair.iter().map(|own| state.accepted[*own].hypothesis);
        let is_without_change = !has_shape && own.any(|own| own == index);
        let statistic = coarse.best[index].map_or(0.0, |best| best.statistic);
        let share = if has_shape { NEAR_LARGEST } else { 1.0 };
        let is_out = hypothesis.is_jump || !hypothesis.can_be_named;
        if is_without_change || is_out || statistic < share * least {
            *hypothesis = hypothesis.masked(true);
        }
    }
    if hypotheses.iter().all(|one| one.variants.is_empty()) {
        return Ok(None);
    }
    let null = NullDistribution::draw(&bank, &hypotheses, draws);
    let mut scores = Scores::of(&bank, &hypotheses, &null, None);
    scores.refine(&stage.fitted, context, &hypotheses, &absent)?;
    let Some(best) = scores
        .named(&hypotheses)
        .filter(|best| best.statistic > least)
    else {
        return Ok(None);
    };
    Ok(Some(Accepted {
        hypothesis: best.hypothesis,
        shape: best.shape(&hypotheses),
        detection: None,
        searched: 0.0,
        penalty: null.penalties[best.hypothesis],
    }))
}

/// Statistic of two effects together.
fn of_both<F>(
    state: &SearchState<F>,
    pair: [usize; 2],
    hypotheses: &[Hypothesis],
    bank: &ScoreBank,
) -> Option<f64> {
    let mut columns = Vec::new();
    for own in pair {
        let accepted = &state.accepted[own];
        let hypothesis = &hypotheses[accepted.hypothesis];
        let is_fitted = |variant: &&Variant| hypothesis.is_jump || variant.shape == accepted.shape;
        let own = hypothesis.variants.iter().rfind(is_fitted)?;
        columns.extend_from_slice(&own.columns);
    }
    Some(bank.joint(&columns)?.statistic)
}

/// Detection penalties of two effects.
fn detection_penalty<F>(state: &SearchState<F>, pair: [usize; 2]) -> f64 {
    let own = pair.iter().map(|own| &state.accepted[*own]);
    own.map(Accepted::detection_penalty).sum()
}

/// The model with one effect in the place of two; `None` if no fit converges.
fn with_one<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    [first, second]: [usize; 2],
    one: Accepted,
) -> Option<SearchState<F>> {
    let mut found = state.clone();
    found.accepted.remove(second);
    found.accepted.remove(first);
    let from = &state.stage.fitted;
    // Through the model without both: the sizes of the two are no start for that of the one.
    let without = context
        .fitted(from, &found.accepted, &found.unmodelled)
        .ok()?;
    found.accepted.insert(first, one);
    found.stage = stage(context, &without, &mut found.accepted, &found.unmodelled).ok()?;
    Some(found)
}
