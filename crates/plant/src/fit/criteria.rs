//! What a fit is judged by: likelihood, criteria of information, correlations of the estimates.

use core::f64::consts::TAU;

use gyrocal_answer::{Coefficients, Correlation};
use gyrocal_hypothesis::FittedModel as _;
use gyrocal_statistics::math::ln;
use nalgebra::{DMatrix, SymmetricEigen};

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::linearised::reduce;

/// Correlations that an answer has: as many as a reader looks at. The others are in the covariance.
const LARGEST: usize = 10;

/// Akaike's criterion (IEEE Trans. Automatic Control 19, 716, 1974) and Schwarz's (Ann. Statist. 6, 461, 1978).
pub(super) fn criteria(log_likelihood: f64, unknowns: usize, values: usize) -> [f64; 2] {
    let (unknowns, deviance) = (unknowns as f64, -2.0 * log_likelihood);
    [
        deviance + 2.0 * unknowns,
        deviance + unknowns * ln(values as f64),
    ]
}

/// The largest correlations of estimates but the held parameters, and the condition number of all.
pub(super) fn correlations(all: &Coefficients, held: &[usize]) -> (Vec<Correlation>, Option<f64>) {
    let free: Vec<usize> = (0..all.nominal.len())
        .filter(|place| !held.contains(place))
        .collect();
    let sigma = |place: usize| all.nominal[place].sigma;
    let correlation = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        all.covariance[free[i]][free[j]] / (sigma(free[i]) * sigma(free[j]))
    });
    let pairs = (0..free.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
    let mut pairs: Vec<Correlation> = pairs
        .map(|(j, i)| Correlation {
            of: [free[j], free[i]].map(|place| all.nominal[place].name.clone()),
            coefficient: correlation[(i, j)],
        })
        .collect();
    pairs.sort_by(|a, b| b.coefficient.abs().total_cmp(&a.coefficient.abs()));
    pairs.truncate(LARGEST);
    if free.is_empty() || correlation.iter().any(|value| !value.is_finite()) {
        return (pairs, None);
    }
    let eigenvalues = SymmetricEigen::new(correlation).eigenvalues;
    let (most, least) = (eigenvalues.max(), eigenvalues.min());
    (pairs, (least > 0.0).then(|| most / least))
}

impl FittedPlant {
    /// Logarithm of the density of all readings at the estimates, nats, without priors, and the number of readings: that
    /// of the innovations of a Kalman filter.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub fn log_likelihood(&self) -> Result<(f64, usize), PlantError> {
        let reduced = reduce(&self.linearised(&[])?.pass(&self.noise, &[]))?;
        let deviance =
            reduced.gram[(0, 0)] + reduced.log_variance + reduced.values as f64 * ln(TAU);
        Ok((-0.5 * deviance, reduced.values))
    }

    /// Covariance of parameters and then initial states of the first record, by rows.
    pub(super) fn covariance_of_coefficients(&self) -> Vec<Vec<f64>> {
        let states = self.loaded().description.states.len();
        let places = || (states..self.problem.nominal()).chain(0..states);
        let row = |i: usize| places().map(|j| self.covariance()[(i, j)]).collect();
        places().map(row).collect()
    }
}
