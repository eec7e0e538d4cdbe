//! What the audit found.

use super::outlier::Outlier;

/// A number that was found, with its standard deviation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// What it is: `ratio`, `fraction`, `size`, `correlation`.
    pub name: &'static str,
    /// The number.
    pub estimate: f64,
    /// Its standard deviation.
    pub sigma: f64,
    /// Its unit, `1` for a plain number.
    pub unit: &'static str,
}

/// One thing that is wrong with the noise.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseFinding {
    /// Id of the effect in the catalogue.
    pub effect: &'static str,
    /// Its parameters.
    pub parameters: Vec<Estimate>,
    /// Significance in standard deviations; of a ratio below one it is negative.
    pub z: f64,
    /// Probability of as much or more on a record whose noise is as declared, its share of the
    /// search included.
    pub p_value: f64,
}

/// Which tests were made, and what each may claim of the false alarms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shares {
    /// Of outliers, all samples together.
    pub outliers: f64,
    /// Of the noise of the three accelerometers together.
    pub accel_noise: f64,
    /// Of the correlation.
    pub coloured_noise: f64,
    /// Kept for the noise of the gyros, which needs the likelihood of the filter.
    pub gyro_noise: f64,
}

impl Shares {
    /// Equal shares. Quantisation needs none: continuous values are never on a lattice.
    #[must_use]
    pub fn of(false_alarm: f64) -> Self {
        let share = false_alarm / 4.0;
        Self {
            outliers: share,
            accel_noise: share,
            coloured_noise: share,
            gyro_noise: share,
        }
    }
}

/// What the noise is, whether or not it is as declared, and what became of the record.
#[derive(Debug, Clone, PartialEq)]
pub struct NoiseAudit {
    /// What is wrong, the strongest first.
    pub findings: Vec<NoiseFinding>,
    /// Standard deviation of the noise of each accelerometer over the declared one, without
    /// outliers and quantisation; `None` if the record is too short to tell.
    pub accel_ratio: Option<[Estimate; 3]>,
    /// Correlation of the accelerometers' noise from one row to the next.
    pub correlation: Option<Estimate>,
    /// Standard deviation of the gyros' noise over the declared one as the accelerometers see it
    /// within an hour, a rough figure: a nuisance here.
    pub gyro_ratio: Option<Estimate>,
    /// Least significant bit of each accelerometer, where it matters \[g\].
    pub quantisation_g: [Option<f64>; 3],
    /// Outliers.
    pub outliers: Vec<Outlier>,
    /// Gaps and missing values.
    pub gaps: Gaps,
    /// How to look at the record from here on.
    pub cleaned: Cleaned,
}

/// Missing rows and values; for information.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gaps {
    /// Number of intervals longer than one and a half median ones.
    pub count: usize,
    /// Time in them beyond a median interval.
    pub missing_s: f64,
    /// Longest interval between rows.
    pub longest_s: f64,
    /// Fraction of the values of existing rows that are missing.
    pub missing_values: f64,
}

/// What later stages use in place of record and declared noise.
#[derive(Debug, Clone, PartialEq)]
pub struct Cleaned {
    /// Which values count, row by row: those that exist and are no outliers.
    pub keep: Vec<[bool; 3]>,
    /// Standard deviation of a sample over the declared one, with quantisation; exactly 1 where
    /// nothing was found.
    pub sample_ratio: [f64; 3],
    /// Correlation from one row to the next; exactly 0 if none was found.
    pub correlation: f64,
    /// Standard deviation over the declared one of white noise that is as strong as this noise
    /// over long times: what a physical search, whose signatures are slow, has to reckon with.
    pub slow_ratio: [f64; 3],
}

impl Cleaned {
    /// The record with `NaN` for values that do not count.
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
