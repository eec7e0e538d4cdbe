//! Statistics of the calibration over many trials.

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

/// Normalised squares of one run.
#[derive(Clone, Copy)]
struct SumOfSquares {
    sum: f64,
    /// Degrees of freedom of the sum.
    degrees: usize,
    /// Number of squares that the sum is averaged over.
    parts: usize,
}

impl BandedMean {
    /// `true` if the mean lies in the band.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.band[0] <= self.mean && self.mean <= self.band[1]
    }

    /// Mean over runs; `None` without a degree of freedom.
    fn of(runs: &[SumOfSquares]) -> Option<Self> {
        let squares: f64 = runs.iter().map(|run| run.sum).sum();
        let degrees: usize = runs.iter().map(|run| run.degrees).sum();
        let parts: usize = runs.iter().map(|run| run.parts).sum();
        let each: Vec<f64> = runs
            .iter()
            .filter(|run| run.parts > 0)
            .map(|run| run.sum / run.parts as f64)
            .collect();
        (degrees > 0 && parts > 0).then(|| Self {
            mean: squares / parts as f64,
            expected: degrees as f64 / parts as f64,
            band: mean_square_band(degrees as f64, parts as f64, BAND),
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
        let banded = |of: fn(&CalibrationTrial) -> SumOfSquares| {
            BandedMean::of(&trials.iter().map(|trial| of(trial)).collect::<Vec<_>>())
        };
        Self {
            runs: trials.len(),
            failures: outcome.failures().collect(),
            nees_determined: banded(|trial| SumOfSquares {
                sum: trial.nees_determined,
                degrees: trial.determined.iter().filter(|yes| **yes).count(),
                parts: 1,
            }),
            nees: banded(|trial| SumOfSquares {
                sum: trial.nees,
                degrees: 9,
                parts: 1,
            }),
            nis: banded(|trial| SumOfSquares {
                sum: trial.nis_sum,
                degrees: trial.values,
                parts: trial.rows,
            }),
            consistent: MeasuredValue::share(trials.iter().map(|trial| trial.consistent)),
            coefficients: Coefficients::NONE
                .named()
                .iter()
                .enumerate()
                .map(|(index, (name, _, unit))| coefficient(&trials, index, name, unit))
                .collect(),
        }
    }
}

fn coefficient(
    trials: &[&CalibrationTrial],
    index: usize,
    name: &str,
    unit: &str,
) -> CoefficientSummary {
    let determined: Vec<&CalibrationTrial> = trials
        .iter()
        .filter(|trial| trial.determined[index])
        .copied()
        .collect();
    let errors: Vec<f64> = determined.iter().map(|trial| trial.error[index]).collect();
    let sigmas: Vec<f64> = determined.iter().map(|trial| trial.sigma[index]).collect();
    let over = |sigma: &dyn Fn(&CalibrationTrial) -> Option<f64>| {
        determined
            .iter()
            .map(|trial| Some(trial.error[index] / sigma(trial)?))
            .collect::<Option<Vec<f64>>>()
    };
    let in_sigmas = over(&|trial| Some(trial.sigma[index])).unwrap_or_default();
    let in_bounds = over(&|trial| Some(trial.bound_sigma?[index])).unwrap_or_default();
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
