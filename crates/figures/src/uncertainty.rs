//! The uncertainty budget against simulated and calibrated runs.

use gyrocal_evaluation::{BudgetTrial, Outcome, SpreadTrial, TrueCoefficients};
use gyrocal_statistics::{Proportion, mean, mean_square_band};
use gyrocal_truth::Coefficients;

use crate::error::Error;
use crate::figure::{Figure, coverage};
use crate::resumable;
use crate::truth::Extent;

/// First seed of each population. Seeds from 7 000 000 on were those of the work on the budget.
const FROM_PRIOR: u64 = 2_130_000;
const FIXED: u64 = 2_140_000;
const STABLE: u64 = 2_150_000;
const SCATTERING: u64 = 2_160_000;

/// Runs of the populations of one run each, in the full and in the small version.
const RUNS: u64 = 5000;
const FEW_RUNS: u64 = 60;

/// Platforms of the populations of several runs each, and the runs of each.
const PLATFORMS: u64 = 500;
const FEW_PLATFORMS: u64 = 10;
const RUNS_OF_PLATFORM: u64 = 4;

/// Scatter of the constant drifts over turn-ons that a bench does not declare, deg/h: ten times the usual
/// uncertainty of a constant drift.
const TURN_ON_DEG_PER_H: f64 = 0.05;

/// Coverage of 95 % intervals.
const COVERAGE: [f64; 2] = [0.93, 0.97];

/// Probability of the band of a mean square.
const BAND: f64 = 0.999;

/// All figures of the topic.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = of_drawn(extent)?;
    figures.extend(of_fixed(extent)?);
    figures.extend(of_spread(extent)?);
    Ok(figures)
}

/// Truths from the prior: the budget's claim.
fn of_drawn(extent: Extent) -> Result<Vec<Figure>, Error> {
    let population = "coefficients from the prior";
    let (outcome, seeds) = trials(extent, population, FROM_PRIOR, TrueCoefficients::FromPrior)?;
    let mut figures = vec![failed(population, &outcome, &seeds)];
    for (index, name) in names().into_iter().enumerate() {
        let what = format!(
            "{population}: {name}: mean square error / combined uncertainty squared, 99.9 % band"
        );
        let square = |trial: &BudgetTrial| (trial.error[index] / trial.combined[index]).powi(2);
        figures.push(banded(&what, &outcome, &seeds, square));
    }
    for (index, name) in names().into_iter().enumerate() {
        let what = format!("{population}: {name}: share of 95 % intervals that hold the truth");
        figures.push(covered(&what, &outcome, &seeds, extent, &[index]));
    }
    let all: Vec<usize> = (0..names().len()).collect();
    let what = format!("{population}: share of all 95 % intervals that hold the truth");
    figures.push(covered(&what, &outcome, &seeds, extent, &all));
    Ok(figures)
}

/// One truth in every run: what the budget says of the errors for it.
fn of_fixed(extent: Extent) -> Result<Vec<Figure>, Error> {
    let population = "the same coefficients in every run";
    let fixed = TrueCoefficients::Fixed(Coefficients::PAPER_LIKE);
    let (outcome, seeds) = trials(extent, population, FIXED, fixed)?;
    let mut figures = vec![failed(population, &outcome, &seeds)];
    for (index, name) in names().into_iter().enumerate() {
        let what = format!(
            "{population}: {name}: mean square error / that expected of this truth, 99.9 % band"
        );
        let square = |trial: &BudgetTrial| trial.error[index].powi(2) / trial.of_this_truth[index];
        figures.push(banded(&what, &outcome, &seeds, square));
        let of_all = |trial: &BudgetTrial| (trial.error[index] / trial.combined[index]).powi(2);
        let squares = outcome.successes().map(|(_, trial)| of_all(trial));
        let what = format!("{population}: {name}: the same / combined uncertainty squared");
        let measured = format!("{:.3}", mean(squares));
        figures
            .push(Figure::note(&what, measured).over(outcome.successes().count(), seeds.clone()));
    }
    Ok(figures)
}

