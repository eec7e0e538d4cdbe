//! Portmanteau test at 1 % over 20 lags, all pairs of axes (Ljung and Box, Biometrika 65, 1978;
//! Hosking's form for several series, 1980). 20 lags are the usual choice for thousands of values.

use gyrocal_statistics::autocorrelation;

use crate::projection::ProjectedScores;

/// Probability of a false alarm.
const LEVEL: f64 = 0.01;
const LAGS: usize = 20;

pub(super) fn detects(scores: &ProjectedScores) -> bool {
    autocorrelation(&scores.whitened, LAGS, LEVEL).is_ok_and(|test| test.p_value < LEVEL)
}
