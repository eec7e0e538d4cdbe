//! Results of the audit.

use super::outlier::Outlier;
use crate::error_budget::NOISE_AUDIT_PARTS;
use gyrocal_answer::Gaps;

/// An estimate with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Name of the parameter: `ratio`, `fraction`, `size`, `correlation`.
    pub name: &'static str,
    /// The estimate.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// Its unit, `1` for a plain number.
    pub unit: &'static str,
}

/// A deviation of the noise from the declared one.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseFinding {
    /// Id of the effect in the catalogue.
    pub effect: &'static str,
    /// Its parameters.
    pub parameters: Vec<Estimate>,
    /// Significance in standard deviations; negative for a ratio below 1.
    pub z: f64,
    /// p-value over all tests of this kind.
    pub p_value: f64,
}

/// Shares of the tests in the false-alarm probability of the audit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Outliers, all samples together.
    pub outliers: f64,
    /// Variance of the noise of the three accelerometers together.
    pub accel_noise: f64,
    /// Correlation.
    pub coloured_noise: f64,
    /// Reserved for the noise of the gyros, which needs the likelihood of the filter.
    pub gyro_noise: f64,
}

impl Shares {
    /// Equal shares. Quantisation needs none: continuous values are never on a lattice.
    #[must_use]
    pub fn of(false_alarm: f64) -> Self {
        let share = false_alarm / NOISE_AUDIT_PARTS;
        Self {
            outliers: share,
            accel_noise: share,
            coloured_noise: share,
            gyro_noise: share,
        }
    }
}

/// Result of the audit: findings, estimates of the noise, and the cleaned record.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NoiseAudit {
    /// Findings, the most significant first.
    pub findings: Vec<NoiseFinding>,
    /// Standard deviation of the noise of each accelerometer over the declared one, without
    /// outliers and quantisation; `None` if the record is too short.
    pub accel_ratio: Option<[Estimate; 3]>,
    /// Correlation of the accelerometers' noise from one row to the next.
    pub correlation: Option<Estimate>,
    /// Standard deviation of the gyro noise over the declared one, from the accelerometers on time
    /// scales below an hour: a rough estimate of a nuisance parameter.
    pub gyro_ratio: Option<Estimate>,
    /// Quantisation step of each accelerometer, if found \[g\].
    pub quantisation_g: [Option<f64>; 3],
    /// Outliers.
    pub outliers: Vec<Outlier>,
    /// Gaps and missing values.
    pub gaps: Gaps,
    /// Values and noise to use from here on.
    pub cleaned: Cleaned,
}

/// Values and noise model for later stages, instead of record and declared noise.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cleaned {
    /// Values to use, row by row: those that exist and are not outliers.
    pub keep: Vec<[bool; 3]>,
    /// Standard deviation of a sample over the declared one, quantisation included; exactly 1
    /// without a finding.
    pub sample_ratio: [f64; 3],
    /// Correlation from row to row; exactly 0 without a finding.
    pub correlation: f64,
    /// Standard deviation, over the declared one, of white noise with the same long-term power: the
    /// noise level for the search, whose signatures are slow.
    pub slow_ratio: [f64; 3],
}

impl Cleaned {
    /// The record with `NaN` for values that are not used.
    #[must_use]
    pub fn apply(&self, record: &gyrocal_record::Record) -> gyrocal_record::Record {
        let mut cleaned = record.clone();
        for (row, keep) in cleaned.accel_g.iter_mut().zip(&self.keep) {
            for axis in 0..3 {
                if !keep[axis] {
                    row[axis] = f64::NAN;
                }
            }
        }
        cleaned
    }
}

impl NoiseAudit {
    /// The finding of an effect, if there is one.
    #[must_use]
    pub fn finding(&self, effect: &str) -> Option<&NoiseFinding> {
        self.findings
            .iter()
            .find(|finding| finding.effect == effect)
    }
}
