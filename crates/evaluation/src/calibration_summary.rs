//! Statistics of the calibration over many trials.

use gyrocal_record::Manifest;
use gyrocal_statistics::{
    NORMAL_97_5, Proportion, mean, mean_square_band, median, rms_ratio_interval, root_mean_square,
    standard_error,
};
use gyrocal_truth::Coefficients;
use serde::{Deserialize, Serialize};

use crate::calibration_trial::CalibrationTrial;
use crate::campaign::{Failure, Outcome};

/// Probability of the bands of NEES and NIS.
const BAND: f64 = 0.999;
/// Confidence of the intervals of ratios and shares.
const CONFIDENCE: f64 = 0.95;

/// Result of `gyrocal monte-carlo`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MonteCarloReport {
    /// `SCHEMA_VERSION` of `gyrocal-record` at the time of writing.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// The first seed, and the one after the last.
    pub seeds: [u64; 2],
    /// `true` if seeds number the scenarios of a random population.
    pub population: bool,
    /// Statistics over all runs.
    pub summary: CalibrationSummary,
}

/// Statistics of the calibration over all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CalibrationSummary {
    /// Number of runs with a calibration.
    pub runs: usize,
    /// Runs without one.
    pub failures: Vec<Failure>,
    /// NEES of the determined coefficients; `None` if no run determined any.
    pub nees_determined: Option<BandedMean>,
    /// NEES of all nine coefficients. Its band assumes a truth drawn from the prior: a smaller truth
    /// lowers the NEES of coefficients that the prior determines.
    pub nees: Option<BandedMean>,
    /// NIS per row.
    pub nis: Option<BandedMean>,
    /// Fraction of the runs whose own NIS lies in its 99.9 % band.
    pub consistent: Option<MeasuredValue>,
    /// Statistics of each coefficient.
    pub coefficients: Vec<CoefficientSummary>,
}

impl CalibrationSummary {
    /// Whether the means of the normalised squares lie in their bands.
    #[must_use]
    pub fn is_consistent(&self) -> bool {
        let bands = [self.nees_determined, self.nis];
        bands.iter().flatten().all(BandedMean::holds)
    }

    /// The same in words, without a full stop.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        match self.is_consistent() {
            true => "errors are as large as the sigmas say",
            false => "errors are not as large as the sigmas say",
        }
    }
}

/// Mean of normalised squares with its band for correct covariances.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BandedMean {
    /// The mean.
    pub mean: f64,
    /// Its expectation.
    pub expected: f64,
    /// Interval of probability 99.9 % for the mean.
    pub band: [f64; 2],
    /// Median over the runs, robust against a few bad ones.
    pub median: f64,
}

/// Measured value with the 95 % confidence interval of the true one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MeasuredValue {
    /// The value.
    pub value: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// Statistics of one coefficient over the runs that determined it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientSummary {
    /// Public name, such as `gyro_x.bias`.
    pub name: String,
    /// Unit of `bias`, `rmse` and `sigma_median`.
    pub unit: String,
    /// Number of runs that determined it; all fields below are over these.
    pub determined: usize,
    /// Mean error.
    pub bias: Option<f64>,
    /// Standard error of `bias`.
    pub bias_standard_error: Option<f64>,
    /// Root mean square error.
    pub rmse: Option<f64>,
    /// Median of the reported standard deviations.
    pub sigma_median: Option<f64>,
    /// Root mean square of error over reported standard deviation; its expectation is 1.
    pub rmse_over_sigma: Option<MeasuredValue>,
    /// Root mean square of error over Cramér–Rao bound; `None` unless every run has a bound.
    pub rmse_over_bound: Option<MeasuredValue>,
    /// Fraction of the runs whose reported 95 % interval covers the truth.
    pub coverage: Option<MeasuredValue>,
}

