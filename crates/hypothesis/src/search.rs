//! The search and its result.

use gyrocal_scalar::effect::Effect;

use crate::accepted::Accepted;
use crate::context::{SearchContext, SearchOptions, extension};
use crate::forward::{FirstRound, forward};
use crate::hypothesis::{HypothesisSet, Selection, Unavailable};
use crate::model::{FittedModel, ModelExtension};
use crate::null_distribution::GaussianDraws;
use crate::pattern::Unmodelled;
use crate::plant::Plant;
use crate::reassess::reassess;
use crate::result::{Finding, FittedStage};
use crate::rows::Rows;
use crate::score::Ranked;
use crate::state::SearchState;

/// Result of a search.
pub struct Searched<F> {
    /// The model with all that was found, at its best fit.
    pub fitted: F,
    /// Detected effects, in the order of detection.
    pub findings: Vec<Finding>,
    /// Detected terms that no effect of the catalogue explains; they are in the model.
    pub unmodelled: Vec<Unmodelled>,
    /// All hypotheses in the first round, largest statistic first.
    pub ranking: Vec<Ranked>,
    /// Detection threshold of the first round.
    pub threshold: f64,
    /// Effects that the record cannot show.
    pub unavailable: Vec<Unavailable>,
    base: ModelExtension,
    plant: &'static Plant,
    rows: Rows,
    set: HypothesisSet,
    accepted: Vec<Accepted>,
}

impl<F> Searched<F> {
    /// The extension with all unmodelled terms and those findings that are `kept`.
    #[must_use]
    pub fn extension_with(&self, kept: &[bool]) -> ModelExtension {
        let accepted = self.accepted.iter().zip(kept);
        let accepted: Vec<Accepted> = accepted
            .filter(|(_, kept)| **kept)
            .map(|(accepted, _)| accepted.clone())
            .collect();
        let context = (self.plant, &self.set, &self.rows);
        extension(&self.base, context, &accepted, &self.unmodelled)
    }
}

/// Searches a record for the effects of a selection, from the nominal model at its best fit.
///
/// # Errors
/// Those of [`FittedModel::refitted`] and of passes over the record.
pub fn search<F: FittedModel>(
    nominal: F,
    rows: Rows,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Searched<F>, F::Error> {
    let plant = nominal.plant();
    let context = SearchContext {
        set: HypothesisSet::new(plant, &rows, &selection.effects),
        plant,
        base: nominal.extension().clone(),
        rows,
        options,
    };
    let mut draws = GaussianDraws::new(options.seed);
    let stage = FittedStage::new(nominal, &context.set, &context.rows, &[])?;
    let state = SearchState::new(stage);
    let (mut state, FirstRound { ranking, threshold }) = forward(&context, state, &mut draws)?;
    let findings = reassess(&context, &mut state, threshold, &mut draws)?;
    Ok(Searched {
        fitted: state.stage.fitted,
        findings,
        unmodelled: state.unmodelled,
        ranking,
        threshold,
        unavailable: selection.unavailable.clone(),
        base: context.base,
        plant,
        rows: context.rows,
        set: context.set,
        accepted: state.accepted,
    })
}

/// Effects of the default search and those with an id in `also`, but for those with a reason against
/// them: `missing` gives it.
#[must_use]
pub fn select(
    plant: &Plant,
    also: &[&str],
    missing: impl Fn(&Effect) -> Option<String>,
) -> Selection {
    let mut selection = Selection::default();
    for effect in plant.effects {
        if !(effect.default_search || also.contains(&effect.id)) {
            continue;
        }
        match missing(effect) {
            Some(why) => selection.unavailable.push(Unavailable {
                effect: effect.id,
                why,
            }),
            None => selection.effects.push(effect),
        }
    }
    selection
}
