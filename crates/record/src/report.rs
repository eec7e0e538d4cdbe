//! The JSON results.

use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;
use crate::noise_ratio::NoiseEstimate;
use crate::setup::SetupProblem;

/// Version of the JSON results; it rises when a field changes its meaning or goes away.
pub const SCHEMA_VERSION: u32 = 1;

/// The same of [`CalibrationReport`].
pub const CALIBRATION_SCHEMA_VERSION: u32 = 2;

/// Result of `gyrocal calibrate`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CalibrationReport {
    /// [`CALIBRATION_SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Origin of the result.
    pub manifest: Manifest,
    /// Gross errors of the set-ups. One that leaves nothing sound makes the verdict `setup`: nothing
    /// was estimated.
    #[serde(default)]
    pub setup: Vec<SetupProblem>,
    /// What the diagnosis of each record says; empty where none was made.
    #[serde(default)]
    pub effects: Vec<EffectTest>,
    /// The drift coefficients, in the order of `covariance`; empty if nothing was estimated.
    pub coefficients: Vec<Coefficient>,
    /// Covariance of the coefficients, row by row, in products of their units.
    pub covariance: Vec<Vec<f64>>,
    /// Mean normalised innovation squared (NIS) of the rows; its expectation is the number of
    /// measured components of a row, 3 without `nan`. `None` if nothing was estimated.
    pub nis_mean: Option<f64>,
    /// The interval that holds `nis_mean` of a record that fits the model, lower end first.
    pub nis_band: Option<[f64; 2]>,
    /// Verdict on set-up, effects and `nis_mean`, in this order.
    pub verdict: FitVerdict,
    /// The verdict in a sentence.
    pub verdict_text: String,
    /// Iterations of the batch estimator; 1 for one pass of the filter.
    pub iterations: usize,
    /// Whether the coefficients mean anything: not if the innovations are far larger than the noise, or nothing was
    /// estimated.
    pub usable: bool,
    /// The records, in their order; empty if nothing was estimated.
    pub records: Vec<RecordReport>,
    /// Rows that were used, of all records.
    pub rows: usize,
    /// Platform against local east, north, up at the last row of the last record: angles about
    /// x, y, z \[deg\]. `None` if nothing was estimated.
    pub final_angles_deg: Option<[f64; 3]>,
    /// Method of estimation.
    pub method: CalibrationMethod,
    /// Combinations of coefficients that the records do not determine; batch estimator only.
    pub undetermined: Vec<UndeterminedReport>,
    /// Results for each record; batch estimator only.
    pub runs: Vec<RunReport>,
    /// Sensitivities to errors of the first record's site; batch estimator only.
    pub site: Vec<SiteReport>,
    /// Sigmas of the coefficients from the first record alone, if there are several.
    pub first_record_sigmas: Option<Vec<f64>>,
    /// The coefficients with the effects of `--with` in the model; `None` without such.
    #[serde(default)]
    pub with_effects: Option<FittedEffects>,
}

impl CalibrationReport {
    /// The result for records of whose set-ups one leaves nothing sound: nothing was estimated.
    #[must_use]
    pub fn of_wrong_setup(
        manifest: Manifest,
        method: CalibrationMethod,
        setup: Vec<SetupProblem>,
    ) -> Self {
        let texts: Vec<String> = setup.iter().map(SetupProblem::text).collect();
        Self {
            schema_version: CALIBRATION_SCHEMA_VERSION,
            manifest,
            verdict_text: format!("The set-up is wrong: {}", texts.join(" ")),
            setup,
            method,
            ..Self::default()
        }
    }
}

/// What the diagnosis of a calibrated record says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EffectTest {
    /// The record, as its path was given.
    pub record: String,
    /// Causes that it names, in the order of its findings.
    pub causes: Vec<NamedCause>,
    /// What differs from the declared noise, by the ids of a diagnosis.
    pub noise: Vec<String>,
    /// Whether the innovations are white with all this in the model; `None` of a record too short for the test.
    pub white: Option<bool>,
    /// p-value of that test.
    pub residual_p_value: Option<f64>,
    /// Whether names hold: the search ended by itself, and what is named leaves white innovations.
    pub settled: bool,
}

/// A cause that a diagnosis names.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NamedCause {
    /// Id of the effect.
    pub effect: String,
    /// Effects that the record does not tell apart from it.
    pub alternatives: Vec<String>,
    /// Its size in standard deviations.
    pub z: f64,
    /// Family-wise p-value of the search; `None` where it was not computed for the final model.
    pub p_value: Option<f64>,
}

/// The drift coefficients with given effects in the model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FittedEffects {
    /// The effects, in the order given.
    pub effects: Vec<FittedEffect>,
    /// Log-likelihood that the effects gain over the nominal model, the noise estimated with and without
    /// them \[nats\].
    pub gained_nats: f64,
    /// The drift coefficients, in the order of `covariance`.
    pub coefficients: Vec<Coefficient>,
    /// Their covariance, row by row, in products of their units.
    pub covariance: Vec<Vec<f64>>,
}

/// An effect that was fitted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FittedEffect {
    /// Its id.
    pub effect: String,
    /// Its physical name.
    pub name: String,
    /// Its parameters.
    pub parameters: Vec<FittedParameter>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FittedParameter {
    /// `size`, `onset_s`, `time_constant_h`, `sine`, `cosine`, ….
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation; `None` where the likelihood is not quadratic.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset, a time constant or the size of a random walk, in pieces.
    pub interval: Option<Vec<[f64; 2]>>,
    /// The unit; `1` of plain numbers.
    pub unit: String,
}

