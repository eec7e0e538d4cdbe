//! The uncertainty budget against simulated and calibrated runs.

use gyrocal_calibration::{
    Options, UncertaintyBudget, UncertaintySource, calibrate_with_budget, spread,
};
use gyrocal_evaluation::run_of;
use gyrocal_record::{Prior, SiteUncertainty};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::names;
use crate::harness::{CALIBRATION, Context, Error, Figure, Population, Row, Sources, of};

const SOURCES: Sources = of(CALIBRATION, &[file!()]);

/// Runs of each platform whose scatter is looked at.
const RUNS_OF_PLATFORM: u64 = 4;

/// Scatter of the constant drifts over turn-ons that a bench does not declare, deg/h: ten times the usual
/// uncertainty of a constant drift.
const TURN_ON_DEG_PER_H: f64 = 0.05;

const SQUARES: [f64; 2] = [0.97, 1.03];
const SQUARES_REASON: &str = "the square of what is stated, within 3 %";

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let drawn = "coefficients from the prior";
    let fixed = "the same coefficients in every run";
    let trials = |name, first, from| {
        let job = move |seed| BudgetTrial::of(seed, from);
        Population::new(name, [first, 5000, 40], SOURCES, job)
    };
    let from = TrueCoefficients::FromPrior;
    let mut figures = context.measure(&trials(drawn, 2_130_000, from), &of_drawn(drawn))?;
    let from = TrueCoefficients::Fixed(Coefficients::PAPER_LIKE);
    figures.extend(context.measure(&trials(fixed, 2_140_000, from), &of_fixed(fixed))?);
    let stable = "four runs of a stable platform";
    let scattered = "four runs, turn-ons scatter by 0.05 deg/h undeclared";
    let level = "the level of the test, of all coefficients together";
    let spreads = |name, first, turn_on| {
        let job = move |seed| SpreadTrial::of(seed, RUNS_OF_PLATFORM, turn_on);
        Population::new(name, [first, 500, 6], SOURCES, job)
    };
    let row = |name| {
        let what = format!("{name}: share with a scatter larger than the uncertainties");
        Row::share(what, |trial: &SpreadTrial| Some(trial.is_larger))
    };
    let row_of_stable = row(stable).at_most(0.01, level);
    let row = row(scattered).at_least(0.99, "ten times the uncertainty cannot be missed");
    figures.extend(context.measure(&spreads(stable, 2_150_000, 0.0), &[row_of_stable])?);
    let scattered = spreads(scattered, 2_160_000, TURN_ON_DEG_PER_H);
    figures.extend(context.measure(&scattered, &[row])?);
    Ok(figures)
}

/// Truths from the prior: the budget's claim.
fn of_drawn(name: &str) -> Vec<Row<'static, BudgetTrial>> {
    let held = |trial: &BudgetTrial, i: usize| trial.error[i].abs() <= trial.expanded[i];
    let of_all = move |trial: &BudgetTrial| (0..9).map(|i| held(trial, i)).collect::<Vec<_>>();
    let all = format!("{name}: share of all 95 % intervals that hold the truth");
    let mut rows = vec![Row::each(all, of_all).of_coverage()];
    for (i, coefficient) in names() {
        let square = move |trial: &BudgetTrial| Some((trial.error[i] / trial.combined[i]).powi(2));
        let name = |what: &str| format!("{name}: {coefficient}: {what}");
        let held = move |trial: &BudgetTrial| Some(held(trial, i));
        let squares = name("mean square error / combined uncertainty squared");
        let intervals = name("share of 95 % intervals that hold the truth");
        rows.extend([
            Row::mean(squares, square).between(SQUARES, SQUARES_REASON),
            Row::share(intervals, held).of_coverage(),
        ]);
    }
    rows
}

/// One truth in every run: what the budget says of the errors for it.
fn of_fixed(name: &str) -> Vec<Row<'static, BudgetTrial>> {
    let row = |(i, coefficient)| {
        let square =
            move |trial: &BudgetTrial| Some(f64::powi(trial.error[i], 2) / trial.of_this_truth[i]);
        let what = "mean square error / that expected of this truth";
        Row::mean(format!("{name}: {coefficient}: {what}"), square).between(SQUARES, SQUARES_REASON)
    };
    names().map(row).collect()
}

