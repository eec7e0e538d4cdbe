//! Limits of an answer: what the record does not determine, show or tell apart.

use serde::{Deserialize, Serialize};

use crate::Experiment;

/// Set-ups that fit a record alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetUps {
    /// Their names, the declared one first.
    pub members: Vec<String>,
    /// Why they fit alike.
    pub why: String,
    /// Experiments that would tell them apart.
    pub experiments: Vec<Experiment>,
    /// The experiments in words.
    pub would_separate: String,
}

/// A direction that a record does not determine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NullDirection {
    /// Whether no record determines it; this record does not otherwise.
    pub is_gauge: bool,
    /// Names with their changes: a share of a value that is not zero, in the unit otherwise.
    pub parts: Vec<NullPart>,
    /// The parameter that was held for it.
    pub held: Option<String>,
}

/// One name of a direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NullPart {
    /// Parameter or initial state.
    pub name: String,
    /// Its change along the direction, the largest being one.
    pub change: f64,
    /// Whether the change is a share of its value.
    pub is_share: bool,
}

/// How the best fit was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Starts {
    /// Starts that were tried.
    pub tried: usize,
    /// Starts that ended at the best fit.
    pub agreeing: usize,
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
