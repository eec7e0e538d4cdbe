//! Signatures: the columns of a linearised model that an effect stands for.

use gyrocal_scalar::effect::{Effect, EffectKind, EffectParameter, Enters};

use crate::plant::Plant;
use crate::rows::Rows;
use gyrocal_inference::Column;

/// One column of a signature.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A constant parameter of the model, by its index.
    Parameter(usize),
    /// A column beside them.
    Column(Column),
}

/// The signature of an effect in a record: one source for each of its sizes. `shape` is its onset
/// \[s since the first row\] or its time constant \[h\]. `None` for noise, for random walks, and if
/// the shape is missing.
///
/// This is the one place that knows which columns an effect has: search, bound, design and
/// continuation all start from it.
#[must_use]
pub fn signature(
    plant: &Plant,
    effect: &Effect,
    shape: Option<f64>,
    rows: &Rows,
) -> Option<Vec<Source>> {
    match (effect.kind, effect.enters, shape) {
        (EffectKind::InitialState, Enters::States(states), start_s) => {
            let row = start_s.map_or(0, |start_s| rows.rows_before(start_s));
            let columns = states
                .iter()
                .map(|state| Column::InitialState { row, state: *state });
            Some(columns.map(Source::Column).collect())
        }
        (EffectKind::StateJump, Enters::States(states), Some(onset_s)) => {
            let row = jump_row(rows, onset_s);
            let columns = states
                .iter()
                .map(|state| Column::StateJump { row, state: *state });
            Some(columns.map(Source::Column).collect())
        }
        (EffectKind::Step, Enters::Rates(&[rate]), Some(onset_s)) => {
            let last = rows.len().saturating_sub(2);
            Some(vec![Source::Column(Column::Step {
                parameter: plant.rates.get(rate)?.constant,
                row: rows.rows_before(onset_s).min(last),
            })])
        }
        _ if effect.has_term() && effect.shape().is_none() => {
            Some(effect.model_parameters().map(Source::Parameter).collect())
        }
        _ => {
            let value = shape?;
            let own = effect.shape()?;
            effect
                .sizes()
                .map(|size| profile(plant, effect, size, (own, value), rows))
                .map(|column| column.map(Source::Column))
                .collect()
        }
    }
}

/// The derivative of a signature of one size by its shape, times that size: how the residuals
/// change with an onset or a time constant. It is the difference between two shapes over their
/// distance.
#[must_use]
pub fn shape_derivative(
    plant: &Plant,
    effect: &Effect,
    size: f64,
    [low, high]: [f64; 2],
    rows: &Rows,
) -> Option<Column> {
    let own = effect.shape()?;
    let parameter = effect.sizes().next()?;
    let at = |value: f64| profile(plant, effect, parameter, (own, value), rows);
    let slope = |before: &[f64], after: &[f64]| {
        before
            .iter()
            .zip(after)
            .map(|(before, after)| size * (after - before) / (high - low))
            .collect()
    };
    Some(match (at(low)?, at(high)?) {
        (Column::TimeProfile { parameter, steps }, Column::TimeProfile { steps: after, .. }) => {
            Column::TimeProfile {
                parameter,
                steps: slope(&steps, &after),
            }
        }
        (Column::Output { output, change }, Column::Output { change: after, .. }) => {
            Column::Output {
                output,
                change: slope(&change, &after),
            }
        }
        _ => return None,
    })
}

/// Columns of all sizes of an effect at a shape, as functions of time: also of a step, whose onset may
/// lie within a step of the record. `None` of effects without such functions.
pub(crate) fn profiles(
    plant: &Plant,
    effect: &Effect,
    shape: f64,
    rows: &Rows,
) -> Option<Vec<Column>> {
    let own = effect.shape()?;
    effect
        .sizes()
        .map(|size| profile(plant, effect, size, (own, shape), rows))
        .collect()
}

/// The function of time of a size at a shape, as a column.
fn profile(
    plant: &Plant,
    effect: &Effect,
    size: &EffectParameter,
    (own, value): (&EffectParameter, f64),
    rows: &Rows,
) -> Option<Column> {
    let mut shapes = vec![1.0; plant.shapes.len()];
    *shapes.get_mut(own.role.shape_index()?)? = value;
    let weight = size.weight?;
    match effect.enters {
        Enters::Rates(&[rate]) => Some(Column::TimeProfile {
            parameter: plant.rates.get(rate)?.constant,
            steps: rows.step_weights(plant, weight, &shapes),
        }),
        Enters::Outputs(&[output]) => Some(Column::Output {
            output,
            change: rows.row_weights(plant, weight, &shapes),
        }),
        _ => None,
    }
}

/// The row before the step that a jump at an onset falls into.
fn jump_row(rows: &Rows, onset_s: f64) -> usize {
    let last = rows.len().saturating_sub(2);
    rows.rows_before(onset_s).saturating_sub(1).min(last)
}

/// Scale of the columns of an effect: unit of its columns over the unit of its sizes.
#[must_use]
pub fn scale(effect: &Effect) -> f64 {
    effect.parameters.first().map_or(1.0, |size| size.scale)
}
