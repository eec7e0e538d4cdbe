//! Options and data of a search.

use std::rc::Rc;

use gyrocal_scalar::effect::{Effect, EffectKind};

use crate::accepted::Accepted;
use crate::budget::Budget;
use crate::hypothesis::{HypothesisSet, Selection};
use crate::model::{FittedModel, ModelExtension};
use crate::pattern::Unmodelled;
use crate::plant::Plant;
use crate::rows::Rows;

/// Error rates of a search, and what it needs to know of what was done before.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchOptions {
    /// Family-wise probability of a false alarm of all deterministic hypotheses together.
    pub false_alarm_probability: f64,
    /// Probability of a false alarm of the test of random walks, all rates together.
    pub walk_probability: f64,
    /// Probability of a false alarm of the tests for unmodelled terms.
    pub unmodelled_probability: f64,
    /// Seed of the draws of the null distribution.
    pub seed: u64,
    /// Work done on the record before the search, in the unit of [`FittedModel::work`]: where it was much,
    /// the search has a smaller budget.
    pub work_before: u64,
    /// Whether names are enough, in the order in which they are detected: no other name is tried in their place, and they
    /// have no sets.
    pub names_alone: bool,
}

impl Default for SearchOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            walk_probability: 0.001,
            unmodelled_probability: 0.001,
            seed: 0,
            work_before: 0,
            names_alone: false,
        }
    }
}

/// Largest number of effects in one record: more mean that the catalogue lacks the true one.
pub(crate) const MOST_EFFECTS: usize = 6;

/// An effect that another search of the same record has found, to be tried before others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposed {
    pub(crate) hypothesis: usize,
    pub(crate) shape: Option<f64>,
}

/// Data and hypotheses of one search.
pub(crate) struct SearchContext<'t> {
    pub(crate) plant: &'static Plant,
    pub(crate) set: HypothesisSet,
    /// Effects that may be random walks.
    pub(crate) walks: Vec<&'static Effect>,
    /// The extension of the nominal model.
    pub(crate) base: ModelExtension,
    pub(crate) rows: Rows,
    pub(crate) options: &'t SearchOptions,
    pub(crate) budget: Rc<Budget>,
    /// Effects that are tried before others.
    pub(crate) proposed: Vec<Proposed>,
}

impl<'t> SearchContext<'t> {
    /// Of a nominal model and the effects of a selection, without an end of its budget.
    pub(crate) fn new<F: FittedModel>(
        nominal: &F,
        rows: Rows,
        selection: &Selection,
        options: &'t SearchOptions,
    ) -> Self {
        let plant = nominal.plant();
        let effects = selection.effects.iter().copied();
        let mut set = HypothesisSet::new(plant, &rows, &selection.effects);
        set.add_rivals(plant, &rows, &selection.rivals);
        Self {
            plant,
            set,
            walks: effects
                .filter(|effect| effect.kind == EffectKind::RandomWalk)
                .collect(),
            base: nominal.extension().clone(),
            rows,
            options,
            budget: Rc::new(Budget::unlimited()),
            proposed: Vec::new(),
        }
    }

    /// The same with the effects alone that can act like a random walk of a rate: those of the other rates
    /// have no variant.
    pub(crate) fn of_rate(&self, rate: usize) -> Self {
        let is_own = |effect: &Effect| effect.rate().is_none_or(|own| own == rate);
        Self {
            plant: self.plant,
            set: self.set.restricted(self.plant, is_own),
            walks: self.walks.clone(),
            base: self.base.clone(),
            rows: self.rows.clone(),
            options: self.options,
            budget: Rc::clone(&self.budget),
            proposed: Vec::new(),
        }
    }

    /// The model with these effects, fitted from another one.
    pub(crate) fn fitted<F: FittedModel>(
        &self,
        from: &F,
        accepted: &[Accepted],
        unmodelled: &[Unmodelled],
    ) -> Result<F, F::Error> {
        let context = (self.plant, &self.set, &self.rows);
        from.refitted(&extension(&self.base, context, accepted, unmodelled))
    }
}

/// The extension that all accepted effects and unmodelled terms make up.
pub(crate) fn extension(
    base: &ModelExtension,
    (plant, set, rows): (&Plant, &HypothesisSet, &Rows),
    accepted: &[Accepted],
    unmodelled: &[Unmodelled],
) -> ModelExtension {
    let mut extension = base.clone();
    for found in unmodelled {
        let columns = found.columns.iter().cloned();
        extension.columns.extend(columns, f64::INFINITY);
    }
    for accepted in accepted {
        set.add_to_model(
            plant,
            rows,
            &mut extension,
            accepted.hypothesis,
            accepted.shape,
        );
    }
    extension
}
