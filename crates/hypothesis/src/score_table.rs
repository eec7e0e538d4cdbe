//! Scores of one record on all effects of a search, as plain data: what a record adds to the evidence of
//! many.

use gyrocal_scalar::effect::Continuation;
use nalgebra::DMatrix;

use crate::bank::ScoreBank;
use crate::hypothesis::Hypothesis;
use crate::signature::scale;

/// Scores and information of a record on the effects that its last model does not hold, given that
/// model: equations (1) and (2) of the crate, in the units of the effects' parameters.
///
/// Jumps of states and random walks have no signature among them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScoreTable {
    /// The effects, in the order of the plant's table.
    pub effects: Vec<ScoredEffect>,
    /// Effects that the model holds already, and their exact equivalents.
    pub in_model: Vec<String>,
    /// Score of each column over the root of its information: standard normal without an effect.
    pub z: Vec<f64>,
    /// Root of the information of each column: the reciprocal of the sigma of a size, given all else.
    pub root_information: Vec<f64>,
    /// Correlation of the columns' scores.
    pub correlation: DMatrix<f64>,
}

/// The columns of an effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScoredEffect {
    /// Public id.
    pub id: String,
    /// Unit of the sizes.
    pub unit: String,
    /// Whether its sizes are the same in all records of a plant: it has no onset and no time constant, and
    /// does not begin anew.
    pub persists: bool,
    /// Columns at each onset or time constant; one entry of an effect without any.
    pub variants: Vec<Vec<usize>>,
}

impl ScoreTable {
    /// Of a bank; effects without variants are those in the model.
    pub(crate) fn of(bank: &ScoreBank, hypotheses: &[Hypothesis]) -> Self {
        let mut table = Self::default();
        // Columns of the bank, and the unit of the column over that of the size.
        let mut columns: Vec<(usize, f64)> = Vec::new();
        for hypothesis in hypotheses.iter().filter(|one| !one.is_jump) {
            let effect = hypothesis.effect;
            if hypothesis.variants.is_empty() {
                table.in_model.push(effect.id.to_owned());
                continue;
            }
            let seen = |variant: &&Vec<usize>| bank.joint(variant).is_some();
            let variants = hypothesis.variants.iter().map(|variant| &variant.columns);
            let mut place = |column: &usize| {
                let known = columns.iter().position(|(other, _)| other == column);
                known.unwrap_or_else(|| {
                    columns.push((*column, scale(effect)));
                    columns.len() - 1
                })
            };
            let variants: Vec<Vec<usize>> = variants
                .filter(seen)
                .map(|variant| variant.iter().map(&mut place).collect())
                .collect();
            if variants.is_empty() {
                continue;
            }
            let shaped = effect.shape().is_some();
            let goes_on = matches!(
                effect.continuation,
                Continuation::GoesOn | Continuation::Stays
            );
            table.effects.push(ScoredEffect {
                id: effect.id.to_owned(),
                unit: effect
                    .parameters
                    .first()
                    .map_or("", |size| size.unit)
                    .to_owned(),
                persists: goes_on && !shaped,
                variants,
            });
        }
        let root = |column: usize| bank.information[(column, column)].sqrt();
        table.z = columns
            .iter()
            .map(|(column, _)| bank.score[*column] / root(*column))
            .collect();
        table.root_information = columns
            .iter()
            .map(|(column, scale)| root(*column) * scale.abs())
            .collect();
        let count = columns.len();
        table.correlation = DMatrix::from_fn(count, count, |i, j| {
            let (one, other) = (columns[i].0, columns[j].0);
            bank.information[(one, other)] / (root(one) * root(other))
        });
        table
    }
}
