//! The paper's three days, against the errors of its filter in another simulation of them.

use gyrocal_calibration::{Options, calibrate};
use gyrocal_statistics::root_mean_square;
use gyrocal_truth::{Coefficients, Scenario, simulate};
use rayon::prelude::*;

use super::{Error, names};
use crate::figure::Figure;

/// Errors of the paper's filter on one record made by its own rule, in % of each coefficient: from an
/// independent simulation of the paper's experiment, one draw. The paper's Table 2 is another draw,
/// whose printed numbers are not in this repository.
const OTHER_PERCENT: [f64; 9] = [0.01, -0.03, -0.14, -0.05, 0.84, -1.59, 0.01, 0.00, -0.23];

/// Half a digit of these errors: a zero among them is not larger.
const HALF_A_DIGIT: f64 = 0.005;

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let last = if small { 12 } else { 60 };
    let percent = (1..=last)
        .into_par_iter()
        .map(|seed| {
            let scenario = Scenario {
                seed,
                coefficients: Coefficients::PAPER_LIKE,
                ..Scenario::default()
            };
            let simulation = simulate(&scenario)?;
            let options = Options::default();
            let found = calibrate(&simulation.record, &simulation.bench, &options, |_| ())?;
            let estimates = found.drift.to_array();
            let truth = simulation.truth.coefficients.named();
            Ok(core::array::from_fn(|i| {
                let (_, value, _) = truth[i];
                100.0 * (estimates[i] - value) / value
            }))
        })
        .collect::<Result<Vec<[f64; 9]>, Error>>()?;
    Ok(names()
        .into_iter()
        .enumerate()
        .map(|(i, name)| {
            let errors: Vec<f64> = percent.iter().map(|run| run[i]).collect();
            let ours = root_mean_square(&errors);
            let other = OTHER_PERCENT[i].abs();
            let ratio = if other == 0.0 {
                format!("at least {:.2} of less than {HALF_A_DIGIT} %", ours / HALF_A_DIGIT)
            } else {
                format!("{:.2} of {other} %", ours / other)
            };
            Figure::note(
                &format!(
                    "three days, {name}: RMS error in %, and its ratio to the paper's filter, one draw"
                ),
                format!("{ours:.4}, {ratio}"),
            )
            .over(errors.len(), format!("1 to {last}"))
        })
        .collect())
}
