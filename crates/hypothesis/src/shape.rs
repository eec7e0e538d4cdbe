//! Onsets and time constants by maximum likelihood.
//!
//! About a fit, the score test of an effect at a shape s is the profile likelihood of the shape: with
//! the sizes of the effect itself taken out of the fit, l(s) of equation (3) is twice the
//! log-likelihood that the effect gains at s, its sizes and all unknowns of the fit free. Shapes are
//! searched on a grid that narrows about the best point; the fit is made again about the new shapes
//! until no likelihood rises any more, so that shapes and sizes of all effects are estimated jointly.

use gyrocal_scalar::effect::Role;
use gyrocal_statistics::math::{exp, ln};

use crate::accepted::{Accepted, value_places};
use crate::bank::{GramProducts, ScoreBank};
use crate::context::SearchContext;
use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::rows::Rows;
use crate::signature::profiles;
use gyrocal_inference::Column;

/// Points of a grid between the neighbours of the best point so far. A pass over the record costs as much
/// as some ten columns, so that few grids with many points are the cheapest.
const POINTS: usize = 21;

/// Grids, each a tenth as wide as the one before: the last resolves a thousandth of the distance
/// between two variants of the search.
const GRIDS: usize = 3;

/// The first of these grids about a shape that was estimated in nearly the same model: a tenth as wide
/// as the distance between two variants.
const NEARBY: usize = 1;

/// Distance from an estimate, over the first grid about it, beyond which the shape may lie outside of that
/// grid: its last points but one.
const AT_THE_END: f64 = 0.9 - 1e-9;

/// Rounds of shapes and fits. Each moves a shape to the maximum of its likelihood given the others;
/// effects that overlap little need two.
const ROUNDS: usize = 6;

/// Rise of twice the log-likelihood below which a shape has converged: it is then within a tenth of
/// its standard deviation of the maximum.
const CONVERGED: f64 = 0.01;

/// Longest time constant over the duration of the record. A longer one is a ramp.
const LONGEST: f64 = 3.0;

/// Shortest time constant in intervals between rows.
const SHORTEST: f64 = 1.0;

/// A shape with the largest statistic of its effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BestShape {
    /// Onset, s, or time constant, h.
    pub(crate) shape: f64,
    /// Statistic of equation (3).
    pub(crate) statistic: f64,
}

/// A scale on which the shapes of an effect are equally spaced: linear for onsets, logarithmic for time
/// constants.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShapeScale {
    is_onset: bool,
    /// Ends of the scale.
    pub(crate) ends: [f64; 2],
}

impl ShapeScale {
    /// The scale of an effect in a record; `None` of an effect without a shape.
    pub(crate) fn of(hypothesis: &Hypothesis, rows: &Rows) -> Option<Self> {
        if hypothesis.is_jump {
            return None;
        }
        let is_onset = matches!(hypothesis.effect.shape()?.role, Role::Onset(_));
        let duration_s = rows.duration_s();
        let ends = if is_onset {
            [0.0, duration_s]
        } else {
            let interval_s = duration_s / rows.len().max(2) as f64;
            [SHORTEST * interval_s, LONGEST * rows.longest_record_s()].map(|s| ln(s / 3600.0))
        };
        Some(Self { is_onset, ends })
    }

    /// Place of a shape on the scale.
    pub(crate) fn place(&self, shape: f64) -> f64 {
        if self.is_onset { shape } else { ln(shape) }
    }

    /// Shape at a place.
    pub(crate) fn shape(&self, place: f64) -> f64 {
        let [low, high] = self.ends;
        let place = place.clamp(low, high);
        if self.is_onset { place } else { exp(place) }
    }
}

/// The statistics of an effect at some shapes.
pub(crate) struct ShapeProfile {
    /// The shapes.
    pub(crate) shapes: Vec<f64>,
    /// Columns of each in the bank.
    pub(crate) columns: Vec<Vec<usize>>,
    /// Scores and information, all unknowns of the fit projected out but the sizes of the effect.
    pub(crate) bank: ScoreBank,
}

impl ShapeProfile {
    /// Of a hypothesis in a fit: `absent` are the places of its own sizes among the values of the fit,
    /// and `free` are columns of further unknowns.
    pub(crate) fn new<F: FittedModel>(
        fitted: &F,
        context: &SearchContext<'_>,
        hypothesis: &Hypothesis,
        shapes: Vec<f64>,
        (absent, free): (&[usize], &[Column]),
    ) -> Result<Self, F::Error> {
        let mut columns = Vec::with_capacity(shapes.len());
        let mut all: Vec<Column> = Vec::new();
        for shape in &shapes {
            let own = profiles(context.plant, hypothesis.effect, *shape, &context.rows);
            let own = own.unwrap_or_default();
            columns.push((all.len()..all.len() + own.len()).collect());
            all.extend(own);
        }
        let bank = GramProducts::conditional(fitted, free, &all)?.bank(absent)?;
        Ok(Self {
            shapes,
            columns,
            bank,
        })
    }

