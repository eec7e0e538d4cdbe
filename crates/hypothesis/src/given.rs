//! A model with effects that are given: no search, no test.

use gyrocal_inference::stop;
use gyrocal_scalar::effect::{Effect, EffectKind};

use crate::accepted::Accepted;
use crate::bank::ScoreBank;
use crate::context::{SearchContext, SearchOptions};
use crate::finding::EffectEstimate;
use crate::fitted_stage::FittedStage;
use crate::hypothesis::{Hypothesis, Selection};
use crate::jump::best_jump;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::result::parameters_of;
use crate::rows::Rows;
use crate::shape::About;
use crate::shape_estimates::ShapeEstimates;
use crate::state::{settled, settled_with_shapes, stage};

/// A model with given effects, fitted with the noise that it leaves.
pub struct FittedWith<F> {
    /// The nominal model, fitted with the noise that it leaves.
    pub nominal: F,
    /// The model with all effects.
    pub fitted: F,
    /// The effects in the order given, each with the estimates of its parameters.
    pub effects: Vec<(&'static str, Vec<EffectEstimate>)>,
    /// Log-likelihood that the effects gain, the noise estimated with and without them, nats: restricted,
    /// the nominal parameters integrated out.
    pub gained_nats: f64,
}

/// Fits the effects of a selection together; onsets and time constants are estimated with all sizes, and
/// random walks are noise.
///
/// # Errors
/// Those of [`FittedModel::refitted`] and of passes over the record, among them that the record does not
/// determine an effect beside the others.
pub fn fit_with<F: FittedModel>(
    nominal: F,
    rows: Rows,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<FittedWith<F>, F::Error> {
    let context = SearchContext::new(&nominal, rows, selection, options);
    let nominal = settled(&context, nominal, &[])?;
    let mut own = nominal.clone();
    let mut accepted: Vec<Accepted> = Vec::new();
    for (index, hypothesis) in context.set.hypotheses.iter().enumerate() {
        accepted.push(Accepted {
            hypothesis: index,
            shape: first_shape(&context, &own, hypothesis)?,
            detection: None,
            searched: 0.0,
            penalty: 0.0,
        });
        own = stage(&context, &own.fitted, &mut accepted, &[])?;
    }
    let walking: Vec<usize> = context
        .walks
        .iter()
        .filter_map(|walk| walk.rate())
        .collect();
    if !walking.is_empty() {
        let noise = own.fitted.fit_rate_noise(&walking, &[])?.noise;
        let fitted = own.fitted.with_rate_noise(&noise)?;
        own = settled_with_shapes(&context, (fitted, About::Estimate), &mut accepted, &[])?;
    }
    let shapes = ShapeEstimates::new(&own, &context, &accepted);
    let mut draws = GaussianDraws::new(options.seed);
    let mut effects = Vec::with_capacity(selection.effects.len());
    for effect in &selection.effects {
        let place = context.set.index_of(effect.id);
        let estimates = match place.filter(|_| effect.kind != EffectKind::RandomWalk) {
            Some(index) => {
                let mut estimates = parameters_of(&own, &context.set, &accepted, index);
                shapes.add_to(&mut estimates, index, &mut draws)?;
                estimates
            }
            None => walk_estimates(&own, effect)?,
        };
        effects.push((effect.id, estimates));
    }
    stop::check()?;
    Ok(FittedWith {
        gained_nats: own.noise.log_likelihood - nominal.noise.log_likelihood,
        nominal: nominal.fitted,
        fitted: own.fitted,
        effects,
    })
}

/// The onset or time constant that a fit starts from: that of the largest score statistic.
fn first_shape<F: FittedModel>(
    context: &SearchContext<'_>,
    own: &FittedStage<F>,
    hypothesis: &Hypothesis,
) -> Result<Option<f64>, F::Error> {
    if hypothesis.is_jump {
        let jump = best_jump(&own.fitted.state_jumps()?, &context.rows);
        return Ok(jump.map(|jump| jump.onset_s));
    }
    let statistic = |columns: &[usize], bank: &ScoreBank| {
        bank.joint(columns).map_or(0.0, |joint| joint.statistic)
    };
    let best = hypothesis.variants.iter().max_by(|a, b| {
        let [a, b] = [a, b].map(|variant| statistic(&variant.columns, &own.bank));
        a.total_cmp(&b)
    });
    Ok(best.and_then(|best| best.shape))
}

/// Size of a random walk with its interval.
fn walk_estimates<F: FittedModel>(
    own: &FittedStage<F>,
    effect: &'static Effect,
) -> Result<Vec<EffectEstimate>, F::Error> {
    let intervals = own.fitted.walk_intervals()?;
    let Some(rate) = effect.rate() else {
        return Ok(Vec::new());
    };
    let size = effect.parameters.iter().map(|parameter| EffectEstimate {
        name: parameter.name,
        estimate: own.noise.noise.walk[rate],
        sigma: None,
        interval: intervals
            .get(rate)
            .copied()
            .flatten()
            .map(|ends| vec![ends]),
        unit: parameter.unit,
    });
    Ok(size.collect())
}
