//! Forecasts of runs that have not been made.

use serde::{Deserialize, Serialize};

/// What a run that has not been made would tell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NextRun {
    /// Its name.
    pub name: String,
    /// Its rows.
    pub rows: usize,
    /// Its duration \[s\].
    pub duration_s: f64,
    /// Standard deviations of parameters and sizes.
    pub sigmas: Vec<NextSigma>,
    /// Named effects beside the alternatives of their sets.
    pub told_apart: Vec<ToldApart>,
}

/// A standard deviation before and after a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NextSigma {
    /// The parameter, or the effect with the name of its size.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// From the records.
    pub now: f64,
    /// From the records and the run.
    pub after: f64,
}

/// A named effect and an alternative before and after a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToldApart {
    /// The named effect.
    pub effect: String,
    /// The alternative.
    pub alternative: String,
    /// What the alternative leaves of the named effect at its size, in standard deviations, from the records.
    pub now: f64,
    /// The same from the records and the run.
    pub after: f64,
    /// Probability that the alternative leaves the set with the run, if the named effect is the cause.
    pub probability: f64,
}
