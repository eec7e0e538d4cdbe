//! What many trials say together.

use gyrocal_statistics::{
    NORMAL_97_5, Proportion, mean, mean_square_band, median, rms_ratio_interval, root_mean_square,
    standard_error,
};
use gyrocal_truth::Coefficients;
use serde::{Deserialize, Serialize};

use crate::campaign::Outcome;
use crate::trial::Trial;

/// Probability of the bands of NEES and NIS.
const BAND: f64 = 0.999;
/// Confidence of the intervals of ratios and shares.
const CONFIDENCE: f64 = 0.95;

/// The estimator over all runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Runs that gave a calibration.
    pub runs: usize,
    /// Runs that gave none.
    pub failures: Vec<Failure>,
    /// NEES of the determined coefficients; `None` if no run determined one.
    pub nees_determined: Option<Banded>,
    /// NEES of all nine. Its band presumes that the truth was drawn from the prior: a smaller
    /// truth lowers it where the prior takes part.
    pub nees: Option<Banded>,
    /// NIS of a row.
    pub nis: Option<Banded>,
    /// Share of the runs whose own NIS lies in its 99.9 % band.
    pub consistent: Option<Measured>,
    /// Coefficient by coefficient.
    pub coefficients: Vec<CoefficientSummary>,
}

/// A run without a calibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Failure {
    /// Its seed.
    pub seed: u64,
    /// Why.
    pub message: String,
}

/// A mean of normalised squares with the band that holds it if the covariances are right.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Banded {
    /// The mean.
    pub mean: f64,
    /// What it should be.
    pub expected: f64,
    /// The interval that holds the mean with probability 99.9 %.
    pub band: [f64; 2],
    /// Median over the runs, which a few bad ones do not move.
    pub median: f64,
}

/// A measured figure and the 95 % interval of the true one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// As measured.
    pub value: f64,
    /// 95 % interval.
    pub interval: [f64; 2],
}

/// One coefficient over the runs that determined it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CoefficientSummary {
    /// Public name, such as `gyro_x.bias`.
    pub name: String,
    /// Unit of bias, RMSE and sigma.
    pub unit: String,
    /// Runs that determined it; the figures below are theirs.
    pub determined: usize,
    /// Mean error.
    pub bias: Option<f64>,
    /// Standard error of `bias`.
    pub bias_standard_error: Option<f64>,
    /// Root mean square error.
    pub rmse: Option<f64>,
    /// Median of the reported standard deviations.
    pub sigma_median: Option<f64>,
    /// Root mean square of error over reported standard deviation; 1 is expected.
    pub rmse_over_sigma: Option<Measured>,
    /// Root mean square of error over Cramér–Rao bound; `None` if it is not known of every run.
    pub rmse_over_bound: Option<Measured>,
    /// Share of the runs whose reported 95 % interval holds the truth.
    pub coverage: Option<Measured>,
}

impl Banded {
    /// Whether the mean lies in the band.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.band[0] <= self.mean && self.mean <= self.band[1]
    }

    /// Of sums of squares, their degrees of freedom, and in how many parts they count; `None`
    /// without a degree of freedom.
    fn of(runs: &[(f64, usize, usize)]) -> Option<Self> {
        let squares: f64 = runs.iter().map(|run| run.0).sum();
        let degrees: usize = runs.iter().map(|run| run.1).sum();
        let parts: usize = runs.iter().map(|run| run.2).sum();
        let each: Vec<f64> = runs
            .iter()
            .filter(|run| run.2 > 0)
            .map(|run| run.0 / run.2 as f64)
            .collect();
        (degrees > 0 && parts > 0).then(|| Self {
            mean: squares / parts as f64,
            expected: degrees as f64 / parts as f64,
            band: mean_square_band(degrees as f64, parts as f64, BAND),
            median: median(&each),
        })
    }
}

impl Measured {
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

impl Summary {
    /// What the outcome of a campaign of trials says. It depends on nothing but that.
    #[must_use]
    pub fn of(outcome: &Outcome<Trial>) -> Self {
        let trials: Vec<&Trial> = outcome.successes().map(|(_, trial)| trial).collect();
        let banded = |of: fn(&Trial) -> (f64, usize, usize)| {
            Banded::of(&trials.iter().map(|trial| of(trial)).collect::<Vec<_>>())
        };
        Self {
            runs: trials.len(),
            failures: outcome
                .failures()
                .map(|(seed, message)| Failure {
                    seed,
                    message: message.to_owned(),
                })
                .collect(),
            nees_determined: banded(|trial| {
                let determined = trial.determined.iter().filter(|yes| **yes).count();
                (trial.nees_determined, determined, 1)
            }),
            nees: banded(|trial| (trial.nees, 9, 1)),
            nis: banded(|trial| (trial.nis_sum, trial.values, trial.rows)),
            consistent: Measured::share(trials.iter().map(|trial| trial.consistent)),
            coefficients: Coefficients::NONE
                .named()
                .iter()
                .enumerate()
                .map(|(index, (name, _, unit))| coefficient(&trials, index, name, unit))
                .collect(),
        }
    }
}

fn coefficient(trials: &[&Trial], index: usize, name: &str, unit: &str) -> CoefficientSummary {
    let determined: Vec<&Trial> = trials
        .iter()
        .filter(|trial| trial.determined[index])
        .copied()
        .collect();
    let errors: Vec<f64> = determined.iter().map(|trial| trial.error[index]).collect();
    let sigmas: Vec<f64> = determined.iter().map(|trial| trial.sigma[index]).collect();
    let over = |sigma: &dyn Fn(&Trial) -> Option<f64>| {
        determined
            .iter()
            .map(|trial| Some(trial.error[index] / sigma(trial)?))
            .collect::<Option<Vec<f64>>>()
    };
    let in_sigmas = over(&|trial| Some(trial.sigma[index])).unwrap_or_default();
    let in_bounds = over(&|trial| Some(trial.bound_sigma?[index])).unwrap_or_default();
    // Without values these are NaN, which JSON has not.
    let finite = |value: f64| value.is_finite().then_some(value);
    CoefficientSummary {
        name: name.to_owned(),
        unit: unit.to_owned(),
        determined: determined.len(),
        bias: finite(mean(&errors)),
        bias_standard_error: finite(standard_error(&errors)),
        rmse: finite(root_mean_square(&errors)),
        sigma_median: finite(median(&sigmas)),
        rmse_over_sigma: Measured::ratio(&in_sigmas),
        rmse_over_bound: Measured::ratio(&in_bounds),
        coverage: Measured::share(in_sigmas.iter().map(|error| error.abs() <= NORMAL_97_5)),
    }
}