/// Scatter over four turn-ons of a platform.
fn of_spread(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (population, first, turn_on) in [
        ("four runs of a stable platform", STABLE, 0.0),
        (
            "four runs, turn-ons scatter by 0.05 deg/h undeclared",
            SCATTERING,
            TURN_ON_DEG_PER_H,
        ),
    ] {
        let count = extent.records(PLATFORMS, FEW_PLATFORMS);
        let range = first..first + count;
        let seeds = format!("{}..{}", range.start, range.end);
        let outcome = resumable::campaign("uncertainty", population, range, extent.small)?.run(
            |seed| SpreadTrial::of(seed, RUNS_OF_PLATFORM, turn_on),
            |_| (),
        )?;
        figures.push(failed(population, &outcome, &seeds));
        let share = Proportion::of(outcome.successes().map(|(_, trial)| trial.is_larger));
        let what = format!("{population}: share with a scatter larger than the uncertainties");
        let (figure, judgement) = match turn_on > 0.0 {
            false => (
                Figure::within(&what, [f64::NEG_INFINITY, 0.03], share.share()),
                share.at_most(0.03),
            ),
            true => (
                Figure::within(&what, [0.99, f64::INFINITY], share.share()),
                share.at_least(0.99),
            ),
        };
        let figure = figure.of_share(share);
        let figure = if extent.small {
            figure.judged(judgement)
        } else {
            figure
        };
        figures.push(figure.over(share.trials as usize, seeds));
    }
    Ok(figures)
}

/// Names of the coefficients.
fn names() -> [&'static str; 9] {
    Coefficients::NONE.named().map(|(name, _, _)| name)
}

fn trials(
    extent: Extent,
    cell: &str,
    first: u64,
    from: TrueCoefficients,
) -> Result<(Outcome<BudgetTrial>, String), Error> {
    let range = first..first + extent.records(RUNS, FEW_RUNS);
    let seeds = format!("{}..{}", range.start, range.end);
    let outcome = resumable::campaign("uncertainty", cell, range, extent.small)?.run(
        |seed| BudgetTrial::of(seed, from),
        |progress| {
            if progress.done % 500 == 0 {
                eprintln!("{cell}: {} of {} runs", progress.done, progress.total);
            }
        },
    )?;
    Ok((outcome, seeds))
}

fn failed<T>(population: &str, outcome: &Outcome<T>, seeds: &str) -> Figure {
    let (failed, whole) = (outcome.failures().count(), outcome.successes().count());
    let what = format!("{population}: runs without a calibration");
    Figure::within(&what, [0.0, 0.0], failed as f64).over(failed + whole, seeds)
}

/// The mean of squares that have one degree of freedom each, in its band.
fn banded(
    what: &str,
    outcome: &Outcome<BudgetTrial>,
    seeds: &str,
    square: impl Fn(&BudgetTrial) -> f64,
) -> Figure {
    let squares: Vec<f64> = outcome
        .successes()
        .map(|(_, trial)| square(trial))
        .collect();
    let runs = squares.len() as f64;
    let [low, high] = mean_square_band(runs, runs, BAND);
    let mut figure = Figure::within(what, [low, high], mean(&squares));
    figure.target = format!("{low:.3} to {high:.3}");
    figure.over(squares.len(), seeds)
}

/// Share of the intervals of some coefficients that hold the truth.
fn covered(
    what: &str,
    outcome: &Outcome<BudgetTrial>,
    seeds: &str,
    extent: Extent,
    of: &[usize],
) -> Figure {
    let covers = |trial: &BudgetTrial, i: usize| trial.error[i].abs() <= trial.expanded[i];
    let hits = outcome
        .successes()
        .flat_map(|(_, trial)| of.iter().map(move |i| covers(trial, *i)));
    let share = Proportion::of(hits);
    let mut figure = Figure::within(what, COVERAGE, share.share()).of_share(share);
    // Intervals of one run are correlated: their number says nothing of the scatter.
    if extent.small && of.len() == 1 {
        figure = figure.judged(coverage(share, COVERAGE));
    } else if extent.small {
        figure.holds = None;
    }
    figure.over(outcome.successes().count(), seeds)
}