/// Purposes of the streams of a seed.
const BENCH: u64 = 0;
const TRUTH: u64 = 1;

/// Ranges of what benches declare, uniform in the logarithm: sigmas of the priors of constant drift, mass
/// unbalance and square term, noise of accelerometers and gyros, sigmas of the angles, of latitude, Earth
/// rate and gravity.
const BIAS_DEG_PER_H: [f64; 2] = [0.3, 1.0];
const G_DEG_PER_H_PER_G: [f64; 2] = [0.1, 0.5];
const GG_DEG_PER_H_PER_G2: [f64; 2] = [0.05, 0.3];
const ACCEL_NOISE_G: [f64; 2] = [5e-6, 2e-5];
const GYRO_NOISE_DEG_PER_H: [f64; 2] = [1e-3, 4e-3];
const ANGLES_DEG: [f64; 2] = [0.005, 0.05];
const LATITUDE_DEG: [f64; 2] = [0.003, 0.03];
const EARTH_RATE: [f64; 2] = [1e-4, 1e-3];
const GRAVITY: [f64; 2] = [3e-6, 3e-5];

/// Largest latitude.
const LARGEST_LATITUDE_DEG: f64 = 70.0;

/// Length of the records, and time between rows.
const DURATION_S: [f64; 2] = [86_400.0, 345_600.0];
const INTERVAL_S: f64 = 300.0;

/// Where the true coefficients come from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum TrueCoefficients {
    /// The prior that the bench declares.
    FromPrior,
    /// The same in every trial.
    Fixed(Coefficients),
}

/// Errors of one calibration and what its budget says of them. Arrays are in the order of
/// [`Coefficients::named`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct BudgetTrial {
    /// Estimate minus truth.
    error: [f64; 9],
    /// Combined standard uncertainties.
    combined: [f64; 9],
    /// Expanded uncertainties.
    expanded: [f64; 9],
    /// Mean square of the error for these true coefficients: the contributions without the prior, and
    /// the distance from its mean times the sensitivity to it.
    of_this_truth: [f64; 9],
}

impl BudgetTrial {
    /// Draws bench, site, attitude, noise and, by `from`, coefficients from a seed; simulates, calibrates,
    /// compares.
    fn of(seed: u64, from: TrueCoefficients) -> Result<Self, Error> {
        let platform = DrawnPlatform::new(seed, from);
        let (simulation, budget) = platform.calibrated(platform.scenario(seed))?;
        let truth = simulation.truth.coefficients.named();
        let error = |i: usize| budget.coefficients[i].estimate - truth[i].1;
        let of_this_truth = |i: usize| {
            let one = &budget.coefficients[i];
            let is_prior = |source| matches!(source, UncertaintySource::Prior(_));
            let pulls = one.contributions.iter().map(|line| match line.source {
                UncertaintySource::Prior(of) => line.sensitivity * truth[of].1,
                _ => 0.0,
            });
            one.part(|source| !is_prior(source)).powi(2) + pulls.sum::<f64>().powi(2)
        };
        Ok(Self {
            error: core::array::from_fn(error),
            combined: core::array::from_fn(|i| budget.coefficients[i].combined),
            expanded: core::array::from_fn(|i| budget.coefficients[i].expanded()),
            of_this_truth: core::array::from_fn(of_this_truth),
        })
    }
}

/// Several calibrations of one platform, each with another attitude and other noise, and whether their
/// scatter is said to be larger than the uncertainties.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct SpreadTrial {
    /// Of any coefficient.
    is_larger: bool,
}

