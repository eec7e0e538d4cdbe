//! Test of the residuals with all causes in the model.

use serde::{Deserialize, Serialize};

/// Test of the residuals with all causes in the model: whiteness of the innovations, and the
/// search for terms that the catalogue does not hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ResidualTest {
    /// The answer.
    pub verdict: ResidualVerdict,
    /// Probability of as much structure in white innovations, all tests together; `None` if none could be made.
    pub p_value: Option<f64>,
    /// Channel, period and size of the structure, or the tests that could not be made; empty if the
    /// innovations are white.
    pub description: String,
    /// The largest line in the spectrum of the innovations; `None` if the record is too short.
    pub line: Option<ResidualLine>,
    /// Correlation of the innovations over rows; `None` if the record is too short.
    pub correlation: Option<ResidualCorrelation>,
    /// Whiteness of what is left of each output of a plant.
    pub outputs: Vec<OutputTest>,
    /// Terms that the catalogue does not hold, in the order in which they were found; they are in
    /// the extended model.
    pub unmodelled: Vec<UnmodelledTerm>,
}

/// Test of what the model with all causes leaves of an output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputTest {
    /// The output.
    pub output: String,
    /// Probability of as much correlation in white innovations.
    pub p_value: f64,
}

/// Verdict of the residual test.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ResidualVerdict {
    /// The innovations are white.
    White,
    /// Nothing is significant, but the record is too short for some of the tests.
    NotTested,
    /// There is structure that no effect of the catalogue explains.
    Unexplained,
}

/// The largest line in the spectrum of the innovations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ResidualLine {
    /// Output channel: `x`, `y` or `z`.
    pub channel: String,
    /// Its period \[h\].
    pub period_h: f64,
    /// Its amplitude in standard deviations of an innovation.
    pub amplitude: f64,
    /// Probability of as large a line in any channel by chance.
    pub p_value: f64,
    /// Whether it is significant beside the other residual tests.
    pub significant: bool,
}

/// Correlation of the innovations over neighbouring rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ResidualCorrelation {
    /// Ljung-Box statistic of all channels together.
    pub ljung_box: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Probability of as large a statistic by chance.
    pub p_value: f64,
    /// Whether it is significant beside the other residual tests.
    pub significant: bool,
}

/// A term that the catalogue does not hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UnmodelledTerm {
    /// Channel that it enters: `gyro_x` to `gyro_z` of a drift, `accel_x` to `accel_z` of a reading; of a plant the
    /// rate, output or parameter.
    pub channel: String,
    /// Its pattern.
    pub pattern: UnmodelledPattern,
    /// Period of a line \[h\].
    pub period_h: Option<f64>,
    /// What a curve depends on: component `x`, `y` or `z` of specific force, or a variable of a plant.
    pub depends_on: Option<String>,
    /// Amplitude of a line, root mean square of a curve, in `unit`.
    pub size: f64,
    /// The unit.
    pub unit: String,
    /// Probability of as much anywhere that was looked at, by chance.
    pub p_value: f64,
}

/// Pattern of a term that the catalogue does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum UnmodelledPattern {
    /// A sine over time.
    Line,
    /// A function of a component of specific force that is no polynomial of the catalogue.
    Curve,
}
