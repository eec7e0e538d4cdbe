//! Gain of the extended model over the nominal one.

use serde::{Deserialize, Serialize};

/// Gain of an extended model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gain {
    /// Effects in the model: the accepted ones; if none is, all significant causes.
    pub effects: Vec<String>,
    /// Rows that a block is predicted from.
    pub prediction: Prediction,
    /// Predictive log score of the blocks of the record: extended less nominal, sum over all blocks
    /// \[nats\].
    pub cross_validated_log_score_nats: f64,
    /// The same block by block \[nats\]; `None` of a block without which the others do not determine the effects.
    /// Of several records of a plant each is a block.
    pub block_log_score_nats: Vec<Option<f64>>,
    /// Error of the open-loop simulation of a platform.
    pub free_run_rms_g: Option<FreeRun>,
    /// Change of each drift coefficient of a platform.
    pub coefficient_shift: Vec<CoefficientShift>,
    /// Validation on a later record, if one was given and an effect is accepted.
    pub validation: Option<Validation>,
}

/// Rows that a block of a record is predicted from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Prediction {
    /// All other blocks.
    #[default]
    CrossValidated,
    /// The blocks before it, with the noise of the gyros that those tell: beside a random walk. The
    /// first block has none.
    Forward,
}

/// Root mean square of measured less simulated specific force, the simulation running from the
/// first attitude without measurement updates \[g\]: root of the mean of the mean squares of the
/// axes. Values that the noise audit left out do not count.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FreeRun {
    /// Of the nominal model.
    pub before: f64,
    /// Of the extended model.
    pub after: f64,
    /// Noise of the accelerometers alone; that of the gyros adds to the drift with time.
    pub noise: f64,
}

/// Change of a drift coefficient by an extension.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientShift {
    /// Id of the coefficient.
    pub coefficient: String,
    /// Extended less nominal estimate, in `unit`.
    pub shift: f64,
    /// The shift over the standard deviation of the nominal estimate.
    pub in_sigmas: f64,
    /// The unit.
    pub unit: String,
}

/// Validation of nominal and extended model on another record of the same platform.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Validation {
    /// Predictive log score of that record given the diagnosed one: extended less nominal \[nats\].
    pub log_score_nats: f64,
    /// Attitude error under compensation, of a platform.
    pub compensation: Option<Compensation>,
    /// Errors of simulations of a plant's outputs.
    pub open_loop: Vec<OutputError>,
    /// Time over which these go on \[s\]; `None` of a platform.
    pub horizon_s: Option<f64>,
}

/// Root mean square error of an output in simulations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputError {
    /// The output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// With the nominal model; `None` where the simulation leaves the finite numbers.
    pub nominal: Option<f64>,
    /// With all findings; `None` as above.
    pub extended: Option<f64>,
}

/// Angle between the attitude that the diagnosed record predicts and the one that the later
/// record's own accelerometers determine: root mean squares over several starts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Compensation {
    /// Number of starts.
    pub starts: usize,
    /// Time of the prediction \[h\]: a day, or the length of a shorter record.
    pub after_h: f64,
    /// With the coefficients of the nominal model \[arc minutes\].
    pub nominal_arcmin: f64,
    /// With those of the extended model \[arc minutes\].
    pub extended_arcmin: f64,
    /// Expectation from the covariance of the extended model and the noise of the gyros
    /// \[arc minutes\].
    pub expected_arcmin: f64,
}
