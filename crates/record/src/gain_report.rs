//! What an extended model gains, in the JSON result of `gyrocal diagnose`.

use serde::{Deserialize, Serialize};

/// What an extended model gains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GainReport {
    /// Effects in the model: those that are accepted; if none is, all that are significant.
    pub effects: Vec<String>,
    /// Predictive log score of the blocks of the record, each given the others: extended less
    /// nominal, all together.
    pub cross_validated_log_score_nats: f64,
    /// The same block by block.
    pub block_log_score_nats: Vec<f64>,
    /// Measured less simulated specific force.
    pub free_run_rms_g: FreeRunReport,
    /// What the extension changes of each of the nine coefficients.
    pub coefficient_shift: Vec<ShiftReport>,
    /// What another record says, if one was given and an effect is accepted.
    pub validation: Option<ValidationReport>,
}

/// Root mean square of measured less simulated specific force, the simulation running by itself
/// from the first attitude \[g\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FreeRunReport {
    /// Of the nominal model.
    pub before: f64,
    /// Of the extended model.
    pub after: f64,
    /// What the noise of the accelerometers alone leaves; the gyros' adds to the drift with time.
    pub noise: f64,
}

/// What an extension changes of a coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShiftReport {
    /// `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, and so on.
    pub coefficient: String,
    /// Extended less nominal estimate, in `unit`.
    pub shift: f64,
    /// 95 % interval of the shift.
    pub interval: [f64; 2],
    /// The shift over the standard deviation that the nominal fit claimed.
    pub in_sigmas: f64,
    /// 95 % interval of that.
    pub in_sigmas_interval: [f64; 2],
    /// `deg/h`, `deg/h/g` or `deg/h/g^2`.
    pub unit: String,
}

/// What another record of the same platform says of the nominal and the extended model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidationReport {
    /// Predictive log score of that record, given the diagnosed one: extended less nominal.
    pub log_score_nats: f64,
    /// What a compensation by the coefficients of the diagnosed record leaves of the drift.
    pub compensation: CompensationReport,
}

/// Angle between the predicted attitude and that which the record's own accelerometers tell, as
/// root mean squares over several starts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CompensationReport {
    /// Number of starts.
    pub starts: usize,
    /// Time of the prediction \[h\]: a day, or the length of a shorter record.
    pub after_h: f64,
    /// With the coefficients of the nominal model \[arc minutes\].
    pub nominal_arcmin: f64,
    /// With those of the extended model \[arc minutes\].
    pub extended_arcmin: f64,
    /// What the covariance of the extended model and the gyros' noise let one expect
    /// \[arc minutes\].
    pub expected_arcmin: f64,
}
