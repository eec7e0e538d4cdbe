//! Random scenarios: any attitude, both hemispheres, one to fourteen days.

use gyrocal_calibration::Options;
use gyrocal_truth::{Population, simulate};
use rayon::prelude::*;

use super::Error;
use super::runs::judge;
use crate::figure::Figure;

/// Seeds of the populations, fixed beforehand.
const CONSISTENCY_SEED: u64 = 20_150_902;
const COVERAGE_SEED: u64 = 20_150_903;

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    Ok(vec![
        consistency(if small { 60 } else { 1000 })?,
        coverage(if small { 60 } else { 200 })?,
    ])
}

/// Mean NEES of the streaming filter.
fn consistency(runs: u64) -> Result<Figure, Error> {
    let population = Population::new(CONSISTENCY_SEED);
    let nees = (0..runs)
        .into_par_iter()
        .map(|number| {
            judge(
                &simulate(&population.scenario(number))?,
                &Options::streaming(),
            )?
            .nees()
        })
        .collect::<Result<Vec<f64>, Error>>()?;
    let mean = nees.iter().sum::<f64>() / nees.len() as f64;
    let mut sorted = nees;
    sorted.sort_by(f64::total_cmp);
    let mut figure = Figure::within(
        "random scenarios, streaming filter: mean NEES (9 expected)",
        [0.0, 12.0],
        mean,
    );
    figure.measured += &format!(" (median {:.2})", sorted[sorted.len() / 2]);
    Ok(figure.over(
        sorted.len(),
        format!("population {CONSISTENCY_SEED}, 0 to {}", runs - 1),
    ))
}

/// Fraction of coefficients within 3.5 of their sigmas.
fn coverage(runs: u64) -> Result<Figure, Error> {
    let population = Population::new(COVERAGE_SEED);
    let inside = (0..runs)
        .into_par_iter()
        .map(|number| {
            let judged = judge(
                &simulate(&population.scenario(number))?,
                &Options::streaming(),
            )?;
            Ok(judged
                .in_sigmas()
                .iter()
                .filter(|error| error.abs() <= 3.5)
                .count())
        })
        .collect::<Result<Vec<usize>, Error>>()?;
    let total = 9 * inside.len();
    let share = 100.0 * inside.iter().sum::<usize>() as f64 / total as f64;
    Ok(Figure::within(
        "clean records: % of coefficients within 3.5 sigmas",
        [99.5, 100.0],
        share,
    )
    .over(
        inside.len(),
        format!("population {COVERAGE_SEED}, 0 to {}", runs - 1),
    ))
}
