//! The JSON results.

use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;

/// Version of the JSON results; it rises when a field changes its meaning or goes away.
pub const SCHEMA_VERSION: u32 = 1;

/// What `gyrocal calibrate` found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationReport {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// The drift coefficients, in the order of `covariance`.
    pub coefficients: Vec<Coefficient>,
    /// Covariance of the coefficients, row by row, in products of their units.
    pub covariance: Vec<Vec<f64>>,
    /// Mean over the rows of the normalised innovation squared (the number of components of a
    /// row is expected, 3 without `nan`).
    pub nis_mean: f64,
    /// The interval that holds `nis_mean` of a record that fits the model, lower end first.
    pub nis_band: [f64; 2],
    /// What `nis_mean` says of the fit.
    pub verdict: FitVerdict,
    /// The verdict in a sentence.
    pub verdict_text: String,
    /// Passes over the record.
    pub iterations: usize,
    /// Rows that were used.
    pub rows: usize,
    /// Platform against local east, north, up at the last row: angles about x, y, z \[deg\].
    pub final_angles_deg: [f64; 3],
}

/// One estimated coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    /// `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, and so on.
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation, in `unit`.
    pub sigma: f64,
    /// `deg/h`, `deg/h/g` or `deg/h/g^2`.
    pub unit: String,
    /// Whether the record determined it: `sigma` is below a tenth of the prior's.
    pub determined: bool,
}

/// What the innovations say of the fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FitVerdict {
    /// The innovations are as large as the noise declared in the bench file explains.
    Consistent,
    /// They are larger: the model lacks something or the noise is larger than declared.
    TooLarge,
    /// They are smaller: the noise is smaller than declared.
    TooSmall,
}

/// What `gyrocal simulate` put into a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SimulationReport {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// The coefficients that the platform had.
    pub coefficients: Vec<TrueCoefficient>,
    /// Rows that were written.
    pub rows: usize,
    /// True platform against local east, north, up at the first row: angles about x, y, z \[deg\].
    pub initial_angles_deg: [f64; 3],
    /// The same at the last row \[deg\].
    pub final_angles_deg: [f64; 3],
}

/// One coefficient of a simulated platform.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrueCoefficient {
    /// `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, and so on.
    pub name: String,
    /// The value, in `unit`.
    pub value: f64,
    /// `deg/h`, `deg/h/g` or `deg/h/g^2`.
    pub unit: String,
}
