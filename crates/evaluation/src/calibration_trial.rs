//! Trials of the calibration: a simulated record, calibrated and compared with its truth.

use gyrocal_calibration::{Consistency, Options, calibrate, cramer_rao_bound};
use gyrocal_truth::{Scenario, Simulation, simulate};
use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::error::EvaluationError;
use crate::injection::run_of;

/// Errors and consistency of one calibration. Arrays are in the order of
/// [`Coefficients::named`](gyrocal_truth::Coefficients::named).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CalibrationTrial {
    /// True coefficients.
    pub truth: [f64; 9],
    /// Estimate minus truth.
    pub error: [f64; 9],
    /// Reported standard deviations.
    pub sigma: [f64; 9],
    /// `true` where the record, and not the prior, determined the coefficient.
    pub determined: [bool; 9],
    /// Standard deviations of the Cramér–Rao bound: prior included, along the true trajectory.
    pub bound_sigma: Option<[f64; 9]>,
    /// Normalised estimation error squared (NEES) of the nine coefficients.
    pub nees: f64,
    /// NEES of the determined coefficients, with their block of the covariance.
    pub nees_determined: f64,
    /// Sum of the normalised innovations squared.
    pub nis_sum: f64,
    /// Number of accelerometer values used, which is the expectation of `nis_sum`.
    pub values: usize,
    /// Number of rows with a value.
    pub rows: usize,
    /// `true` if the mean NIS lies in its 99.9 % band.
    pub consistent: bool,
}

impl CalibrationTrial {
    /// Simulates a scenario, calibrates its record and compares estimate and truth.
    ///
    /// # Errors
    /// [`EvaluationError::Simulation`], [`EvaluationError::Calibration`], and
    /// [`EvaluationError::NotPositiveDefinite`] if the reported covariance has no inverse.
    pub fn of(scenario: &Scenario, options: &Options) -> Result<Self, EvaluationError> {
        let simulation = simulate(scenario)?;
        Self::of_simulation(&simulation, options)?.with_bound(&simulation)
    }

    /// Calibrates a simulated record and compares estimate and truth, without the Cramér–Rao bound.
    ///
    /// # Errors
    /// [`EvaluationError::Calibration`] and [`EvaluationError::NotPositiveDefinite`], as [`Self::of`].
    pub fn of_simulation(
        simulation: &Simulation,
        options: &Options,
    ) -> Result<Self, EvaluationError> {
        let calibration = calibrate(&simulation.record, &simulation.bench, options, |_| ())?;
        let named = simulation.truth.coefficients.named();
        let truth = named.map(|(_, value, _)| value);
        let coefficients = calibration.coefficients();
        let error: [f64; 9] = core::array::from_fn(|i| coefficients[i].estimate - truth[i]);
        let determined = coefficients.map(|coefficient| coefficient.determined);
        let nees = |of: [bool; 9]| {
            normalised_square(&error, &calibration.covariance, of)
                .ok_or(EvaluationError::NotPositiveDefinite)
        };
        let fit = &calibration.fit;
        Ok(Self {
            truth,
            error,
            sigma: coefficients.map(|coefficient| coefficient.sigma),
            determined,
            bound_sigma: None,
            nees: nees([true; 9])?,
            nees_determined: nees(determined)?,
            nis_sum: fit.nis_sum(),
            values: fit.values(),
            rows: fit.rows(),
            consistent: fit.consistency() == Consistency::Consistent,
        })
    }

    /// The same with the Cramér–Rao bound of its record; without it if effects are hidden in it: the model, and so
    /// the bound, does not contain them.
    ///
    /// # Errors
    /// [`EvaluationError::Calibration`] if the bound cannot be computed.
    pub fn with_bound(self, simulation: &Simulation) -> Result<Self, EvaluationError> {
        if !simulation.truth.hidden.is_empty() {
            return Ok(self);
        }
        let attitudes = simulation.truth.platform_c_enu.iter();
        let platform_c_enu: Vec<_> = attitudes.map(|attitude| attitude.matrix()).collect();
        let covariance = cramer_rao_bound(&run_of(simulation), &platform_c_enu, &self.truth)?;
        Ok(Self {
            bound_sigma: Some(core::array::from_fn(|i| covariance[i][i].sqrt())),
            ..self
        })
    }
}

/// eᵀ P⁻¹ e of the errors selected by `of`, with their block of the covariance.
fn normalised_square(error: &[f64; 9], covariance: &[[f64; 9]; 9], of: [bool; 9]) -> Option<f64> {
    // All other errors are 0 with a variance of 1 and add nothing.
    let covariance = SMatrix::<f64, 9, 9>::from_fn(|i, j| match (of[i] && of[j], i == j) {
        (true, _) => covariance[i][j],
        (false, true) => 1.0,
        (false, false) => 0.0,
    });
    let error = SVector::<f64, 9>::from_fn(|i, _| if of[i] { error[i] } else { 0.0 });
    Some(error.dot(&covariance.cholesky()?.solve(&error)))
}

#[cfg(test)]
mod tests {
    use super::normalised_square;

    #[test]
    fn the_normalised_square_of_a_part_uses_its_own_block() {
        let mut covariance = [[0.0; 9]; 9];
        for (i, row) in covariance.iter_mut().enumerate() {
            row[i] = 4.0;
        }
        (covariance[0][1], covariance[1][0]) = (2.0, 2.0);
        let error = [1.0; 9];
        let mut of = [false; 9];
        assert_eq!(normalised_square(&error, &covariance, of), Some(0.0));
        of[0] = true;
        assert_eq!(normalised_square(&error, &covariance, of), Some(0.25));
        of[1] = true;
        // The inverse of [4 2; 2 4] is [4 -2; -2 4] / 12: its elements sum to 1/3. The seven
        // others add 1/4 each. Rounding of a handful of operations.
        let pair = normalised_square(&error, &covariance, of);
        assert!(pair.is_some_and(|found| (found - 1.0 / 3.0).abs() < 1e-15));
        let all = normalised_square(&error, &covariance, [true; 9]);
        assert!(all.is_some_and(|found| (found - 1.0 / 3.0 - 1.75).abs() < 1e-14));
        covariance[0][1] = 4.1;
        covariance[1][0] = 4.1;
        assert_eq!(normalised_square(&error, &covariance, of), None);
    }
}
