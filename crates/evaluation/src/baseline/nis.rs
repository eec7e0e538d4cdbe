//! Test of the mean normalised innovation squared (NIS) over the record, two-sided at 1 %
//! (Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001,
//! 5.4). The nine fitted coefficients take nine of thousands of degrees of freedom, which shifts the
//! mean by less than a tenth of its sigma.

use gyrocal_statistics::nis;

use crate::projection::ProjectedScores;

/// Probability of a false alarm.
const LEVEL: f64 = 0.01;

pub(super) fn detects(scores: &ProjectedScores) -> bool {
    nis(&scores.whitened, LEVEL).is_ok_and(|nis| nis.p_value < LEVEL)
}