/// One estimated coefficient.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficient {
    /// `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, and so on.
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation, in `unit`.
    pub sigma: f64,
    /// `deg/h`, `deg/h/g` or `deg/h/g^2`.
    pub unit: String,
    /// Whether the record determined it: `sigma` is below a tenth of the prior's, and the innovations
    /// are not far larger than any effect makes them.
    pub determined: bool,
}

/// What a calibration says of its records.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FitVerdict {
    /// The innovations are as large as the noise declared in the bench file explains.
    Consistent,
    /// They are larger: the model lacks something or the noise is larger than declared.
    TooLarge,
    /// They are smaller: the noise is smaller than declared.
    TooSmall,
    /// A record shows an effect of the catalogue, whatever the size of the innovations.
    EffectsFound,
    /// The innovations of a record are not white, and no effect of the catalogue is significant.
    Unexplained,
    /// The diagnosis of a record is not settled: its search ended at its budget of work, or what it names leaves
    /// innovations that are not white.
    NotSettled,
    /// The noise of a record is not the declared one in another way than its size: it is correlated, has outliers
    /// or steps, or that of single channels is not as declared.
    NoiseDiffers,
    /// A gross error of a set-up leaves nothing sound: nothing was estimated.
    #[default]
    Setup,
}

/// Method of estimation of the coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum CalibrationMethod {
    /// Iterated smoothing of whole records.
    #[default]
    Batch,
    /// One pass of the filter that a controller embeds.
    Streaming,
    /// One pass of the filter of the paper.
    Paper,
}

/// A combination of coefficients that the records do not determine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UndeterminedReport {
    /// The combination in words, its small parts left out.
    pub text: String,
    /// Weight of each coefficient over its prior sigma; the sum of squares is 1.
    pub weights: Vec<f64>,
    /// Standard deviation of the combination after the records over that before them.
    pub share_of_prior: f64,
}

/// A record that was calibrated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordReport {
    /// The record, as its path was given.
    pub record: String,
    /// Its bench description.
    pub bench: String,
    /// Its rows.
    pub rows: usize,
    /// From its first row to its last.
    pub duration_s: f64,
    /// Averaging of its rows, if they were averaged.
    pub averaged: Option<AveragedReport>,
    /// Records before it whose times overlap its own, although they begin at another time.
    pub overlaps: Vec<String>,
}

/// Results for one record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RunReport {
    /// The record, as its path was given.
    pub record: String,
    /// Platform against local east, north, up at the first row: angles about x, y, z \[deg\].
    pub initial_angles_deg: [f64; 3],
    /// The same at the last row.
    pub final_angles_deg: [f64; 3],
    /// Constant drifts of gyros x, y, z in this turn-on less their means over turn-ons \[deg/h\],
    /// if turn-ons may differ.
    pub turn_on: Option<[TurnOn; 3]>,
    /// Search for the azimuth, if the bench description does not give it.
    pub azimuth: Option<AzimuthReport>,
    /// Noise by maximum likelihood over the declared one.
    pub noise: Option<NoiseEstimate>,
    /// Values whose influence was bounded.
    pub bounded_values: usize,
}

/// Averaging of the rows of a record.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AveragedReport {
    /// Length of the averaging intervals.
    pub interval_s: f64,
    /// Number of means.
    pub means: usize,
    /// Number of components of means left out because they had too few values.
    pub left_out: usize,
    /// Standard deviation of the noise of a mean over that of one value.
    pub noise_ratio: f64,
    /// Share of the variance of a mean that is the attitude random walk within an interval, which the declared noise
    /// does not include.
    pub walk_share: f64,
}

/// Constant drift of a gyro in one turn-on less its mean over turn-ons.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TurnOn {
    /// The estimate \[deg/h\].
    pub estimate: f64,
    /// Its standard deviation \[deg/h\].
    pub sigma: f64,
}

/// Search for an unknown azimuth.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct AzimuthReport {
    /// Number of azimuths tried.
    pub starts: usize,
    /// Whether another azimuth is nearly as likely.
    pub ambiguous: bool,
    /// The best other azimuth, if the starts led to several.
    pub other: Option<OtherAzimuth>,
}

/// The best azimuth of those not chosen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OtherAzimuth {
    /// Angle from the chosen azimuth to this one.
    pub relative_deg: f64,
    /// Log-likelihood of the chosen azimuth less that of this one.
    pub log_likelihood_deficit: f64,
}

/// Sensitivity of the coefficients to an error of a site quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SiteReport {
    /// `latitude`, `earth_rate` or `gravity`.
    pub quantity: String,
    /// `deg`, or `1` for a relative quantity.
    pub unit: String,
    /// The standard deviation that the bench description declares; the sigmas include it.
    pub declared_sigma: Option<f64>,
    /// The error that biases are told for: the declared standard deviation, else one that is easily met.
    pub assumed_error: f64,
    /// Standard deviation if it were estimated from the records alone; `None` if it is
    /// unobservable.
    pub from_record_sigma: Option<f64>,
    /// Bias of each coefficient when the true quantity exceeds the assumed one by a unit.
    pub bias_per_unit: Vec<f64>,
}

/// Result of `gyrocal simulate`: the truth of a record.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulationReport {
    /// [`SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Origin of the result.
    pub manifest: Manifest,
    /// Coefficients of the simulated platform.
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
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TrueCoefficient {
    /// `gyro_x.bias`, `gyro_x.g_x`, `gyro_x.g_xx`, and so on.
    pub name: String,
    /// The value, in `unit`.
    pub value: f64,
    /// `deg/h`, `deg/h/g` or `deg/h/g^2`.
    pub unit: String,
}
