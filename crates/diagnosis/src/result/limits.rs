//! Limits of an answer: effects that are indistinguishable, undetectable or untested.

use serde::{Deserialize, Serialize};

/// A group of effects, or of set-ups, that the record does not distinguish.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Indistinguishable {
    /// Their ids, the reported one first; of set-ups their names, the declared one first.
    pub members: Vec<String>,
    /// Their relation.
    pub relation: Relation,
    /// The relation in words.
    pub why: String,
    /// Members that were not tested and that `--effects` can add to the search.
    pub testable: Vec<String>,
    /// Experiments that would distinguish them.
    pub experiments: Vec<Experiment>,
    /// The experiments in words.
    pub would_separate: String,
}

/// Relation of effects that a record does not distinguish.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Relation {
    /// Exact equivalents: the same samples at any attitude and for ever.
    ExactEquivalents,
    /// Members of one confidence set.
    ConfidenceSet,
    /// Near twins that were not tested.
    NearTwins,
    /// Set-ups that fit every record alike; the members are no effects.
    SetUps,
}

/// An experiment that distinguishes effects.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Experiment {
    /// The kind of experiment.
    pub kind: ExperimentKind,
    /// Quantity to control, change or measure, or what to do; `None` where the kind says it all.
    pub what: Option<String>,
}

/// Kind of an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ExperimentKind {
    /// A second run from another initial attitude.
    OtherAttitude,
    /// A second run from another initial attitude, or started at another time of day.
    OtherStart,
    /// An independent measurement of the attitude at the first row.
    MeasureAttitude,
    /// A run with a logged quantity held or stepped on purpose.
    ControlRegressor,
    /// A run with an input changed on purpose.
    ChangeInput,
    /// An independent measurement of something of the site.
    MeasureInput,
    /// A run that starts long after switching on.
    StartLate,
    /// An experiment in words.
    Other,
}

/// One hypothesis of the first search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RankedEffect {
    /// Id of the effect.
    pub effect: String,
    /// Its largest score statistic (chi-square), penalised for the search over onset or time
    /// constant as the detection test penalises it.
    pub statistic: f64,
}

/// Power of the search for one effect at its typical size.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Power {
    /// Id of the effect.
    pub effect: String,
    /// Size of its first parameter that a sound instrument may have, in `unit`.
    pub typical_size: f64,
    /// Cramér-Rao bound of that parameter with an onset in the middle of the record, or a time
    /// constant of a quarter of it, in `unit`; `None` where the record says nothing of it, and of a
    /// random walk.
    pub sigma: Option<f64>,
    /// Probability that the typical size exceeds the detection threshold; `None` without `sigma`.
    pub power: Option<f64>,
    /// Unit of the size.
    pub unit: String,
}

/// An effect that was not tested, or could not be detected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NotTested {
    /// Id of the effect.
    pub effect: String,
    /// The reason.
    pub reason: NotTestedReason,
    /// The reason in words.
    pub why: String,
}

/// Why an effect was not tested, or could not be detected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NotTestedReason {
    /// It was tested, but the record is too short to show it at its typical size.
    LowPower,
    /// Record or bench file lack something that it needs.
    MissingInput,
    /// It is an error of a filter, and no filter was tested.
    FilterNotAsked,
    /// Correlated noise of the accelerometers hides it.
    HiddenByCorrelation,
    /// The record is too short for a spectrum of its noise.
    NoSpectrum,
    /// It is not in the default search.
    NotDefault,
    /// The fit of the coefficients takes up all of it.
    Unobservable,
}
