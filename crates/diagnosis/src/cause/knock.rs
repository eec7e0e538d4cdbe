//! A knock: the best step for a sudden change of attitude, and how often chance does as well.

use gyrocal_calibration::Jump;
use gyrocal_record::Record;
use gyrocal_statistics::{chi_square_equivalent, ln_chi_square_tail};
use nalgebra::{Matrix3, Vector3};

/// The step in which a knock would explain most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knock {
    /// Time of the row that ends the step, since the first row, s.
    pub(crate) onset_s: f64,
    /// Chi-square with three degrees of freedom in a step without a knock.
    pub(crate) statistic: f64,
    /// The value of chi-square with one degree of freedom that is as rare as the largest of all
    /// steps: comparable with a family of one signature.
    pub(crate) equivalent: f64,
}

/// Looks for a knock in every step.
pub(crate) fn best(jumps: &[Option<Jump>], record: &Record) -> Option<Knock> {
    let statistics: Vec<Option<f64>> = jumps
        .iter()
        .map(|jump| {
            let jump = (*jump)?;
            let information = Matrix3::from_fn(|i, j| jump.information[i][j]);
            let score = Vector3::from(jump.score);
            let solved = information.cholesky()?.solve(&score);
            Some(solved.dot(&score))
        })
        .collect();
    let (row, statistic) = statistics
        .iter()
        .enumerate()
        .filter_map(|(row, statistic)| Some((row, (*statistic)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    // Neighbouring steps are nearly one: as many chances as the series has peaks.
    let peaks = statistics
        .windows(3)
        .filter(|window| match window {
            [Some(before), Some(here), Some(after)] => here > before && here >= after,
            _ => false,
        })
        .count()
        .max(1);
    let ln_probability = (peaks as f64).ln() + ln_chi_square_tail(statistic, 3.0);
    Some(Knock {
        onset_s: record.time_s[row] - record.time_s[0],
        statistic,
        equivalent: chi_square_equivalent(ln_probability),
    })
}
