//! The uncertainty budget against simulated and calibrated runs.

use gyrocal_truth::Coefficients;

use super::budget_trial::{self, BudgetTrial, SpreadTrial, TrueCoefficients};
use super::names;
use crate::harness::{
    CALIBRATION, COVERAGE, COVERAGE_REASON, Context, Error, Figure, Population, Row, Sources, of,
};

const SOURCES: Sources = of(CALIBRATION, &[file!(), budget_trial::FILE]);

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
    for (name, first, turn_on) in [
        ("four runs of a stable platform", 2_150_000, 0.0),
        (
            "four runs, turn-ons scatter by 0.05 deg/h undeclared",
            2_160_000,
            TURN_ON_DEG_PER_H,
        ),
    ] {
        let job = move |seed| SpreadTrial::of(seed, RUNS_OF_PLATFORM, turn_on);
        let what = format!("{name}: share with a scatter larger than the uncertainties");
        let row = Row::share(what, |trial: &SpreadTrial| Some(trial.is_larger));
        let row = match turn_on > 0.0 {
            false => row.at_most(0.01, "the level of the test, of all coefficients together"),
            true => row.at_least(0.99, "ten times the uncertainty cannot be missed"),
        };
        figures.extend(context.measure(
            &Population::new(name, [first, 500, 6], SOURCES, job),
            &[row],
        )?);
    }
    Ok(figures)
}

/// Truths from the prior: the budget's claim.
fn of_drawn(name: &str) -> Vec<Row<'static, BudgetTrial>> {
    let held = |trial: &BudgetTrial, i: usize| trial.error[i].abs() <= trial.expanded[i];
    let of_all = move |trial: &BudgetTrial| (0..9).map(|i| held(trial, i)).collect::<Vec<_>>();
    let all = format!("{name}: share of all 95 % intervals that hold the truth");
    let mut rows = vec![Row::each(all, of_all).between(COVERAGE, COVERAGE_REASON)];
    for (i, coefficient) in names() {
        let square = move |trial: &BudgetTrial| Some((trial.error[i] / trial.combined[i]).powi(2));
        let name = |what: &str| format!("{name}: {coefficient}: {what}");
        rows.extend([
            Row::mean(
                name("mean square error / combined uncertainty squared"),
                square,
            )
            .between(SQUARES, SQUARES_REASON),
            Row::share(
                name("share of 95 % intervals that hold the truth"),
                move |trial| Some(held(trial, i)),
            )
            .between(COVERAGE, COVERAGE_REASON),
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
