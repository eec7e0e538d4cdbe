//! A fitted model with its accepted effects, as each later stage of a search starts from it.

use crate::accepted::{Accepted, value_places};
use crate::bank::{GramProducts, ScoreBank};
use crate::hypothesis::HypothesisSet;
use crate::model::FittedModel;
use crate::rate_noise::RateNoiseFit;
use crate::rows::Rows;
use crate::signature::{Source, profiles, signature};

/// A fitted model with its accepted effects, and the Gram matrix of its signatures.
#[derive(Clone)]
pub(crate) struct FittedStage<F> {
    pub(crate) fitted: F,
    /// Noise of the rates, estimated with the model.
    pub(crate) noise: RateNoiseFit,
    /// With all unknowns of the model projected out.
    pub(crate) bank: ScoreBank,
    pub(crate) products: GramProducts,
    /// Of each accepted effect.
    pub(crate) places: Vec<EffectPlaces>,
}

/// Places of one accepted effect.
#[derive(Clone)]
pub(crate) struct EffectPlaces {
    /// Among the values of the fit.
    pub(crate) values: Vec<usize>,
    /// In the bank: columns of a jump at its onset.
    pub(crate) jump: Option<Vec<usize>>,
    /// In the bank: columns at the estimated shape.
    pub(crate) shaped: Option<Vec<usize>>,
}

impl<F: FittedModel> FittedStage<F> {
    /// Of a model that was fitted with `accepted`.
    pub(crate) fn new(
        fitted: F,
        noise: RateNoiseFit,
        set: &HypothesisSet,
        rows: &Rows,
        accepted: &[Accepted],
    ) -> Result<Self, F::Error> {
        let plant = fitted.plant();
        let mut extra = set.extra.clone();
        let mut places = Vec::with_capacity(accepted.len());
        for accepted in accepted {
            let hypothesis = &set.hypotheses[accepted.hypothesis];
            let first = plant.parameters.len() + extra.len();
            let mut own = EffectPlaces {
                values: value_places(&fitted, hypothesis),
                jump: None,
                shaped: None,
            };
            if hypothesis.is_jump {
                let sources = signature(plant, hypothesis.effect, accepted.shape, rows);
                let columns = sources.unwrap_or_default().into_iter();
                extra.extend(columns.filter_map(|source| match source {
                    Source::Column(column) => Some(column),
                    Source::Parameter(_) => None,
                }));
                own.jump = Some((first..plant.parameters.len() + extra.len()).collect());
            } else if let Some(columns) = accepted
                .shape
                .and_then(|shape| profiles(plant, hypothesis.effect, shape, rows))
            {
                own.shaped = Some((first..first + columns.len()).collect());
                extra.extend(columns);
            }
            places.push(own);
        }
        let products = GramProducts::new(&fitted, &extra)?;
        Ok(Self {
            bank: products.bank(&[])?,
            fitted,
            noise,
            products,
            places,
        })
    }
}
