//! A detected effect as it is told: estimates, confidence set, exact equivalents.

use gyrocal_statistics::math::exp;

use crate::bank::NominalEstimate;

/// Deviance of the confidence set: hypotheses whose penalised statistics are within it of the named
/// one belong to the set. Over simulated records with effects of five standard deviations the true
/// one was within 2.8 in 95 %, and within 3.4 in 97 %; `cargo figures diagnosis --part naming` measures the coverage.
pub const CONFIDENCE_SET_DEVIANCE: f64 = 3.5;

/// One estimated parameter of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectEstimate {
    /// Its name: `size`, `onset_s`, `sine`, ….
    pub name: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Its standard deviation: of a size with the shape unknown. `None` for the size of a random walk,
    /// the onset of a jump, and a shape whose likelihood is not symmetric.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset or a time constant, in pieces where its likelihood is.
    pub interval: Option<Vec<[f64; 2]>>,
    /// Unit of all.
    pub unit: &'static str,
}

/// Another member of the confidence set.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Its public id.
    pub effect: &'static str,
    /// Log-likelihood of the named effect less its own, search penalties subtracted, and that of an effect
    /// in which the named one is nested lowered by half of [`NESTED_MODEL_CHI2`](crate::NESTED_MODEL_CHI2), over the
    /// inflation of the model ([`FittedModel::inflation`](crate::FittedModel::inflation)); never negative.
    pub log_likelihood_deficit: f64,
    /// The nominal parameters with it in the place of the named effect; `None` of a jump of states,
    /// and where the search ended before it was fitted.
    pub nominal: Option<NominalEstimate>,
}

/// An effect that no record tells from the named one.
#[derive(Clone, Debug, PartialEq)]
pub struct ExactEquivalent {
    /// Its public id.
    pub effect: &'static str,
    /// Its parameters.
    pub parameters: Vec<EffectEstimate>,
    /// The nominal parameters with it in the place of the named effect: equivalent effects differ by what
    /// the nominal parameters take up.
    pub nominal: Option<NominalEstimate>,
}

/// A detected effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// The effect that is named.
    pub effect: &'static str,
    /// Its parameters.
    pub parameters: Vec<EffectEstimate>,
    /// Root of its statistic: its size in standard deviations.
    pub z: f64,
    /// Family-wise p-value; `None` where the model is not that of its detection.
    pub p_value: Option<f64>,
    /// The rest of the confidence set, nearest first.
    pub alternatives: Vec<Alternative>,
    /// Exact equivalents.
    pub exact_equivalents: Vec<ExactEquivalent>,
    /// Whether the cause is outside of the catalogue; `None` where it was not estimated.
    pub none_of_these: Option<NoneOfThese>,
}

/// A cause outside of the catalogue beside what is named.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoneOfThese {
    /// Likelihood of a smooth function of what moves the platform beside what is named, over that of the
    /// named effect and its set; its natural logarithm, amplitudes integrated out \[nats\].
    pub log_likelihood_ratio: f64,
}

impl NoneOfThese {
    /// Probability that nothing of the catalogue is the cause, the prior odds being one to one.
    #[must_use]
    pub fn probability(&self) -> f64 {
        1.0 / (1.0 + exp(-self.log_likelihood_ratio))
    }
}
