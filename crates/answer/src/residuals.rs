//! Residuals of the nominal model.

use serde::{Deserialize, Serialize};

/// Innovations of the nominal model and its open-loop simulation error. What a short record does
/// not show is `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Residuals {
    /// Normalised innovations squared.
    pub nis: Option<Nis>,
    /// Correlation over rows.
    pub autocorrelation: Option<Autocorrelation>,
    /// The largest line of each axis x, y, z.
    pub lines: Option<[Line; 3]>,
    /// Root mean square of measured less simulated specific force of x, y, z, the simulation
    /// running from the first attitude without measurement updates \[g\]. Values that the noise audit
    /// left out do not count.
    pub free_run_rms_g: [f64; 3],
    /// Means of normalised innovations in bins of equal numbers of rows.
    pub against: Vec<Against>,
}

/// Normalised innovations squared.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Nis {
    /// Their sum over `rows`; `values` over `rows` is expected of a consistent filter, 3 if none is
    /// missing.
    pub mean: f64,
    /// Rows with a value.
    pub rows: usize,
    /// Their values, at most three a row.
    pub values: usize,
    /// The 99.9 % interval of the mean for a record that fits the model, as in a calibration.
    pub band: [f64; 2],
    /// Two-sided p-value of the mean.
    pub p_value: f64,
}

/// Correlation of innovations over rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Autocorrelation {
    /// Ljung-Box statistic of the three axes together.
    pub ljung_box: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Its p-value.
    pub p_value: f64,
    /// Correlation of x, y, z at a lag of one row, two rows, and so on.
    pub correlation: Vec<[f64; 3]>,
}

/// The largest line of a periodogram.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Line {
    /// Its period \[h\].
    pub period_h: f64,
    /// Its amplitude in standard deviations of an innovation.
    pub amplitude: f64,
    /// Probability of as large a line at any frequency by chance.
    pub p_value: f64,
}

/// Innovations against a quantity that they may depend on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Against {
    /// `force_x_g`, `force_y_g`, `force_z_g`, `time_s` or `temperature_c`.
    pub abscissa: String,
    /// For x, y, z the p-value of bin means as far from zero.
    pub p_value: [f64; 3],
    /// Middle of each bin, for x, y, z.
    pub at: [Vec<f64>; 3],
    /// Mean of the innovations in each bin, in their standard deviations, for x, y, z.
    pub mean: [Vec<f64>; 3],
}
