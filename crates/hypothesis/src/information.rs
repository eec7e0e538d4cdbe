//! The Cramér-Rao bound of an effect in a record.

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
    let plant = fitted.plant();
    let Some(sources) = signature(plant, effect, shape, rows) else {
        return Ok(None);
    };
    let mut extra = Vec::new();
    let columns: Vec<usize> = sources
        .into_iter()
        .map(|source| match source {
            Source::Parameter(parameter) => parameter,
            Source::Column(column) => {
                extra.push(column);
                plant.parameters.len() + extra.len() - 1
            }
        })
        .collect();
    let bank = ScoreBank::new(fitted, &extra)?;
    if columns.is_empty() || !columns.iter().all(|column| bank.visible(*column)) {
        return Ok(None);
    }
    let scale = scale(effect);
    let (information, _) = bank.part(&columns);
    Ok(Some(scale * scale * information))
}