impl SpreadTrial {
    /// Draws a platform from a seed and calibrates it in `runs` turn-ons. Constant drifts differ between
    /// them by `turn_on_deg_per_h`, which the bench does not declare.
    fn of(seed: u64, runs: u64, turn_on_deg_per_h: f64) -> Result<Self, Error> {
        let platform = DrawnPlatform::new(seed, TrueCoefficients::FromPrior);
        let mut draw = Draw::new(seed, TRUTH + 1);
        let mut budgets = Vec::new();
        for run in 0..runs {
            let mut scenario = platform.scenario(seed * runs + run);
            for bias in &mut scenario.coefficients.bias_deg_per_h {
                *bias += turn_on_deg_per_h * draw.normal();
            }
            budgets.push(platform.calibrated(scenario)?.1);
        }
        let coefficients = spread(&budgets).map_or(Vec::new(), |found| found.coefficients);
        Ok(Self {
            is_larger: coefficients.iter().any(|one| one.is_larger),
        })
    }
}

/// A platform on its bench.
struct DrawnPlatform {
    scenario: Scenario,
    uncertainty: SiteUncertainty,
    /// Errors of latitude, Earth rate and gravity.
    site: [(&'static str, f64); 3],
}

impl DrawnPlatform {
    fn new(seed: u64, from: TrueCoefficients) -> Self {
        let (mut bench, mut truth) = (Draw::new(seed, BENCH), Draw::new(seed, TRUTH));
        let mut between = |range: [f64; 2]| bench.log_uniform(range);
        let prior = Prior {
            bias_sigma_deg_per_h: [between(BIAS_DEG_PER_H); 3],
            g_sigma_deg_per_h_per_g: [between(G_DEG_PER_H_PER_G); 3],
            gg_sigma_deg_per_h_per_g2: [between(GG_DEG_PER_H_PER_G2); 3],
            ..Prior::default()
        };
        let [accel_noise_g, gyro_noise_deg_per_h] =
            [ACCEL_NOISE_G, GYRO_NOISE_DEG_PER_H].map(&mut between);
        let angles_deg = between(ANGLES_DEG);
        let [latitude, rate, gravity] = [LATITUDE_DEG, EARTH_RATE, GRAVITY].map(&mut between);
        let duration_s = (between(DURATION_S) / INTERVAL_S).floor() * INTERVAL_S;
        let latitude_deg = LARGEST_LATITUDE_DEG * (2.0 * bench.uniform() - 1.0);
        let mut drawn = |sigmas: [f64; 3]| sigmas.map(|sigma| sigma * truth.normal());
        let [latitude_error, rate_error, gravity_error] = drawn([latitude, rate, gravity]);
        let coefficients = match from {
            TrueCoefficients::Fixed(coefficients) => coefficients,
            TrueCoefficients::FromPrior => Coefficients {
                bias_deg_per_h: drawn(prior.bias_sigma_deg_per_h),
                g_deg_per_h_per_g: drawn(prior.g_sigma_deg_per_h_per_g),
                gg_deg_per_h_per_g2: drawn(prior.gg_sigma_deg_per_h_per_g2),
            },
        };
        Self {
            scenario: Scenario {
                latitude_deg,
                coefficients,
                initial: InitialAttitude::Random,
                initial_angles_sigma_deg: [angles_deg; 3],
                accel_noise_g,
                gyro_noise_deg_per_h,
                prior,
                interval_s: INTERVAL_S,
                duration_s,
                ..Scenario::default()
            },
            uncertainty: SiteUncertainty {
                latitude_sigma_deg: Some(latitude),
                earth_rate_relative_sigma: Some(rate),
                gravity_relative_sigma: Some(gravity),
            },
            site: [
                ("site.latitude", latitude_error),
                ("site.earth_rate", rate_error),
                ("site.gravity", gravity_error),
            ],
        }
    }

    /// A run: attitude and noise are of the seed.
    fn scenario(&self, seed: u64) -> Scenario {
        Scenario {
            seed,
            ..self.scenario.clone()
        }
    }

    fn calibrated(&self, mut scenario: Scenario) -> Result<(Simulation, UncertaintyBudget), Error> {
        for (id, size) in self.site {
            scenario.hidden.push(Hidden::new(id, &[("size", size)])?);
        }
        let mut simulation = simulate(&scenario)?;
        simulation.bench.uncertainty = self.uncertainty;
        let runs = [run_of(&simulation)];
        let (_, budget) = calibrate_with_budget(&runs, &Options::default())?;
        Ok((simulation, budget))
    }
}