impl BandedMean {
    /// `true` if the mean lies in the band.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.band[0] <= self.mean && self.mean <= self.band[1]
    }

    /// Mean over runs, each with a sum of normalised squares, its degrees of freedom, and the number of squares that
    /// it is averaged over; `None` without a degree of freedom.
    fn of(runs: &[[f64; 3]]) -> Option<Self> {
        let total = |which: usize| runs.iter().map(|run| run[which]).sum::<f64>();
        let [squares, degrees, parts] = [0, 1, 2].map(total);
        let each = runs.iter().filter(|run| run[2] > 0.0);
        let each: Vec<f64> = each.map(|run| run[0] / run[2]).collect();
        (degrees > 0.0 && parts > 0.0).then(|| Self {
            mean: squares / parts,
            expected: degrees / parts,
            band: mean_square_band(degrees, parts, BAND),
            median: median(&each),
        })
    }
}

impl MeasuredValue {
    fn share(outcomes: impl IntoIterator<Item = bool>) -> Option<Self> {
        let proportion = Proportion::of(outcomes);
        (proportion.trials > 0).then(|| Self {
            value: proportion.share(),
            interval: proportion.interval(CONFIDENCE),
        })
    }

    fn ratio(in_sigmas: &[f64]) -> Option<Self> {
        (!in_sigmas.is_empty()).then(|| {
            let value = root_mean_square(in_sigmas);
            Self {
                value,
                interval: rms_ratio_interval(value, in_sigmas.len(), CONFIDENCE),
            }
        })
    }
}

impl CalibrationSummary {
    /// Statistics of the outcome of a campaign of trials.
    #[must_use]
    pub fn of(outcome: &Outcome<CalibrationTrial>) -> Self {
        let trials: Vec<&CalibrationTrial> = outcome.successes().map(|(_, trial)| trial).collect();
        let banded = |of: fn(&CalibrationTrial) -> [f64; 3]| {
            BandedMean::of(&trials.iter().map(|trial| of(trial)).collect::<Vec<_>>())
        };
        let named = Coefficients::NONE.named().into_iter().enumerate();
        let of = |(index, (name, _, unit))| coefficient(&trials, index, name, unit);
        Self {
            runs: trials.len(),
            failures: outcome.failures().collect(),
            nees_determined: banded(|trial| {
                let determined = trial.determined.iter().filter(|yes| **yes);
                [trial.nees_determined, determined.count() as f64, 1.0]
            }),
            nees: banded(|trial| [trial.nees, 9.0, 1.0]),
            nis: banded(|trial| [trial.nis_sum, trial.values as f64, trial.rows as f64]),
            consistent: MeasuredValue::share(trials.iter().map(|trial| trial.consistent)),
            coefficients: named.map(of).collect(),
        }
    }
}

fn coefficient(
    trials: &[&CalibrationTrial],
    index: usize,
    name: &str,
    unit: &str,
) -> CoefficientSummary {
    let determined = trials.iter().filter(|trial| trial.determined[index]);
    let determined: Vec<&CalibrationTrial> = determined.copied().collect();
    let errors: Vec<f64> = determined.iter().map(|trial| trial.error[index]).collect();
    let sigmas: Vec<f64> = determined.iter().map(|trial| trial.sigma[index]).collect();
    let over = |(error, sigma): (&f64, &f64)| error / sigma;
    let in_sigmas: Vec<f64> = errors.iter().zip(&sigmas).map(over).collect();
    let bound = |trial: &&CalibrationTrial| Some(trial.bound_sigma?[index]);
    let bounds: Option<Vec<f64>> = determined.iter().map(bound).collect();
    let bounds = bounds.unwrap_or_default();
    let in_bounds: Vec<f64> = errors.iter().zip(&bounds).map(over).collect();
    // Without values these are NaN, which JSON does not have.
    let finite = |value: f64| value.is_finite().then_some(value);
    CoefficientSummary {
        name: name.to_owned(),
        unit: unit.to_owned(),
        determined: determined.len(),
        bias: finite(mean(&errors)),
        bias_standard_error: finite(standard_error(&errors)),
        rmse: finite(root_mean_square(&errors)),
        sigma_median: finite(median(&sigmas)),
        rmse_over_sigma: MeasuredValue::ratio(&in_sigmas),
        rmse_over_bound: MeasuredValue::ratio(&in_bounds),
        coverage: MeasuredValue::share(in_sigmas.iter().map(|error| error.abs() <= NORMAL_97_5)),
    }
}
