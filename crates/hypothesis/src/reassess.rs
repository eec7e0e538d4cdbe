//! Reassessment after the forward selection: an effect found early may have another name, or none,
//! given those found later.

use crate::accepted::Accepted;
use crate::by_fits::Compared;
use crate::context::{MOST_EFFECTS, SearchContext};
use crate::merged::merge;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::replaced::{Replaced, replaceable};
use crate::result::{ConditionalResult, evaluate};
use crate::score::Best;
use crate::shape_estimates::ShapeEstimates;
use crate::state::{SearchState, stage};
use crate::walk_candidates::{BESIDE_WALKS, Rival};

/// Puts one effect in the place of two where it does as well, then swaps names and removes insignificant
/// effects until nothing changes; the conditional result of each effect that remains.
pub(crate) fn reassess<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    threshold: f64,
    rivals: &mut [Rival],
    draws: &mut GaussianDraws,
) -> Result<Vec<ConditionalResult>, F::Error> {
    let mut swaps = 0;
    // An effect beside walks must gain more, whenever it came into the model.
    let least = match state.stage.noise.noise.walking().is_empty() {
        true => threshold,
        false => threshold + BESIDE_WALKS,
    };
    // First: what stands in the set of an effect takes fits to tell.
    merge_pairs(context, state, least, rivals, draws)?;
    let mut replaced: Vec<Replaced> = Vec::new();
    let mut can_remove = true;
    loop {
        let mut results = Vec::with_capacity(state.accepted.len());
        let mut weakest: Option<(usize, f64)> = None;
        let mut better: Option<(usize, Best, f64)> = None;
        for index in 0..state.accepted.len() {
            let compared = Compared {
                stage: &state.stage,
                accepted: &state.accepted,
                unmodelled: &state.unmodelled,
                index,
            };
            let result = evaluate(&compared, context, draws)?;
            if weakest.is_none_or(|(_, least)| result.tested < least) {
                weakest = Some((index, result.tested));
            }
            if let Some((other, advantage)) = result.better
                && better.is_none_or(|(.., most)| advantage > most)
            {
                better = Some((index, other, advantage));
            }
            results.push(result);
        }
        if let Some((index, other, _)) = better
            && swaps < MOST_EFFECTS
            && !context.budget.is_spent(state.stage.fitted.work())
        {
            swaps += 1;
            // An effect stays if its successor cannot be fitted.
            let own = state.accepted[index].hypothesis;
            if swap(context, state, index, &other).is_ok() {
                rename(rivals, own, other.hypothesis);
                continue;
            }
        }
        match weakest {
            Some((index, strength))
                if can_remove
                    && strength <= least
                    && state.accepted.len() + state.unmodelled.len() > 1 =>
            {
                let mut others = state.accepted.clone();
                others.remove(index);
                match stage(context, &state.stage.fitted, &mut others, &state.unmodelled) {
                    Ok(without) => {
                        state.stage = without;
                        state.accepted = others;
                    }
                    // Without it no fit converges.
                    Err(_) => can_remove = false,
                }
            }
            _ => {
                if let Some(found) = replaceable(context, state, threshold)? {
                    replaced.push(found);
                    continue;
                }
                complete(context, state, (rivals, &replaced), &mut results, draws)?;
                return Ok(results);
            }
        }
    }
}

/// Puts one effect in the place of two for as long as it does as well.
fn merge_pairs<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    least: f64,
    rivals: &mut [Rival],
    draws: &mut GaussianDraws,
) -> Result<(), F::Error> {
    while let Some(merged) = merge(context, state, least, draws)? {
        for own in merged.pair {
            rename(rivals, own, merged.by);
        }
    }
    Ok(())
}

/// Makes the rivals of one effect those of another one that is in its place.
fn rename(rivals: &mut [Rival], own: usize, other: usize) {
    let of = rivals.iter_mut().flat_map(|rival| &mut rival.of);
    for of in of.filter(|of| **of == own) {
        *of = other;
    }
}

/// Adds to the results of the effects that remain what no swap changes any more: intervals of their shapes,
/// and the effects that they replaced and rival.
fn complete<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    (rivals, replaced): (&[Rival], &[Replaced]),
    results: &mut [ConditionalResult],
    draws: &mut GaussianDraws,
) -> Result<(), F::Error> {
    let shapes = ShapeEstimates::new(&state.stage, context, &state.accepted);
    for (index, result) in results.iter_mut().enumerate() {
        let finding = &mut result.finding;
        shapes.add_to(&mut finding.parameters, index, draws)?;
        let hypothesis = state.accepted[index].hypothesis;
        for other in replaced.iter().filter(|other| other.by == hypothesis) {
            other.add_to(&mut finding.alternatives);
        }
        let own = rivals.iter().filter(|rival| rival.of.contains(&hypothesis));
        for rival in own {
            finding
                .alternatives
                .extend(rival.alternatives.iter().cloned());
        }
    }
    Ok(())
}

/// Puts another effect in the place of an accepted one. An error leaves the state unchanged.
fn swap<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    index: usize,
    other: &Best,
) -> Result<(), F::Error> {
    let mut accepted = state.accepted.clone();
    let own = accepted.remove(index);
    let without = context.fitted(&state.stage.fitted, &accepted, &state.unmodelled)?;
    let swapped = Accepted {
        hypothesis: other.hypothesis,
        shape: other.shape(&context.set.hypotheses),
        searched: other.searched,
        detection: None,
        ..own
    };
    accepted.insert(index, swapped);
    state.stage = stage(context, &without, &mut accepted, &state.unmodelled)?;
    state.accepted = accepted;
    Ok(())
}