    /// The statistic at each shape; zero where nothing of it can be seen.
    pub(crate) fn statistics(&self) -> Vec<f64> {
        let statistic = |columns: &Vec<usize>| {
            let joint = self.bank.joint(columns);
            joint.map_or(0.0, |joint| joint.statistic)
        };
        self.columns.iter().map(statistic).collect()
    }

    /// The best shape.
    pub(crate) fn best(&self) -> Option<BestShape> {
        let all = self.shapes.iter().zip(self.statistics());
        all.map(|(shape, statistic)| BestShape {
            shape: *shape,
            statistic,
        })
        .max_by(|a, b| a.statistic.total_cmp(&b.statistic))
    }
}

/// Where a shape is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum About {
    /// Between the neighbours of a variant.
    Variant,
    /// Near an estimate.
    Estimate,
}

/// The best shape of a hypothesis and how much it gains.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundShape {
    pub(crate) best: BestShape,
    /// Its statistic less that of the shape from which it was looked for.
    pub(crate) gain: f64,
}

/// The best shape of a hypothesis about one of its variants or about an estimate, by grids that narrow.
pub(crate) fn best_shape<F: FittedModel>(
    fitted: &F,
    context: &SearchContext<'_>,
    hypothesis: &Hypothesis,
    (start, about): (f64, About),
    absent: &[usize],
) -> Result<Option<FoundShape>, F::Error> {
    let Some(scale) = ShapeScale::of(hypothesis, &context.rows) else {
        return Ok(None);
    };
    let mut places: Vec<f64> = hypothesis
        .variants
        .iter()
        .filter_map(|variant| variant.shape)
        .map(|shape| scale.place(shape))
        .collect();
    places.sort_unstable_by(f64::total_cmp);
    let mut width = places
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .fold(0.0, f64::max);
    if width <= 0.0 {
        return Ok(None);
    }
    let narrower = 2.0 / (POINTS - 1) as f64;
    let mut grids = GRIDS;
    if about == About::Estimate {
        grids -= NEARBY;
        width *= narrower.powi(NEARBY as i32);
    }
    // The first grid holds the shape of the start as well.
    let mut shapes = grid(&scale, scale.place(start), width);
    shapes.push(start);
    let profile = ShapeProfile::new(fitted, context, hypothesis, shapes, (absent, &[]))?;
    let before = profile.statistics().last().copied().unwrap_or_default();
    let Some(mut best) = profile.best() else {
        return Ok(None);
    };
    let moved = (scale.place(best.shape) - scale.place(start)).abs();
    if about == About::Estimate && moved >= AT_THE_END * width {
        let again = (best.shape, About::Variant);
        let found = best_shape(fitted, context, hypothesis, again, absent)?;
        return Ok(found.map(|found| FoundShape {
            gain: found.best.statistic - before,
            ..found
        }));
    }
    for _ in 1..grids {
        width *= narrower;
        let shapes = grid(&scale, scale.place(best.shape), width);
        let profile = ShapeProfile::new(fitted, context, hypothesis, shapes, (absent, &[]))?;
        if let Some(found) = profile.best()
            && found.statistic > best.statistic
        {
            best = found;
        }
    }
    Ok(best.statistic.is_finite().then_some(FoundShape {
        best,
        gain: best.statistic - before,
    }))
}

/// Shapes within a width on both sides of a place.
fn grid(scale: &ShapeScale, centre: f64, width: f64) -> Vec<f64> {
    let half = (POINTS / 2) as f64;
    let mut shapes: Vec<f64> = (0..POINTS)
        .map(|index| scale.shape(centre + width * (index as f64 / half - 1.0)))
        .collect();
    shapes.dedup();
    shapes
}

/// Moves the shapes of all accepted effects to the maximum of the likelihood, and fits again, until
/// none gains; first where `about` says, then near the shapes found.
pub(crate) fn estimate_shapes<F: FittedModel>(
    context: &SearchContext<'_>,
    fitted: F,
    about: About,
    accepted: &mut [Accepted],
    refit: impl Fn(&F, &[Accepted]) -> Result<F, F::Error>,
) -> Result<F, F::Error> {
    let mut fitted = fitted;
    let mut about = about;
    for _ in 0..ROUNDS {
        let mut moved = false;
        for index in 0..accepted.len() {
            let hypothesis = &context.set.hypotheses[accepted[index].hypothesis];
            if context.budget.is_spent(fitted.work()) {
                break;
            }
            let Some(now) = accepted[index].shape else {
                continue;
            };
            if ShapeScale::of(hypothesis, &context.rows).is_none() {
                continue;
            }
            let absent = value_places(&fitted, hypothesis);
            let Some(found) = best_shape(&fitted, context, hypothesis, (now, about), &absent)?
            else {
                continue;
            };
            if found.gain <= CONVERGED {
                continue;
            }
            let best = found.best;
            let mut next = accepted.to_vec();
            next[index].shape = Some(best.shape);
            // A shape that cannot be fitted leaves the one before.
            if let Ok(refitted) = refit(&fitted, &next)
                && refitted.cost() < fitted.cost()
            {
                fitted = refitted;
                accepted[index].shape = Some(best.shape);
                moved = true;
            }
        }
        if !moved {
            break;
        }
        about = About::Estimate;
    }
    Ok(fitted)
}
