//! Onsets and time constants between those of the families.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{CalibrationError, Column, Extended};
use gyrocal_record::Record;

use super::bank::Bank;
use super::family::{Plan, warm_up};
use super::score::Best;

/// Onsets and time constants are refined on so many points between the neighbours of the best.
const REFINED: usize = 9;

/// The onset or time constant of the best candidate, on a finer grid between its neighbours.
pub(super) fn refined(
    fitted: &Extended<'_>,
    record: &Record,
    plan: &Plan,
    best: &Best,
) -> Result<Option<f64>, CalibrationError> {
    let family = &plan.families[best.family];
    if family.walk.is_some() || family.knock {
        return Ok(Some(best.shape));
    }
    let candidates = &plan.families[best.family].candidates;
    let candidate = &candidates[best.candidate];
    let Some(shape) = candidate.shape else {
        return Ok(None);
    };
    let neighbour = |offset: isize| {
        best.candidate
            .checked_add_signed(offset)
            .and_then(|index| candidates.get(index))
            .and_then(|candidate| candidate.shape)
            .unwrap_or(shape)
    };
    let (low, high) = (neighbour(-1), neighbour(1));
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let Some(column) = candidate.columns.first() else {
        return Ok(Some(shape));
    };
    let around = &plan.further[column - PARAMETERS.len()];
    let mut shapes = Vec::with_capacity(REFINED);
    let mut columns = Vec::with_capacity(REFINED);
    for index in 0..REFINED {
        let share = index as f64 / (REFINED - 1) as f64;
        match around {
            Column::Onset { parameter, .. } => {
                let time_s = low + share * (high - low);
                let row = record.time_s.partition_point(|t| t - first_s < time_s);
                shapes.push(record.time_s[row.min(record.len() - 1)] - first_s);
                columns.push(Column::Onset {
                    parameter: *parameter,
                    row,
                });
            }
            Column::Course { parameter, .. } => {
                let time_constant_h = low * (high / low).powf(share);
                shapes.push(time_constant_h);
                columns.push(warm_up(record, *parameter, time_constant_h));
            }
            _ => return Ok(Some(shape)),
        }
    }
    let bank = Bank::beside(fitted, &columns)?;
    let finest = (0..columns.len())
        .filter_map(|index| {
            let joint = bank.joint(&[index])?;
            Some((shapes[index], joint.statistic))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1));
    Ok(Some(finest.map_or(shape, |(shape, _)| shape)))
}
