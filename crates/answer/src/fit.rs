//! The fit of a plant to a record, with nothing searched, and fits of several plants beside each other.

use serde::{Deserialize, Serialize};

use crate::{
    Coefficients, NoiseLevel, NullDirection, OutputTest, RecordSummary, Starts, UndeclaredNoise,
};

/// The fit of a plant to a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlantFit {
    /// Name of the plant.
    pub plant: String,
    /// The record.
    pub record: RecordSummary,
    /// Rows at the beginning of each record that the errors do not count. Of a plant without noise of its rates they
    /// alone tell the initial states of a later record, unless there are none.
    pub first_rows: usize,
    /// Parameters, then initial states, as `nominal`, with their covariance; nothing is `extended`.
    pub coefficients: Coefficients,
    /// The largest correlations of the estimates, the largest first.
    pub correlations: Vec<Correlation>,
    /// Largest over smallest eigenvalue of the correlations of all estimates but the held ones; `None` where the
    /// smallest is zero.
    pub condition: Option<f64>,
    /// Directions of parameters and initial states that the record does not determine, with what is held for them.
    pub undetermined: Vec<NullDirection>,
    /// Inputs that never move.
    pub still_inputs: Vec<String>,
    /// Starts of the fit.
    pub starts: Starts,
    /// Noise that the plant declares.
    pub noise: Vec<NoiseLevel>,
    /// Noise that it does not declare, and that the record has.
    pub undeclared_noise: Vec<UndeclaredNoise>,
    /// Ljung and Box's test of the innovations of each output; none of one with too few values.
    pub remainder: Vec<OutputTest>,
    /// Number of values of outputs that are fitted.
    pub values: usize,
    /// Number of unknowns: parameters and initial states that are not held, sizes and correlation times of noises.
    pub unknowns: usize,
    /// Logarithm of the density of all values at the estimates, in their units \[nats\]; priors are not in it.
    pub log_likelihood: f64,
    /// Akaike's criterion: twice the unknowns less twice the log-likelihood.
    pub aic: f64,
    /// Schwarz's criterion: the unknowns times the logarithm of the number of values, less twice the log-likelihood.
    pub bic: f64,
    /// Time that open-loop simulations go over \[s\].
    pub horizon_s: f64,
    /// Errors of simulations of the record.
    pub outputs: Vec<OutputFit>,
    /// The same of a later record, which has had no part in the fit.
    pub later: Option<LaterFit>,
}

/// Correlation of two estimates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Correlation {
    /// Their names.
    pub of: [String; 2],
    /// The coefficient, from -1 to 1.
    pub coefficient: f64,
}

/// Errors of simulations of an output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputFit {
    /// The output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// Simulated from the initial states, without any reading.
    pub open_loop: SimulationError,
    /// Predicted from the readings of the rows before, in the noise of the fit.
    pub one_step: SimulationError,
    /// Root mean square error of open-loop simulations of four parts of the record, each left out of the fit in its
    /// turn, in `unit`; `None` of a later record, of a plant with noise of its rates, and where a part determines what
    /// the others do not.
    pub left_out_rms: Option<f64>,
}

/// Error of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulationError {
    /// Root mean square of measured less simulated, in the unit of the output; `None` where the simulation leaves the
    /// finite numbers.
    pub rms: Option<f64>,
    /// Fit percentage: 100 less a hundred times `rms` over the root mean square of measured less its mean; `None` as
    /// above, and of an output that stands still.
    pub fit_percent: Option<f64>,
}

/// A later record, simulated with the parameters of the fit; its initial states are its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LaterFit {
    /// The record.
    pub record: RecordSummary,
    /// Logarithm of the density of its values given the first record \[nats\].
    pub log_score_nats: f64,
    /// Errors of its simulations.
    pub outputs: Vec<OutputFit>,
}

/// Fits of several plants to one record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlantComparison {
    /// The plants, in the order in which they were given. Criteria compare: all have the same readings.
    pub models: Vec<ComparedFit>,
}

/// One of several plants.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComparedFit {
    /// Its name, such as that of its file.
    pub name: String,
    /// Its fit.
    pub fit: PlantFit,
}
