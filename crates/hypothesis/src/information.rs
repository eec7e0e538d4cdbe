//! The Cramér-Rao bound of effects in a record.

use gyrocal_scalar::effect::Effect;
use nalgebra::DMatrix;

use crate::bank::ScoreBank;
use crate::model::FittedModel;
use crate::rows::Rows;
use crate::signature::{Source, scale, signature};

/// Information of a record on the sizes of an effect, the fitted unknowns projected out, in the
/// units of the effect's parameters: its inverse is the Cramér-Rao bound. `shape` is the onset
/// \[s\] or the time constant \[h\] of an effect that has one. `None` for effects without a
/// signature, and where they are not observable.
///
/// # Errors
/// Those of a pass over the record.
pub fn information<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    effect: &Effect,
    shape: Option<f64>,
) -> Result<Option<DMatrix<f64>>, F::Error> {
    Ok(informations(fitted, rows, &[(effect, shape)])?
        .pop()
        .flatten())
}

/// Cramér-Rao bounds of the first sizes of several effects, each with its shape, as standard
/// deviations. One pass over the record serves all of them.
///
/// # Errors
/// Those of a pass over the record.
pub fn sigmas<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    effects: &[(&Effect, Option<f64>)],
) -> Result<Vec<Option<f64>>, F::Error> {
    let bound = |information: DMatrix<f64>| {
        let sigma = information.try_inverse()?[(0, 0)].sqrt();
        sigma.is_finite().then_some(sigma)
    };
    let informations = informations(fitted, rows, effects)?;
    Ok(informations.into_iter().map(|i| bound(i?)).collect())
}

fn informations<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    effects: &[(&Effect, Option<f64>)],
) -> Result<Vec<Option<DMatrix<f64>>>, F::Error> {
    let plant = fitted.plant();
    let mut extra = Vec::new();
    let places: Vec<Option<Vec<usize>>> = effects
        .iter()
        .map(|(effect, shape)| {
            let sources = signature(plant, effect, *shape, rows)?.into_iter();
            let columns = sources.map(|source| match source {
                Source::Parameter(parameter) => parameter,
                Source::Column(column) => {
                    extra.push(column);
                    plant.parameters.len() + extra.len() - 1
                }
            });
            Some(columns.collect())
        })
        .collect();
    let bank = ScoreBank::new(fitted, &extra)?;
    let of = |effect: &Effect, columns: Vec<usize>| {
        if columns.is_empty() || !columns.iter().all(|column| bank.visible(*column)) {
            return None;
        }
        let scale = scale(effect);
        let (information, _) = bank.part(&columns);
        Some(scale * scale * information)
    };
    let all = effects.iter().zip(places);
    Ok(all
        .map(|((effect, _), columns)| of(effect, columns?))
        .collect())
}
