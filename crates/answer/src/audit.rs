//! Size of a record, and the noise audit of its accelerometers.

use gyrocal_record::AveragedReport;
use serde::{Deserialize, Serialize};

/// Size of a record.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordSummary {
    /// Number of rows.
    pub rows: usize,
    /// Time from the first row to the last \[s\].
    pub duration_s: f64,
    /// Missing rows and values.
    pub gaps: Gaps,
    /// Means of blocks that were diagnosed in the place of rows that come faster than anything moves.
    #[serde(default)]
    pub averaged: Option<AveragedReport>,
}

/// Missing rows and values.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gaps {
    /// Number of intervals longer than one and a half median ones.
    pub count: usize,
    /// Time in them beyond a median interval \[s\].
    pub missing_s: f64,
    /// Longest interval between rows \[s\].
    pub longest_s: f64,
    /// Fraction of the values of existing rows that are missing.
    pub missing_values: f64,
}

/// Noise audit of the accelerometers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseAuditSummary {
    /// Standard deviation of the noise of x, y, z over the declared one, without outliers and
    /// quantisation; `None` if the record is too short for a spectrum of its noise.
    pub accel_ratio: Option<[Estimated; 3]>,
    /// Correlation of the noise from one row to the next; `None` as above.
    pub correlation: Option<Estimated>,
    /// Least significant bit of x, y, z where it matters \[g\].
    pub quantisation_g: [Option<f64>; 3],
    /// Number of values that are outliers; they are left out of everything else.
    pub outliers: usize,
}

/// Noise that a model is fitted with: what its standard deviations rest on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ModelNoise {
    /// White noise of the accelerometers over the declared; of several records its root mean square.
    pub accel_ratio: [f64; 3],
    /// White noise of the gyros over the declared.
    pub gyro_ratio: [f64; 3],
    /// Random walks of the gyros, also those that are too small to be named \[deg/h/√h\].
    pub gyro_walk_deg_per_h_per_sqrt_h: [f64; 3],
}

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Estimated {
    /// The estimate.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// Noise that a plant does not declare, and that its record has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UndeclaredNoise {
    /// The output whose readings have it, or the rate.
    pub channel: String,
    /// What it is.
    pub kind: NoiseKind,
    /// Standard deviation, in `unit`.
    pub sigma: f64,
    /// Of readings their unit; of a rate that of its state over the root of a second.
    pub unit: String,
    /// Correlation time \[s\]; `None` of process noise.
    pub time_s: Option<f64>,
    /// What it adds to the log-likelihood beside the others \[nats\].
    pub gain_nats: f64,
    /// Noises that explain as much in its place, by their channels.
    pub instead: Vec<String>,
}

/// Kind of a noise beside white noise of readings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum NoiseKind {
    /// Noise of readings that is correlated as e^(-t/τ).
    Correlated,
    /// White noise of a rate.
    Process,
}

/// An estimated noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseLevel {
    /// The channel: `accel_x` to `gyro_z` of a platform, an output or a rate of a plant.
    pub channel: String,
    /// Standard deviation over the declared one.
    pub ratio: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}
