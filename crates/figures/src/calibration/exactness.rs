//! The batch estimator against least squares on dense matrices.

use gyrocal::Discretisation;
use gyrocal_calibration::{Options, Run, calibrate};
use gyrocal_truth::{Population, simulate};

use super::Error;
use crate::figure::Figure;
use gyrocal_testkit::dense_least_squares::DenseProblem;

/// Largest difference in units of the coefficients' sigmas.
const SIGMAS: f64 = 1e-6;

/// Rows of a record, and how many records.
const ROWS: f64 = 36.0;
const RECORDS: u64 = 8;
const SEED: u64 = 20_150_906;

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let interval_s = 30.0;
    let mut population = Population::new(SEED);
    population.common.interval_s = interval_s;
    population.common.missing_fraction = 0.1;
    population.duration_days = [ROWS * interval_s / 86_400.0; 2];
    let options = Options {
        // Short parts: the two integrate by different rules.
        discretisation: Discretisation {
            longest_step_s: interval_s,
            ..Discretisation::default()
        },
        ..Options::default()
    };
    let (mut estimates, mut sigmas) = (0.0_f64, 0.0_f64);
    for number in 0..RECORDS {
        let mut scenario = population.scenario(number);
        scenario.gaps_s = vec![[10.5 * interval_s, 19.5 * interval_s]];
        let simulation = simulate(&scenario)?;
        let found = calibrate(&simulation.record, &simulation.bench, &options, |_| ())?;
        let run = Run {
            record: &simulation.record,
            bench: &simulation.bench,
        };
        let dense = DenseProblem::new(run, options.discretisation.longest_step_s).solve();
        let drift = found.drift.to_array();
        for (i, (estimate, expected)) in drift.iter().zip(dense.drift).enumerate() {
            let sigma = dense.covariance[(i, i)].sqrt();
            estimates = estimates.max((estimate - expected).abs() / sigma);
            sigmas = sigmas.max((found.covariance[i][i].sqrt() / sigma - 1.0).abs());
        }
    }
    let figure = |name: &str, measured: f64| {
        let mut figure = Figure::within(name, [0.0, SIGMAS], measured);
        figure.target = format!("<= {SIGMAS:e}");
        figure.measured = format!("{measured:.1e}");
        let seeds = format!("population {SEED}, 0 to {}", RECORDS - 1);
        figure.over(RECORDS as usize, seeds)
    };
    Ok(vec![
        figure(
            "short records with a gap: estimates against dense least squares, sigmas",
            estimates,
        ),
        figure("the same: sigmas against its sigmas, relative", sigmas),
    ])
}
