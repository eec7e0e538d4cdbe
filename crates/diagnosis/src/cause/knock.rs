//! A knock: the best step for a sudden change of attitude, and how often chance does as well.

use gyrocal_calibration::{CalibrationError, Extended};
use gyrocal_record::Record;
use nalgebra::{Matrix3, Vector3};
use statrs::distribution::{ChiSquared, ContinuousCDF};

use crate::significance::z_of_two_sided_p;

/// Below it the tails are taken by their asymptotes.
const LEAST_PROBABILITY: f64 = 1e-200;

/// The value u of chi-square with one degree of freedom that is as rare as the largest of `peaks`
/// values t with three: from √(2t/π) exp(-t/2) `peaks` = √(2/(πu)) exp(-u/2).
fn far_equivalent(statistic: f64, peaks: f64) -> f64 {
    let mut value = statistic;
    for _ in 0..4 {
        value = statistic - 2.0 * peaks.ln() - (statistic * value).ln();
    }
    value
}

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
pub(crate) fn best(
    fitted: &Extended<'_>,
    record: &Record,
) -> Result<Option<Knock>, CalibrationError> {
    let statistics: Vec<Option<f64>> = fitted
        .jumps()?
        .into_iter()
        .map(|jump| {
            let jump = jump?;
            let information = Matrix3::from_fn(|i, j| jump.information[i][j]);
            let score = Vector3::from(jump.score);
            let solved = information.cholesky()?.solve(&score);
            Some(solved.dot(&score))
        })
        .collect();
    let found = statistics
        .iter()
        .enumerate()
        .filter_map(|(row, statistic)| Some((row, (*statistic)?)))
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((row, statistic)) = found else {
        return Ok(None);
    };
    // Neighbouring steps are nearly one: as many chances as the series has peaks.
    let peaks = statistics
        .windows(3)
        .filter(|window| match window {
            [Some(before), Some(here), Some(after)] => here > before && here >= after,
            _ => false,
        })
        .count()
        .max(1);
    let Ok(chi_squared) = ChiSquared::new(3.0) else {
        return Ok(None);
    };
    let probability = (peaks as f64 * chi_squared.sf(statistic)).min(1.0);
    Ok(Some(Knock {
        onset_s: record.time_s[row] - record.time_s[0],
        statistic,
        equivalent: if probability > LEAST_PROBABILITY {
            z_of_two_sided_p(probability).powi(2)
        } else {
            far_equivalent(statistic, peaks as f64)
        },
    }))
}
