//! How small an effect a record could show.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS, RATES};
use gyrocal_calibration::{CalibrationError, Column, Extended};
use gyrocal_record::Record;
use nalgebra::DMatrix;

use super::bank::Bank;
use super::family::{jump, warm_up};

/// Information of a record on the sizes of an effect, after all that a fit takes up is projected
/// out, in the units of the effect's table: the inverse is the Cramér-Rao bound. `shape` is the
/// onset in s or the time constant in h, for effects that have one. `None` for effects without a
/// signature, and where the record says nothing.
///
/// # Errors
/// As [`Extended::signatures`].
pub fn information(
    fitted: &Extended<'_>,
    record: &Record,
    effect: &str,
    shape: Option<f64>,
) -> Result<Option<DMatrix<f64>>, CalibrationError> {
    let Some(row) = EFFECTS.iter().find(|row| row.id == effect) else {
        return Ok(None);
    };
    Ok(informations(fitted, record, &[(row, shape)])?
        .pop()
        .flatten())
}

/// Cramér-Rao bounds of the first sizes of several effects, each with its shape: their standard
/// deviations. All come from one pass over the record.
///
/// # Errors
/// As [`Extended::signatures`].
pub(crate) fn bounds(
    fitted: &Extended<'_>,
    record: &Record,
    effects: &[(&Effect, Option<f64>)],
) -> Result<Vec<Option<f64>>, CalibrationError> {
    let bound = |information: DMatrix<f64>| {
        let sigma = information.try_inverse()?[(0, 0)].sqrt();
        sigma.is_finite().then_some(sigma)
    };
    let informations = informations(fitted, record, effects)?;
    Ok(informations.into_iter().map(|i| bound(i?)).collect())
}

fn informations(
    fitted: &Extended<'_>,
    record: &Record,
    effects: &[(&Effect, Option<f64>)],
) -> Result<Vec<Option<DMatrix<f64>>>, CalibrationError> {
    let mut further = Vec::new();
    let places: Vec<Option<Vec<usize>>> = effects
        .iter()
        .map(|(row, shape)| {
            let (own, mut columns) = columns(row, record, *shape)?;
            if !own.is_empty() {
                columns
                    .iter_mut()
                    .for_each(|column| *column += further.len());
            }
            further.extend(own);
            Some(columns)
        })
        .collect();
    let bank = Bank::new(fitted, &further)?;
    let of = |row: &Effect, columns: Vec<usize>| {
        if columns.is_empty() || !columns.iter().all(|column| bank.visible(*column)) {
            return None;
        }
        let scale = row.parameters.first().map_or(1.0, |size| size.scale);
        Some(DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            scale * scale * bank.information[(columns[i], columns[j])]
        }))
    };
    let all = effects.iter().zip(places);
    Ok(all.map(|((row, _), columns)| of(row, columns?)).collect())
}

/// Columns of an effect beside the parameters of the catalogue, and where they are if these are the
/// first further ones.
fn columns(row: &Effect, record: &Record, shape: Option<f64>) -> Option<(Vec<Column>, Vec<usize>)> {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let row_at = |time_s: f64| {
        record
            .time_s
            .partition_point(|t| t - first_s < time_s)
            .min(record.len().saturating_sub(2))
    };
    let base = PARAMETERS.len();
    let further = match (row.kind, shape, row.rate()) {
        (EffectKind::InitialState, ..) => [0, 1, 2].map(|axis| Column::Start { axis }).to_vec(),
        (EffectKind::StateJump, Some(onset_s), _) => jump(record, onset_s).to_vec(),
        (EffectKind::Step, Some(onset_s), Some(axis)) => vec![Column::Onset {
            parameter: RATES[axis].constant,
            row: row_at(onset_s),
        }],
        (EffectKind::Exponential, Some(time_constant_h), Some(axis)) => {
            vec![warm_up(record, RATES[axis].constant, time_constant_h)]
        }
        _ if row.has_term() && row.shape().is_none() => {
            return Some((Vec::new(), row.model_parameters().collect()));
        }
        _ => return None,
    };
    let columns = (base..base + further.len()).collect();
    Some((further, columns))
}
