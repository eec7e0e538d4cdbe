//! State of a search: the model with its accepted effects.

use crate::accepted::{Accepted, ModelTerms};
use crate::context::SearchContext;
use crate::fitted_stage::FittedStage;
use crate::model::FittedModel;
use crate::pattern::Unmodelled;
use crate::rate_noise::{RateNoise, RateNoiseFit};
use crate::shape::{About, estimate_shapes};

/// What a model holds.
pub(crate) fn terms<F>(
    stage: &FittedStage<F>,
    accepted: &[Accepted],
    unmodelled: &[Unmodelled],
) -> ModelTerms {
    let mut hypotheses: Vec<usize> = accepted.iter().map(|own| own.hypothesis).collect();
    hypotheses.sort_unstable();
    ModelTerms {
        hypotheses,
        unmodelled: unmodelled.len(),
        walking: stage.noise.noise.walking(),
    }
}

/// Current model and accepted effects.
#[derive(Clone)]
pub(crate) struct SearchState<F> {
    pub(crate) stage: FittedStage<F>,
    pub(crate) accepted: Vec<Accepted>,
    /// Hypotheses that cannot be fitted beside the accepted ones.
    pub(crate) inseparable: Vec<usize>,
    pub(crate) unmodelled: Vec<Unmodelled>,
    /// Whether unmodelled terms are still looked for.
    pub(crate) seeks_unmodelled: bool,
}

impl<F> SearchState<F> {
    pub(crate) fn new(stage: FittedStage<F>) -> Self {
        Self {
            stage,
            accepted: Vec::new(),
            inseparable: Vec::new(),
            unmodelled: Vec::new(),
            seeks_unmodelled: true,
        }
    }

    /// What it holds.
    pub(crate) fn terms(&self) -> ModelTerms {
        terms(&self.stage, &self.accepted, &self.unmodelled)
    }

    /// Penalties of all effects and unmodelled terms for having been searched for: the search penalty of
    /// each, and but for the first `free` the threshold and a margin.
    pub(crate) fn penalties(&self, threshold: f64, margin: f64, free: usize) -> f64 {
        self.penalties_of(|_| true, threshold, margin, free)
    }

    /// Log-likelihood less half of these penalties.
    pub(crate) fn penalised(&self, threshold: f64, margin: f64, free: usize) -> f64 {
        self.stage.noise.log_likelihood - 0.5 * self.penalties(threshold, margin, free)
    }

    /// The same penalties of the effects that another model lacks.
    pub(crate) fn penalties_beside(
        &self,
        other: &Self,
        threshold: f64,
        margin: f64,
        free: usize,
    ) -> f64 {
        let lacks = |own: &Accepted| {
            let mut others = other.accepted.iter();
            !others.any(|other| other.hypothesis == own.hypothesis)
        };
        self.penalties_of(lacks, threshold, margin, free)
    }

    fn penalties_of(
        &self,
        counts: impl Fn(&Accepted) -> bool,
        threshold: f64,
        margin: f64,
        free: usize,
    ) -> f64 {
        let effects = self.accepted.iter().filter(|accepted| counts(accepted));
        let effects = effects.map(|accepted| accepted.penalty);
        let unmodelled = self.unmodelled.iter();
        let unmodelled = unmodelled.map(|found| found.statistic - found.equivalent());
        let each = effects.chain(unmodelled).enumerate();
        each.map(|(place, penalty)| match place {
            place if place < free => penalty,
            _ => threshold + penalty + margin,
        })
        .sum()
    }
}

impl<F: FittedModel> SearchState<F> {
    /// The same effects in other noise of the rates, with what that changes: shapes, sizes and noise.
    pub(crate) fn in_noise(
        &self,
        context: &SearchContext<'_>,
        noise: &RateNoise,
    ) -> Result<Self, F::Error> {
        let fitted = self.stage.fitted.with_rate_noise(noise)?;
        let mut accepted = self.accepted.clone();
        let start = (fitted, About::Estimate);
        let stage = settled_with_shapes(context, start, &mut accepted, &self.unmodelled)?;
        Ok(Self {
            stage,
            accepted,
            inseparable: self.inseparable.clone(),
            unmodelled: self.unmodelled.clone(),
            seeks_unmodelled: self.seeks_unmodelled,
        })
    }
}

/// Rounds of shapes and noise. An effect that raised the noise by a factor of a hundred needs three.
const ROUNDS: usize = 4;

/// The model with these effects, fitted from another one, with the shapes of all effects and the noise
/// of the rates estimated and with all its signatures.
pub(crate) fn stage<F: FittedModel>(
    context: &SearchContext<'_>,
    from: &F,
    accepted: &mut [Accepted],
    unmodelled: &[Unmodelled],
) -> Result<FittedStage<F>, F::Error> {
    let fitted = context.fitted(from, accepted, unmodelled)?;
    settled_with_shapes(context, (fitted, About::Variant), accepted, unmodelled)
}

/// A fit with these effects, with their shapes and the noise of its rates as the record tells them: in
/// turn, until the noise stays, since shapes and sizes are best in the noise that the effect leaves.
pub(crate) fn settled_with_shapes<F: FittedModel>(
    context: &SearchContext<'_>,
    (fitted, about): (F, About),
    accepted: &mut [Accepted],
    unmodelled: &[Unmodelled],
) -> Result<FittedStage<F>, F::Error> {
    let once = |fitted: F, about: About, accepted: &mut [Accepted]| {
        let refit = |from: &F, accepted: &[Accepted]| context.fitted(from, accepted, unmodelled);
        let fitted = estimate_shapes(context, fitted, about, accepted, refit)?;
        let before = fitted.rate_noise();
        let (fitted, noise) = with_noise(fitted)?;
        let moves_fit = fitted.rate_noise().moves_fit(&before);
        Ok::<_, F::Error>((fitted, noise, moves_fit))
    };
    let mut latest = once(fitted, about, accepted)?;
    for _ in 1..ROUNDS {
        if !latest.2 || context.budget.is_spent(latest.0.work()) {
            break;
        }
        let mut next = accepted.to_vec();
        // Shapes that cannot be estimated once more stay.
        let Ok(again) = once(latest.0.clone(), About::Estimate, &mut next) else {
            break;
        };
        latest = again;
        accepted.clone_from_slice(&next);
    }
    let (fitted, noise, _) = latest;
    FittedStage::new(fitted, noise, &context.set, &context.rows, accepted)
}

/// A fit with the noise of its rates that the record tells.
pub(crate) fn settled<F: FittedModel>(
    context: &SearchContext<'_>,
    fitted: F,
    accepted: &[Accepted],
) -> Result<FittedStage<F>, F::Error> {
    let (fitted, noise) = with_noise(fitted)?;
    FittedStage::new(fitted, noise, &context.set, &context.rows, accepted)
}

/// A fit with the noise of its rates that the record tells, and that noise.
pub(crate) fn with_noise<F: FittedModel>(fitted: F) -> Result<(F, RateNoiseFit), F::Error> {
    let believed = fitted.rate_noise();
    let noise = fitted.fit_rate_noise(&believed.walking(), &[])?;
    let fitted = if noise.noise.differs(&believed) {
        // A mismatch that is no noise cannot always be fitted as noise: the last noise then stands.
        fitted.with_rate_noise(&noise.noise).unwrap_or(fitted)
    } else {
        fitted
    };
    Ok((fitted, noise))
}
