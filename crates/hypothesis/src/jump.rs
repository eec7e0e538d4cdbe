//! The test of a sudden change of the moving states in every step of a record.

use gyrocal_statistics::math::ln;
use gyrocal_statistics::{chi_square_equivalent, ln_chi_square_tail};
use nalgebra::Cholesky;

use crate::model::StateJump;
use crate::rows::Rows;

/// The most significant jump of the states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BestJump {
    /// Time of the row that ends the step, since the first row, s.
    pub(crate) onset_s: f64,
    /// Chi-square with as many degrees of freedom as there are states, in a step without a jump.
    pub(crate) statistic: f64,
    /// Value of chi-square with one degree of freedom that is as rare as the largest of all steps:
    /// comparable with a hypothesis of one signature.
    pub(crate) equivalent: f64,
}

/// The most significant of all steps.
pub(crate) fn best_jump(jumps: &[Option<StateJump>], rows: &Rows) -> Option<BestJump> {
    let states = jumps.iter().flatten().next()?.score.len();
    let statistics: Vec<Option<f64>> = jumps
        .iter()
        .map(|jump| {
            let jump = jump.as_ref()?;
            let solved = Cholesky::new(jump.information.clone())?.solve(&jump.score);
            Some(solved.dot(&jump.score))
        })
        .collect();
    let (row, statistic) = statistics
        .iter()
        .enumerate()
        .filter_map(|(row, statistic)| Some((row, (*statistic)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    // Neighbouring steps are nearly one: as many independent tests as the series has peaks.
    let peaks = statistics
        .windows(3)
        .filter(|window| match window {
            [Some(before), Some(here), Some(after)] => here > before && here >= after,
            _ => false,
        })
        .count()
        .max(1);
    let ln_probability = ln(peaks as f64) + ln_chi_square_tail(statistic, states as f64);
    Some(BestJump {
        onset_s: rows.since_first_s(row),
        statistic,
        equivalent: chi_square_equivalent(ln_probability),
    })
}
