//! Onsets and time constants between those of the grid.

use gyrocal_scalar::effect::Role;
use gyrocal_statistics::math::pow;

use crate::bank::ScoreBank;
use crate::column::Column;
use crate::context::SearchContext;
use crate::model::FittedModel;
use crate::score::Best;
use crate::signature::{Source, signature};

/// Points of the finer grid between the neighbours of the best variant.
const POINTS: usize = 9;

/// The shape of the best variant, refined on a finer grid between its neighbours.
pub(crate) fn refine_shape<F: FittedModel>(
    fitted: &F,
    context: &SearchContext<'_>,
    best: &Best,
) -> Result<Option<f64>, F::Error> {
    let hypothesis = &context.set.hypotheses[best.hypothesis];
    if hypothesis.walk.is_some() || hypothesis.is_jump {
        return Ok(Some(best.shape));
    }
    let variants = &hypothesis.variants;
    let Some(shape) = variants[best.variant].shape else {
        return Ok(None);
    };
    let neighbour = |offset: isize| {
        best.variant
            .checked_add_signed(offset)
            .and_then(|index| variants.get(index))
            .and_then(|variant| variant.shape)
            .unwrap_or(shape)
    };
    let (low, high) = (neighbour(-1), neighbour(1));
    let (effect, rows) = (hypothesis.effect, &context.rows);
    let is_onset = matches!(effect.shape().map(|own| own.role), Some(Role::Onset(_)));
    let mut points: Vec<f64> = Vec::with_capacity(POINTS);
    let mut columns: Vec<Column> = Vec::with_capacity(POINTS);
    let mut widths: Vec<usize> = Vec::with_capacity(POINTS);
    for index in 0..POINTS {
        let share = index as f64 / (POINTS - 1) as f64;
        let point = if is_onset {
            let row = rows.rows_before(low + share * (high - low));
            rows.since_first_s(row.min(rows.len() - 1))
        } else {
            low * pow(high / low, share)
        };
        let sources = signature(context.plant, effect, Some(point), rows).unwrap_or_default();
        let own = sources.into_iter().filter_map(|source| match source {
            Source::Column(column) => Some(column),
            Source::Parameter(_) => None,
        });
        let before = columns.len();
        columns.extend(own);
        points.push(point);
        widths.push(columns.len() - before);
    }
    let bank = ScoreBank::conditional(fitted, &columns)?;
    let mut first = 0;
    let mut finest: Option<(f64, f64)> = None;
    for (point, width) in points.into_iter().zip(widths) {
        let own: Vec<usize> = (first..first + width).collect();
        first += width;
        if let Some(joint) = bank.joint(&own)
            && finest.is_none_or(|(_, most)| joint.statistic >= most)
        {
            finest = Some((point, joint.statistic));
        }
    }
    Ok(Some(finest.map_or(shape, |(point, _)| point)))
}
