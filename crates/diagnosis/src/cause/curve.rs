//! Drifts and readings that depend on specific force as no polynomial of the catalogue does: dead
//! zones, friction, hysteresis about zero. Tried as piecewise linear functions of each component,
//! with its sign.

use std::sync::Arc;

use gyrocal_calibration::{BIASES, CalibrationError, Column, Extended};
use gyrocal_record::Record;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::bank::Bank;
use super::unnamed::{Channel, Pattern, Unnamed};

/// Knots of a function, from the least to the largest specific force that the record visits.
const KNOTS: usize = 10;

/// A component that moves by less shows no curve, g.
const LEAST_RANGE_G: f64 = 0.02;

/// Combinations of functions of which a fit leaves less than this share of the best seen one are not
/// tried: constants and low powers, which the coefficients take up.
const SEEN: f64 = 1e-4;

/// The most significant curve beside what a fit holds.
pub(super) fn strongest(
    fitted: &Extended<'_>,
    record: &Record,
) -> Result<Option<Unnamed>, CalibrationError> {
    let force_g = fitted.predicted_g();
    let mut best: Option<Unnamed> = None;
    // One channel after the other: columns of readings are large.
    for channel in Channel::ALL {
        let columns: Vec<(usize, Vec<Column>)> = (0..3)
            .filter_map(|axis| Some((axis, functions(record, &force_g, channel, axis)?)))
            .collect();
        let all: Vec<Column> = columns
            .iter()
            .flat_map(|(_, columns)| columns.iter().cloned())
            .collect();
        if all.is_empty() {
            continue;
        }
        let bank = Bank::beside(fitted, &all)?;
        let mut first = 0;
        for (axis, own) in &columns {
            let places: Vec<usize> = (first..first + own.len()).collect();
            first += own.len();
            let found = spanned(
                &bank,
                &places,
                own,
                (channel, Pattern::Curve { axis: *axis }),
            );
            if let Some(found) = found
                && best
                    .as_ref()
                    .is_none_or(|best| found.ln_probability < best.ln_probability)
            {
                best = Some(found);
            }
        }
    }
    Ok(best)
}

/// The best function of what some columns span.
fn spanned(
    bank: &Bank,
    places: &[usize],
    columns: &[Column],
    which: (Channel, Pattern),
) -> Option<Unnamed> {
    let (information, score) = bank.part(places);
    let scale = DVector::from_iterator(
        places.len(),
        places.iter().map(|place| bank.raw[*place].sqrt().recip()),
    );
    if !scale.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let scaled = DMatrix::from_fn(places.len(), places.len(), |i, j| {
        information[(i, j)] * scale[i] * scale[j]
    });
    let eigen = SymmetricEigen::new(scaled);
    let most = eigen.eigenvalues.max();
    let along = eigen.eigenvectors.tr_mul(&score.component_mul(&scale));
    let mut statistic = 0.0;
    let mut combinations = Vec::new();
    let mut size = 0.0;
    for (index, value) in eigen.eigenvalues.iter().enumerate() {
        if *value <= SEEN * most || *value <= SEEN {
            continue;
        }
        statistic += along[index].powi(2) / value;
        let weights = eigen.eigenvectors.column(index).component_mul(&scale);
        let amplitude = along[index] / value;
        let (combined, mean_square) = combination(columns, &weights)?;
        size += amplitude * amplitude * mean_square;
        combinations.push(combined);
    }
    let degrees_of_freedom = combinations.len();
    if degrees_of_freedom == 0 {
        return None;
    }
    // Of each channel three components are looked at.
    let chances = 3.0 * Channel::ALL.len() as f64;
    Some(Unnamed::new(
        which,
        size.sqrt(),
        (statistic, degrees_of_freedom),
        chances.ln(),
        combinations,
    ))
}

/// A weighted sum of columns of one channel, and its mean square.
fn combination(columns: &[Column], weights: &DVector<f64>) -> Option<(Column, f64)> {
    let values = |column: &Column| -> Option<Arc<[f64]>> {
        match column {
            Column::Course { steps, .. } => Some(Arc::clone(steps)),
            Column::Readings { change_g, .. } => Some(Arc::clone(change_g)),
            _ => None,
        }
    };
    let first = columns.first()?;
    let mut sum = vec![0.0; values(first)?.len()];
    for (column, weight) in columns.iter().zip(weights.iter()) {
        for (sum, value) in sum.iter_mut().zip(values(column)?.iter()) {
            *sum += weight * value;
        }
    }
    let mean_square = sum.iter().map(|value| value * value).sum::<f64>() / sum.len() as f64;
    let sum = sum.into();
    let column = match *first {
        Column::Course { parameter, .. } => Column::Course {
            parameter,
            steps: sum,
        },
        Column::Readings { axis, .. } => Column::Readings {
            axis,
            change_g: sum,
        },
        _ => return None,
    };
    Some((column, mean_square))
}

/// Hat functions of a component and, where it changes its sign, that sign, which they cannot make
/// up: in the middle of each step or at each row.
fn functions(
    record: &Record,
    force_g: &[[f64; 3]],
    channel: Channel,
    axis: usize,
) -> Option<Vec<Column>> {
    let (least, most) = force_g
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, row| {
            (ends.0.min(row[axis]), ends.1.max(row[axis]))
        });
    if record.len() < 2 || most - least < LEAST_RANGE_G {
        return None;
    }
    let spacing = (most - least) / (KNOTS - 1) as f64;
    let hat = |knot: usize, force_g: f64| {
        (1.0 - ((force_g - least) / spacing - knot as f64).abs()).max(0.0)
    };
    let function = |index: usize, force_g: f64| match index {
        KNOTS.. => force_g.signum(),
        knot => hat(knot, force_g),
    };
    let column = |index: usize| match channel {
        Channel::Drift(gyro) => Column::Course {
            parameter: BIASES[gyro],
            steps: force_g
                .windows(2)
                .map(|pair| function(index, 0.5 * (pair[0][axis] + pair[1][axis])))
                .collect(),
        },
        Channel::Readings(output) => Column::Readings {
            axis: output,
            change_g: force_g
                .iter()
                .map(|row| function(index, row[axis]))
                .collect(),
        },
    };
    let switches = least < 0.0 && most > 0.0;
    Some((0..KNOTS + usize::from(switches)).map(column).collect())
}
