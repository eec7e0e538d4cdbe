//! Two effects in the place of one: a large effect is not linear in its size, so that two sizes may have a
//! maximum of the likelihood together where each looks significant beside the other, and one of them alone,
//! fitted anew, explains as much.

use crate::accepted::value_places;
use crate::context::SearchContext;
use crate::finding::Alternative;
use crate::model::FittedModel;
use crate::state::{SearchState, stage};

/// Correlation of the errors of two sizes beyond which one effect may do the work of both: the part of one
/// that the other cannot have is then a fifth of it or less, and second orders of large effects are as much.
const CORRELATED: f64 = 0.98;

/// An effect that another one was found to replace, by a fit without it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Replaced {
    effect: &'static str,
    /// Hypothesis of the other effect.
    pub(crate) by: usize,
    /// Half of the penalty for its search less what it gains beside the other.
    deficit: f64,
}

impl Replaced {
    /// Tells it as an alternative: the likelihood of both effects together is no less than of one.
    pub(crate) fn add_to(&self, alternatives: &mut Vec<Alternative>) {
        match alternatives
            .iter_mut()
            .find(|other| other.effect == self.effect)
        {
            Some(own) => own.log_likelihood_deficit = own.log_likelihood_deficit.min(self.deficit),
            None => alternatives.push(Alternative {
                effect: self.effect,
                log_likelihood_deficit: self.deficit,
                nominal: None,
            }),
        }
        alternatives.sort_by(|a, b| {
            a.log_likelihood_deficit
                .total_cmp(&b.log_likelihood_deficit)
        });
    }
}

/// Takes an effect out of the model if its size is hardly told from that of another one, and the model
/// that is fitted without it is not detectably worse; which one that was.
pub(crate) fn replaceable<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    threshold: f64,
) -> Result<Option<Replaced>, F::Error> {
    if !state.stage.fitted.sets_need_fits() {
        return Ok(None);
    }
    let mut least: Option<(f64, Replaced, SearchState<F>)> = None;
    for (index, by) in correlated(context, state) {
        if context.budget.is_spent(state.stage.fitted.work()) {
            break;
        }
        let own = &state.accepted[index];
        let mut without = state.clone();
        without.accepted.remove(index);
        // A model that cannot be fitted is no better one.
        let Ok(fitted) = stage(
            context,
            &state.stage.fitted,
            &mut without.accepted,
            &without.unmodelled,
        ) else {
            continue;
        };
        without.stage = fitted;
        let gained = 2.0 * (state.stage.noise.log_likelihood - without.stage.noise.log_likelihood);
        let tested = gained - own.detection_penalty();
        if tested <= threshold && least.as_ref().is_none_or(|(most, ..)| tested < *most) {
            let found = Replaced {
                effect: context.set.hypotheses[own.hypothesis].id(),
                by,
                deficit: (0.5 * (own.penalty - gained)).max(0.0),
            };
            least = Some((tested, found, without));
        }
    }
    Ok(least.map(|(_, found, without)| {
        *state = without;
        found
    }))
}

/// Each accepted effect with a size that is hardly told from that of another one, and the hypothesis of
/// that one.
fn correlated<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
) -> Vec<(usize, usize)> {
    let fitted = &state.stage.fitted;
    let covariance = fitted.covariance();
    let accepted = state.accepted.iter();
    let places: Vec<Vec<usize>> = accepted
        .map(|own| value_places(fitted, &context.set.hypotheses[own.hypothesis]))
        .collect();
    let correlation = |one: usize, other: usize| {
        let variances = covariance[(one, one)] * covariance[(other, other)];
        covariance[(one, other)].abs() / variances.sqrt()
    };
    let largest = |one: usize, other: usize| {
        let own = places[one].iter();
        own.flat_map(|a| places[other].iter().map(move |b| (*a, *b)))
            .map(|(a, b)| correlation(a, b))
            .fold(0.0, f64::max)
    };
    (0..places.len())
        .filter_map(|one| {
            let others = (0..places.len()).filter(|other| *other != one);
            let nearest = others
                .map(|other| (other, largest(one, other)))
                .max_by(|a, b| a.1.total_cmp(&b.1))?;
            let hypothesis = state.accepted[nearest.0].hypothesis;
            (nearest.1 > CORRELATED).then_some((one, hypothesis))
        })
        .collect()
}
