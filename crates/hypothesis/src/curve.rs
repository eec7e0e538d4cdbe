//! Curves: rates and outputs that depend on a covariate as no polynomial of the catalogue does, such
//! as dead zones, friction and hysteresis about zero. They are piecewise linear functions of each
//! covariate, with its sign.

use std::sync::Arc;

use gyrocal_scalar::effect::Enters;
use gyrocal_statistics::math::ln;
use nalgebra::DVector;

use crate::bank::{Principal, ScoreBank};
use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::pattern::{ChannelIndex, Pattern, Unmodelled};
use crate::plant::Plant;
use crate::rows::{Covariate, Rows};
use gyrocal_inference::Column;

/// Knots of a function, from the least to the largest value of the covariate in the record.
const KNOTS: usize = 10;

/// Combinations of functions of which a fit leaves less than this share of the best seen one are not
/// tried: constants and low powers, which the coefficients take up.
const SEEN: f64 = 1e-4;

/// The most significant curve, the unknowns of the fit free.
pub(crate) fn strongest<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
) -> Result<Option<Unmodelled>, F::Error> {
    let plant = fitted.plant();
    let covariates = fitted.covariates();
    let channels = ChannelIndex::all(plant);
    // Every covariate is tested in each channel.
    let ln_tests = ln((covariates.len() * channels.len()) as f64);
    let mut best: Option<Unmodelled> = None;
    // One channel after the other: columns of outputs are large.
    for channel in channels {
        let columns: Vec<(Pattern, Vec<Column>)> = covariates
            .iter()
            .enumerate()
            .filter_map(|(index, covariate)| {
                let pattern = Pattern::Curve {
                    covariate: index,
                    name: covariate.name,
                };
                Some((pattern, functions(plant, rows, covariate, channel)?))
            })
            .collect();
        let all: Vec<Column> = columns
            .iter()
            .flat_map(|(_, columns)| columns.iter().cloned())
            .collect();
        if all.is_empty() {
            continue;
        }
        let bank = ScoreBank::conditional(fitted, &all)?;
        let mut first = 0;
        for (pattern, own) in &columns {
            let places: Vec<usize> = (first..first + own.len()).collect();
            first += own.len();
            let found = spanned(plant, &bank, &places, own, (channel, *pattern), ln_tests);
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

/// Share that is left to a curve of what it and all effects without a shape explain together, those of rates
/// beside a curve in a rate and those of outputs beside one in an output. Several of these look like a curve
/// before all are in the model.
pub(crate) fn share_beside_effects<F: FittedModel>(
    fitted: &F,
    hypotheses: &[Hypothesis],
    curve: &Unmodelled,
) -> Result<f64, F::Error> {
    let parameters = fitted.plant().parameters.len();
    let bank = ScoreBank::new(fitted, &curve.columns)?;
    let enters = |one: &&Hypothesis| {
        matches!(
            (one.effect.enters, curve.channel),
            (Enters::Rates(_), ChannelIndex::Rate(_))
                | (Enters::Outputs(_), ChannelIndex::Output(_))
        )
    };
    let own = hypotheses.iter().filter(enters);
    let own = own.filter(|one| one.effect.shape().is_none() && !one.is_jump);
    let columns = own.flat_map(|one| one.variants.iter().flat_map(|variant| &variant.columns));
    let mut columns: Vec<usize> = columns.copied().filter(|at| *at < parameters).collect();
    columns.sort_unstable();
    columns.dedup();
    let effects = bank.explained(&columns);
    columns.extend(parameters..parameters + curve.columns.len());
    let together = bank.explained(&columns);
    Ok(1.0 - effects / together)
}

/// The best function of what some columns span.
fn spanned(
    plant: &Plant,
    bank: &ScoreBank,
    places: &[usize],
    columns: &[Column],
    which: (ChannelIndex, Pattern),
    ln_tests: f64,
) -> Option<Unmodelled> {
    let Principal {
        eigen,
        along,
        scale,
    } = bank.principal(places)?;
    let most = eigen.eigenvalues.max();
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
    Some(Unmodelled::new(
        plant,
        which,
        size.sqrt(),
        (statistic, degrees_of_freedom),
        ln_tests,
        combinations,
    ))
}

/// A weighted sum of columns of one channel, and its mean square.
fn combination(columns: &[Column], weights: &DVector<f64>) -> Option<(Column, f64)> {
    let values = |column: &Column| -> Option<Arc<[f64]>> {
        match column {
            Column::TimeProfile { steps, .. } => Some(Arc::clone(steps)),
            Column::Output { change, .. } => Some(Arc::clone(change)),
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
        Column::TimeProfile { parameter, .. } => Column::TimeProfile {
            parameter,
            steps: sum,
        },
        Column::Output { output, .. } => Column::Output {
            output,
            change: sum,
        },
        _ => return None,
    };
    Some((column, mean_square))
}

/// Hat functions of a covariate and, where it changes its sign, that sign, which they cannot form:
/// in the middle of each step or at each row.
fn functions(
    plant: &Plant,
    rows: &Rows,
    covariate: &Covariate,
    channel: ChannelIndex,
) -> Option<Vec<Column>> {
    let values = &covariate.values;
    let (least, most) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |ends, value| {
            (ends.0.min(*value), ends.1.max(*value))
        });
    if rows.len() < 2 || most - least < covariate.least_range {
        return None;
    }
    let spacing = (most - least) / (KNOTS - 1) as f64;
    let hat =
        |knot: usize, value: f64| (1.0 - ((value - least) / spacing - knot as f64).abs()).max(0.0);
    let function = |index: usize, value: f64| match index {
        KNOTS.. => value.signum(),
        knot => hat(knot, value),
    };
    let column = |index: usize| match channel {
        ChannelIndex::Rate(rate) => Column::TimeProfile {
            parameter: plant.rates[rate].constant,
            steps: values
                .windows(2)
                .map(|pair| function(index, 0.5 * (pair[0] + pair[1])))
                .collect(),
        },
        ChannelIndex::Output(output) => Column::Output {
            output,
            change: values.iter().map(|value| function(index, *value)).collect(),
        },
    };
    let switches = least < 0.0 && most > 0.0;
    Some((0..KNOTS + usize::from(switches)).map(column).collect())
}
