//! How small an effect a record could show.

use gyrocal::EffectRow;
use gyrocal::generated::catalogue::{EFFECTS, PARAMETERS};
use gyrocal_calibration::{BIASES, CalibrationError, Column, Extended};
use gyrocal_record::Record;
use nalgebra::DMatrix;

use super::bank::Bank;
use super::family::{KNOCK, axis_of, jump, parameter, warm_up};

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
    let Some((further, columns)) = columns(row, record, shape) else {
        return Ok(None);
    };
    let bank = Bank::new(fitted, &further)?;
    if columns.is_empty() || !columns.iter().all(|column| bank.visible(*column)) {
        return Ok(None);
    }
    // Attitudes are columns in radians.
    let scale = if row.kind == "state" {
        core::f64::consts::PI / 180.0
    } else {
        1.0
    };
    Ok(Some(DMatrix::from_fn(
        columns.len(),
        columns.len(),
        |i, j| scale * scale * bank.information[(columns[i], columns[j])],
    )))
}

fn columns(
    row: &EffectRow,
    record: &Record,
    shape: Option<f64>,
) -> Option<(Vec<Column>, Vec<usize>)> {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let row_at = |time_s: f64| {
        record
            .time_s
            .partition_point(|t| t - first_s < time_s)
            .min(record.len().saturating_sub(2))
    };
    let base = PARAMETERS.len();
    let further = match (row.id, shape, axis_of(row.id)) {
        ("platform.initial_attitude", ..) => [0, 1, 2].map(|axis| Column::Start { axis }).to_vec(),
        (KNOCK, Some(onset_s), _) => jump(record, onset_s).to_vec(),
        (id, Some(onset_s), Some(axis)) if id.ends_with(".step") => vec![Column::Onset {
            parameter: BIASES[axis],
            row: row_at(onset_s),
        }],
        (id, Some(time_constant_h), Some(axis)) if id.ends_with(".warmup") => {
            vec![warm_up(record, BIASES[axis], time_constant_h)]
        }
        _ if row.kind == "term" && row.shapes.is_empty() => {
            let columns = row.states.iter().filter_map(|id| parameter(id)).collect();
            return Some((Vec::new(), columns));
        }
        _ => return None,
    };
    let columns = (base..base + further.len()).collect();
    Some((further, columns))
}
