//! Detected effects.

use serde::{Deserialize, Serialize};

use super::SizesByRecord;

/// One detected effect: estimates, significance, alternatives and exact equivalents.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Finding {
    /// Id of the effect; of exact equivalents the first of the catalogue.
    pub effect: String,
    /// Its physical name.
    pub name: String,
    /// Test that detected it.
    pub kind: FindingKind,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its statistic in standard deviations; negative where noise is smaller than declared.
    pub z: f64,
    /// Family-wise p-value: probability of as large a statistic anywhere in the search by chance.
    pub p_value: f64,
    /// Coverage of the confidence set: share of sets that held the cause, as measured of causes of that kind
    /// (of a set with several kinds the least). `None` where it was not measured: of findings below seven
    /// sigma, of noise, of random walks and of a filter.
    pub coverage: Option<f64>,
    /// The same as `alternatives`, under the name that schema version 1 gave it.
    pub rivals: Vec<Alternative>,
    /// The other members of the confidence set, nearest first.
    pub alternatives: Vec<Alternative>,
    /// Probability that a cause outside of the catalogue leaves eight standard deviations or more beside
    /// what is named, at prior odds of one to one; `None` where it was not estimated.
    pub none_of_these: Option<f64>,
    /// Natural logarithm of the likelihood of such a cause over that of the named effect and its set
    /// \[nats\]; `None` where it was not estimated.
    #[serde(default)]
    pub none_of_these_log_likelihood_ratio: Option<f64>,
    /// Sizes in each of several records; `None` of one record, of noise, and of an effect that lies in one
    /// record by its nature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_record: Option<SizesByRecord>,
    /// Exact equivalents: effects that no record can distinguish from it.
    pub equivalents: Vec<Equivalent>,
    /// Gain in the log score of cross-validation with the effect in the model, given the other
    /// causes \[nats\]; `None` of noise and of a filter, and where it was not judged: of one of many causes
    /// of a record that takes too much work.
    pub gain_nats: Option<f64>,
    /// Whether it is in the extended model: whether that gain is positive. `None` as above.
    pub accepted: Option<bool>,
}

/// Test that detected an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FindingKind {
    /// The noise audit, or the likelihood of the gyro noise.
    Noise,
    /// The search over the catalogue: a term of the model, or a random walk of a drift.
    Cause,
    /// The consistency test of a filter.
    Filter,
}

/// One parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Parameter {
    /// Its name: `size`, `onset_s`, `time_constant_h`, `sine`, `cosine`, `ratio`, `fraction`, ….
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation; `None` where the likelihood is not quadratic, as of the size of a
    /// random walk and of the onset of an attitude jump.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset, of a time constant or of the size of a random walk: ranges, as its
    /// profile may be in pieces. `None` of other parameters, and where it was not computed.
    pub interval: Option<Vec<[f64; 2]>>,
    /// The unit; `1` of plain numbers.
    pub unit: String,
}

/// A member of a confidence set that is not the reported effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alternative {
    /// Id of the effect.
    pub effect: String,
    /// Log-likelihood of the reported effect less that of this one, after both are penalised for their
    /// searches, and an effect in which the reported one is nested for its freedom; never negative.
    pub log_likelihood_deficit: f64,
}

/// An effect that no record can distinguish from the reported one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Equivalent {
    /// Id of the effect.
    pub effect: String,
    /// Values that its parameters would have to have.
    pub parameters: Vec<Parameter>,
}
