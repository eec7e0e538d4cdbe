//! The way from the nominal model of a plant to that with all findings.

use serde::{Deserialize, Serialize};

/// A model on the way: each effect beside those before it that stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PathStep {
    /// The effect that it adds; `None` of the nominal model.
    pub effect: Option<String>,
    /// Errors of its simulations, of each output; none of a model that cannot be fitted.
    pub outputs: Vec<PathError>,
    /// Why the effect is no finding; `None` of one that stands.
    pub refused: Option<Refusal>,
}

/// Root mean square errors of an output in simulations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PathError {
    /// The output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// In the parts of the record that were left out of the fit, each in its turn; `None` where a simulation leaves the
    /// finite numbers.
    pub left_out: Option<f64>,
    /// In the later record; `None` as above, and without such a record.
    pub later: Option<f64>,
}

/// Why an effect that the likelihood takes is no finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Refusal {
    /// Parts that are left out of the fit are not simulated better with it.
    LeftOutParts,
    /// Another function of time gains much beside it: the course of time is none of the catalogue.
    FunctionsOfTime,
    /// With it a simulation leaves all bounds where the inputs swing by half as much again.
    Diverges,
}
