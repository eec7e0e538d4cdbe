//! Intervals of the onsets and time constants of the effects of a model, and the standard deviations of their
//! sizes, over the noise that is left where all of these are unknown.

use crate::accepted::Accepted;
use crate::context::SearchContext;
use crate::finding::EffectEstimate;
use crate::fitted_stage::FittedStage;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::shape::ShapeScale;
use crate::shape_interval::shape_interval;
use crate::signature::shape_derivative;
use gyrocal_inference::Column;

/// The effects of a model with the noise that their intervals are over.
pub(crate) struct ShapeEstimates<'a, 'c, F> {
    stage: &'a FittedStage<F>,
    context: &'a SearchContext<'c>,
    accepted: &'a [Accepted],
    /// Derivative of each effect by its shape; `None` of one without a shape that is estimated.
    derivatives: Vec<Option<Column>>,
    noise: ShapeNoise<F>,
}

/// A fit with the noise of intervals.
struct ShapeNoise<F> {
    /// `None`: the fit with the noise that was found with its effects.
    fitted: Option<F>,
    /// Degrees of freedom of the variance of the shape of each effect.
    degrees: Vec<f64>,
}

impl<'a, 'c, F: FittedModel> ShapeEstimates<'a, 'c, F> {
    pub(crate) fn new(
        stage: &'a FittedStage<F>,
        context: &'a SearchContext<'c>,
        accepted: &'a [Accepted],
    ) -> Self {
        let effects = accepted.iter().zip(&stage.places);
        let derivatives: Vec<Option<Column>> = effects
            .map(|(accepted, places)| {
                let size = stage.fitted.values()[*places.values.first()?];
                change_by_shape(context, accepted, size)
            })
            .collect();
        let noise = restricted_noise(&stage.fitted, context, &derivatives).unwrap_or_else(|| {
            // The noise that hides a size hides the shape. Of a model that tells no degrees the noise is known.
            let degrees = stage.fitted.degrees_of_freedom().unwrap_or_default();
            let of_size = |place: Option<&usize>| degrees.get(*place?).copied();
            let effects = stage.places.iter();
            ShapeNoise {
                fitted: None,
                degrees: effects
                    .map(|places| of_size(places.values.first()).unwrap_or(f64::INFINITY))
                    .collect(),
            }
        });
        Self {
            stage,
            context,
            accepted,
            derivatives,
            noise,
        }
    }

    /// Adds the interval of its shape to the estimates of an effect, and the standard deviations of its sizes
    /// with the shape unknown.
    pub(crate) fn add_to(
        &self,
        estimates: &mut [EffectEstimate],
        index: usize,
        draws: &mut GaussianDraws,
    ) -> Result<(), F::Error> {
        let hypothesis = &self.context.set.hypotheses[self.accepted[index].hypothesis];
        let Some(shape) = self.accepted[index].shape else {
            return Ok(());
        };
        let others = self.derivatives.iter().enumerate();
        let others = others.filter(|(other, _)| *other != index);
        let free: Vec<Column> = others
            .filter_map(|(_, derivative)| derivative.clone())
            .collect();
        let absent = &self.stage.places[index].values;
        let fitted = self.noise.fitted.as_ref().unwrap_or(&self.stage.fitted);
        let of = (hypothesis, shape, self.noise.degrees[index]);
        let found = shape_interval(fitted, self.context, of, (absent, &free), draws)?;
        let Some(found) = found else { return Ok(()) };
        let mut sigmas = found.size_sigmas.into_iter();
        let described = estimates.iter_mut().zip(hypothesis.effect.parameters);
        for (estimate, parameter) in described {
            if parameter.role.is_shape() {
                estimate.sigma = found.sigma;
                estimate.interval = Some(found.pieces.clone());
            } else if let Some(sigma) = sigmas.next() {
                estimate.sigma = Some(sigma / parameter.scale);
            }
        }
        Ok(())
    }
}

/// The noise that is left where sizes and shapes are unknown, from a fit that has the derivative of each effect by
/// its shape; the variance of a shape is that of the amplitude of its derivative. An onset of a step is no smooth
/// unknown: it counts as one over a hundredth of the record. `None` if the model estimates no noise, if such a fit
/// fails, or if the search ended before its effects were selected.
fn restricted_noise<F: FittedModel>(
    fitted: &F,
    context: &SearchContext<'_>,
    derivatives: &[Option<Column>],
) -> Option<ShapeNoise<F>> {
    let columns: Vec<Column> = derivatives.iter().flatten().cloned().collect();
    let estimates_noise = !fitted.degrees_of_freedom().ok()?.is_empty();
    if columns.is_empty() || !estimates_noise || context.budget.has_ended_selection() {
        return None;
    }
    let mut extension = fitted.extension().clone();
    let first = fitted.values().len();
    extension.columns.extend(columns, f64::INFINITY);
    let with_shapes = fitted.refitted(&extension).ok()?;
    let noise = with_shapes.restricted_noise().ok()??;
    let of_values = with_shapes.degrees_of_freedom().ok()?;
    let mut of_shapes = of_values.into_iter().skip(first);
    let degrees = derivatives.iter().map(|derivative| {
        let own = derivative.as_ref().and_then(|_| of_shapes.next());
        own.unwrap_or(f64::INFINITY)
    });
    Some(ShapeNoise {
        degrees: degrees.collect(),
        fitted: Some(fitted.with_rate_noise(&noise).ok()?),
    })
}

/// Derivative of the effect of an accepted hypothesis by its shape, over a hundredth of its scale.
fn change_by_shape(context: &SearchContext<'_>, accepted: &Accepted, size: f64) -> Option<Column> {
    let hypothesis = &context.set.hypotheses[accepted.hypothesis];
    let scale = ShapeScale::of(hypothesis, &context.rows)?;
    let place = scale.place(accepted.shape?);
    let width = 0.005 * (scale.ends[1] - scale.ends[0]);
    let between = [scale.shape(place - width), scale.shape(place + width)];
    shape_derivative(
        context.plant,
        hypothesis.effect,
        size,
        between,
        &context.rows,
    )
}
