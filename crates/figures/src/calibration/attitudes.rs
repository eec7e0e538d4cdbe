//! Information of a second record at another attitude.

use gyrocal_calibration::{Calibration, Options, Run, calibrate_runs};
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};

use super::{Error, names};
use crate::figure::Figure;

const ONE_DEG: [f64; 3] = [0.0; 3];
const OTHER_DEG: [f64; 3] = [90.0, 45.0, 0.0];

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let scenario = |seed, days: f64, angles_deg| Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::AnglesDeg(angles_deg),
        duration_s: days * 86_400.0,
        ..Scenario::default()
    };
    let one = [scenario(1, 2.0, ONE_DEG)];
    let long = [scenario(1, 4.0, ONE_DEG)];
    let both = [scenario(1, 2.0, ONE_DEG), scenario(2, 2.0, OTHER_DEG)];
    let sigmas = |scenarios: &[Scenario]| -> Result<[f64; 9], Error> {
        let found = together(scenarios)?;
        Ok(core::array::from_fn(|i| found.covariance[i][i].sqrt()))
    };
    let (one, long, both) = (sigmas(&one)?, sigmas(&long)?, sigmas(&both)?);
    let mut figures: Vec<Figure> = names()
        .into_iter()
        .enumerate()
        .map(|(i, name)| {
            Figure::note(
                &format!(
                    "{name}: sigma of two days, of four, of two and two from another attitude"
                ),
                format!(
                    "{:.2e}, {:.2e}, {:.2e} ({:.2} and {:.2} of the first)",
                    one[i],
                    long[i],
                    both[i],
                    long[i] / one[i],
                    both[i] / one[i]
                ),
            )
        })
        .collect();
    let geometric =
        |ratio: &dyn Fn(usize) -> f64| ((0..9).map(|i| ratio(i).ln()).sum::<f64>() / 9.0).exp();
    // Twice the data of one kind would give 0.71.
    figures.push(Figure::within(
        "sigma with a second attitude over sigma of one, geometric mean",
        [0.0, 0.71],
        geometric(&|i| both[i] / one[i]),
    ));
    figures.push(Figure::within(
        "sigma with a second attitude over sigma of as long a record, geometric mean",
        [0.0, 1.0],
        geometric(&|i| both[i] / long[i]),
    ));
    Ok(figures
        .into_iter()
        .map(|figure| figure.over(1, "1 and 2"))
        .collect())
}

fn together(scenarios: &[Scenario]) -> Result<Calibration, Error> {
    let simulations = scenarios
        .iter()
        .map(simulate)
        .collect::<Result<Vec<_>, _>>()?;
    let runs: Vec<Run<'_>> = simulations
        .iter()
        .map(|simulation| Run {
            record: &simulation.record,
            bench: &simulation.bench,
        })
        .collect();
    Ok(calibrate_runs(&runs, &Options::default(), |_| ())?)
}
