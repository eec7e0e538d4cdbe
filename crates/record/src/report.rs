//! The JSON results.

use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;
use crate::setup::SetupProblem;

/// Version of the JSON results; it rises when a field changes its meaning or goes away.
pub const SCHEMA_VERSION: u32 = 1;

/// What `gyrocal calibrate` found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationReport {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// Gross errors of the set-ups that were mended; one that leaves nothing sound ends the
    /// calibration.
    #[serde(default)]
    pub setup: Vec<SetupProblem>,
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
    /// Steps of the batch estimator; 1 of one pass of the filter.
    pub iterations: usize,
    /// Rows that were used, of all records.
    pub rows: usize,
    /// Platform against local east, north, up at the last row of the last record: angles about
    /// x, y, z \[deg\].
    pub final_angles_deg: [f64; 3],
    /// How the coefficients were estimated.
    pub method: CalibrationMethod,
    /// Combinations of coefficients that the records do not determine; of the batch estimator.
    pub undetermined: Vec<UndeterminedReport>,
    /// What belongs to each record; of the batch estimator.
    pub runs: Vec<RunReport>,
    /// What errors of the first record's site do; of the batch estimator.
    pub site: Vec<SiteReport>,
    /// Sigmas of the coefficients from the first record alone, if there are several.
    pub first_record_sigmas: Option<Vec<f64>>,
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

/// How coefficients were estimated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CalibrationMethod {
    /// Iterated smoothing of whole records.
    Batch,
    /// One pass of the filter that a controller embeds.
    Streaming,
    /// One pass of the filter of the paper.
    Paper,
}

/// A combination of coefficients that the records do not determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UndeterminedReport {
    /// The combination in words, its small parts left out.
    pub text: String,
    /// Weight of each coefficient over its prior sigma; the sum of squares is 1.
    pub weights: Vec<f64>,
    /// Standard deviation of the combination after the records over that before them.
    pub share_of_prior: f64,
}

/// What belongs to one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// The record, as its path was given.
    pub record: String,
    /// Its bench description.
    pub bench: String,
    /// Rows, after averaging if there was any.
    pub rows: usize,
    /// How its rows were averaged.
    pub averaged: Option<AveragedReport>,
    /// Platform against local east, north, up at the first row: angles about x, y, z \[deg\].
    pub initial_angles_deg: [f64; 3],
    /// The same at the last row.
    pub final_angles_deg: [f64; 3],
    /// What this turn-on adds to the constant drifts of gyros x, y, z \[deg/h\], if turn-ons may
    /// differ.
    pub turn_on: Option<[TurnOn; 3]>,
    /// How the azimuth was found, if the bench description does not give it.
    pub azimuth: Option<AzimuthReport>,
    /// Noise by maximum likelihood over the declared one.
    pub noise: Option<NoiseReport>,
    /// Values whose influence was bounded.
    pub bounded_values: usize,
}

/// How the rows of a record were averaged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AveragedReport {
    /// Length of the intervals.
    pub interval_s: f64,
    /// Rows before.
    pub rows_read: usize,
    /// Means of too few values that were left out.
    pub left_out: usize,
    /// Noise of a mean over that of one value.
    pub noise_ratio: f64,
}

/// What a turn-on adds to the constant drift of a gyro.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TurnOn {
    /// The estimate \[deg/h\].
    pub estimate: f64,
    /// Its standard deviation \[deg/h\].
    pub sigma: f64,
}

/// How an unknown azimuth was found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct AzimuthReport {
    /// Azimuths that were tried.
    pub starts: usize,
    /// Whether another azimuth is nearly as likely.
    pub ambiguous: bool,
    /// The best other azimuth, if the starts led to several.
    pub other: Option<OtherAzimuth>,
}

/// An azimuth that was not taken.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OtherAzimuth {
    /// Relative to the one that was taken.
    pub relative_deg: f64,
    /// How much less likely it is, as a difference of log-likelihoods.
    pub log_likelihood_deficit: f64,
}

/// Noise by maximum likelihood over the declared one, of instruments x, y, z.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseReport {
    /// Of the accelerometers.
    pub accel: [NoiseRatioReport; 3],
    /// Of the gyros.
    pub gyro: [NoiseRatioReport; 3],
}

/// An estimated standard deviation over the declared one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseRatioReport {
    /// The estimate.
    pub ratio: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// What an error of something known of the site does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SiteReport {
    /// `latitude`, `earth_rate` or `gravity`.
    pub quantity: String,
    /// `deg`, or `1` of what is relative.
    pub unit: String,
    /// The standard deviation that the bench description declares; the sigmas include it.
    pub declared_sigma: Option<f64>,
    /// The standard deviation that the records alone give it; `None` if they say nothing.
    pub from_record_sigma: Option<f64>,
    /// Bias of each coefficient when the true quantity exceeds the assumed one by a unit.
    pub bias_per_unit: Vec<f64>,
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
