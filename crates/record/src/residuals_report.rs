//! What residuals of the nominal model show, in the JSON result of `gyrocal diagnose`.

use serde::{Deserialize, Serialize};

/// Innovations of the nominal model, and its free run. What a short record does not show is `None`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ResidualsReport {
    /// Normalised innovations squared.
    pub nis: Option<NisReport>,
    /// Correlation over rows.
    pub autocorrelation: Option<AutocorrelationReport>,
    /// The largest line of each axis x, y, z.
    pub lines: Option<[LineReport; 3]>,
    /// Root mean square of measured less simulated specific force of x, y, z, the simulation running
    /// by itself from the first attitude \[g\].
    pub free_run_rms_g: [f64; 3],
    /// Means of normalised innovations in bins of equal numbers of rows.
    pub against: Vec<AgainstReport>,
}

/// Normalised innovations squared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NisReport {
    /// Their sum over the number of values; 1 if the model is right.
    pub mean: f64,
    /// What it lies in if the model is right, with the false-alarm probability of the diagnosis.
    pub band: [f64; 2],
    /// Probability of a mean as far off by chance.
    pub p_value: f64,
}

/// Correlation of innovations over rows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AutocorrelationReport {
    /// Ljung-Box statistic of the three axes together.
    pub ljung_box: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of as much by chance.
    pub p_value: f64,
    /// Correlation of x, y, z over one row, two rows, and so on.
    pub correlation: Vec<[f64; 3]>,
}

/// The largest line of a periodogram.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LineReport {
    /// Its period \[h\].
    pub period_h: f64,
    /// Its amplitude in standard deviations of an innovation.
    pub amplitude: f64,
    /// Probability of as large a one anywhere by chance.
    pub p_value: f64,
}

/// Innovations against what they may depend on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AgainstReport {
    /// `force_x_g`, `force_y_g`, `force_z_g`, `time_s` or `temperature_c`.
    pub abscissa: String,
    /// For x, y, z the probability by chance of means as far from zero.
    pub p_value: [f64; 3],
    /// Middle of each bin, for x, y, z.
    pub at: [Vec<f64>; 3],
    /// Mean of the innovations in each bin, in their standard deviations, for x, y, z.
    pub mean: [Vec<f64>; 3],
}
