//! Effects in the model, and the places of their sizes.

use gyrocal_scalar::effect::Enters;

use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::null_distribution::DETECTION_PENALTY_FRACTION;
use gyrocal_inference::Column;

/// An effect in the model.
#[derive(Clone, Debug)]
pub(crate) struct Accepted {
    pub(crate) hypothesis: usize,
    pub(crate) shape: Option<f64>,
    /// What its detection said; `None` of an effect that came into the model by another way, as in the place of
    /// another one.
    pub(crate) detection: Option<Detection>,
    /// Penalty of a jump for the test of every step.
    pub(crate) searched: f64,
    /// The whole search penalty.
    pub(crate) penalty: f64,
}

/// The test that detected an effect.
#[derive(Clone, Debug)]
pub(crate) struct Detection {
    /// Family-wise p-value.
    pub(crate) p_value: f64,
    /// The model that it was tested in.
    pub(crate) model: ModelTerms,
}

/// Terms of a model: hypotheses, number of unmodelled terms, and rates that walk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ModelTerms {
    pub(crate) hypotheses: Vec<usize>,
    pub(crate) unmodelled: usize,
    pub(crate) walking: Vec<usize>,
}

impl Accepted {
    /// Its p-value, if the model is that of its detection.
    pub(crate) fn p_value_in(&self, model: &ModelTerms) -> Option<f64> {
        let detection = self.detection.as_ref()?;
        (detection.model == *model).then_some(detection.p_value)
    }

    /// The part of its search penalty that the detection test subtracts.
    pub(crate) fn detection_penalty(&self) -> f64 {
        DETECTION_PENALTY_FRACTION * (self.penalty - self.searched) + self.searched
    }
}

/// Places of an effect among the values of a fit.
pub(crate) fn value_places<F: FittedModel>(fitted: &F, hypothesis: &Hypothesis) -> Vec<usize> {
    let plant = fitted.plant();
    let extension = fitted.extension();
    let first = plant.nominal_parameters;
    let own_columns = |is_own: &dyn Fn(&Column) -> bool| {
        let base = first + extension.parameters.len();
        let columns = extension.columns.columns().iter().enumerate();
        columns
            .filter(|(_, column)| is_own(column))
            .map(|(index, _)| base + index)
            .collect()
    };
    if matches!(hypothesis.effect.enters, Enters::States(_)) {
        return own_columns(&|column| match column {
            Column::InitialState { .. } => !hypothesis.is_jump,
            Column::StateJump { .. } => hypothesis.is_jump,
            _ => false,
        });
    }
    let states: Vec<usize> = hypothesis.effect.estimated_parameters().collect();
    extension
        .parameters
        .iter()
        .enumerate()
        // Nuisance parameters of the bench have a prior and are no effects.
        .filter(|(_, (parameter, sigma))| states.contains(parameter) && sigma.is_infinite())
        .map(|(index, _)| first + index)
        .collect()
}
