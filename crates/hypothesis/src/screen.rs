//! The first detection tests of a search, without the search.

use nalgebra::{Cholesky, DMatrix, DVector};

use crate::accepted::{Accepted, value_places};
use crate::context::{SearchContext, SearchOptions};
use crate::fitted_stage::FittedStage;
use crate::forward::WORTH_FITTING;
use crate::hypothesis::{Hypothesis, Selection};
use crate::jump::best_jump;
use crate::model::FittedModel;
use crate::null_distribution::{GaussianDraws, NullDistribution};
use crate::rate_noise::degrees_of_freedom;
use crate::rows::Rows;
use crate::score::Scores;
use crate::state::{settled, stage};
use crate::walk_candidates::Candidates;

/// Outcome of the first detection tests of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screened {
    /// The effect that a search would try first, whether it is significant or not; `None` if the
    /// record cannot show any.
    pub effect: Option<&'static str>,
    /// Root of its statistic: its size in standard deviations.
    pub z: f64,
    /// Family-wise p-value of its test.
    pub p_value: f64,
    /// Whether [`crate::search`] would detect it.
    pub is_significant: bool,
}

impl Screened {
    const NOTHING: Self = Self {
        effect: None,
        z: 0.0,
        p_value: 1.0,
        is_significant: false,
    };
}

/// Tests whether a fitted model lacks an effect of a selection, or a random walk, as the first round of
/// [`crate::search`] does: one bank of scores, and the fit of the one effect that is worth it.
///
/// # Errors
/// Those of [`FittedModel::refitted`] and of passes over the record.
pub fn screen<F: FittedModel>(
    nominal: F,
    rows: Rows,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Screened, F::Error> {
    let context = SearchContext::new(&nominal, rows, selection, options);
    let nominal = settled(&context, nominal, &[])?;
    let effect = of_effects(&context, &nominal)?;
    let walk = of_walks(&context, &nominal)?;
    // The one that a search would report; a walk stands for effects only if it is more probable.
    Ok(match (effect.is_significant, walk.is_significant) {
        (false, true) => walk,
        (true, true) if walk.z > effect.z => walk,
        _ => effect,
    })
}

/// The deterministic effect with the largest statistic.
fn of_effects<F: FittedModel>(
    context: &SearchContext<'_>,
    nominal: &FittedStage<F>,
) -> Result<Screened, F::Error> {
    let hypotheses = &context.set.hypotheses;
    let mut draws = GaussianDraws::new(context.options.seed);
    let null = NullDistribution::draw(&nominal.bank, hypotheses, &mut draws);
    let jump = best_jump(&nominal.fitted.state_jumps()?, &context.rows);
    let mut scores = Scores::of(&nominal.bank, hypotheses, &null, jump)
        .with_estimated_noise(hypotheses, &degrees_of_freedom(&nominal.noise));
    let threshold = null.threshold(context.options.false_alarm_probability);
    let is_worth_fitting = scores.largest() > WORTH_FITTING * threshold;
    if is_worth_fitting {
        scores.refine(&nominal.fitted, context, hypotheses, &[])?;
    }
    let Some(best) = scores.named(hypotheses) else {
        return Ok(Screened::NOTHING);
    };
    let by_score = Screened {
        effect: Some(hypotheses[best.hypothesis].id()),
        z: best.statistic.max(0.0).sqrt(),
        p_value: null.probability(scores.largest()),
        is_significant: false,
    };
    let mut accepted = [Accepted {
        hypothesis: best.hypothesis,
        shape: best.shape(hypotheses),
        detection: None,
        searched: best.searched,
        penalty: best.searched + null.penalties[best.hypothesis],
    }];
    if !is_worth_fitting {
        return Ok(by_score);
    }
    // An effect that cannot be fitted is left to the search.
    let Ok(with) = stage(context, &nominal.fitted, &mut accepted, &[]) else {
        return Ok(by_score);
    };
    // As a search tests it: the likelihood ratio, the noise estimated with and without the effect.
    let gained = 2.0 * (with.noise.log_likelihood - nominal.noise.log_likelihood);
    let tested = gained - best.searched - null.detection_penalties[best.hypothesis];
    Ok(Screened {
        z: strength(&with.fitted, &hypotheses[best.hypothesis]).unwrap_or(by_score.z),
        p_value: null.probability(tested),
        is_significant: tested > threshold,
        ..by_score
    })
}

/// Size of a fitted effect in standard deviations.
fn strength<F: FittedModel>(fitted: &F, hypothesis: &Hypothesis) -> Option<f64> {
    let places = value_places(fitted, hypothesis);
    let values = DVector::from_fn(places.len(), |i, _| fitted.values()[places[i]]);
    let covariance = DMatrix::from_fn(places.len(), places.len(), |i, j| {
        fitted.covariance()[(places[i], places[j])]
    });
    let squares = Cholesky::new(covariance)?.solve(&values).dot(&values);
    (!places.is_empty()).then(|| squares.sqrt())
}

/// Random walks of all rates together.
fn of_walks<F: FittedModel>(
    context: &SearchContext<'_>,
    nominal: &FittedStage<F>,
) -> Result<Screened, F::Error> {
    let Some(candidates) = Candidates::new(context, nominal)? else {
        return Ok(Screened::NOTHING);
    };
    let (gained, p_value) = candidates.test(nominal);
    Ok(Screened {
        effect: candidates.largest(),
        z: gained.max(0.0).sqrt(),
        p_value,
        is_significant: p_value < context.options.walk_probability,
    })
}
