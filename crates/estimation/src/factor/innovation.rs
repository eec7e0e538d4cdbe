//! The innovation from the factors, without an update.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::Observation;
use crate::innovation::Innovation;

/// The innovation alone: S = L diag(α) Lᵀ from H U and D, nothing updated.
///
/// `products` is workspace of Y × n numbers.
pub(super) fn innovation<T: Real, const M: usize, const Y: usize>(
    factor: &[T],
    pivots: &[T],
    observation: &Observation<'_, T, M, Y>,
    products: &mut [T],
) -> Result<Innovation<T, Y>, EstimationError> {
    let n = pivots.len();
    let output = observation.parameters;
    let q = output.len() / Y;
    let zero = T::from_f64(0.0);
    for k in 0..Y {
        for j in 0..n {
            let column = &factor[j * n..(j + 1) * n];
            let moving = observation.moving[k].iter().zip(column);
            let parameters = output[k * q..(k + 1) * q].iter().zip(&column[M..]);
            products[k * n + j] = moving
                .chain(parameters)
                .fold(zero, |sum, (h, u)| h.mul_add(*u, sum));
        }
    }
    let mut covariance = [[zero; Y]; Y];
    for i in 0..Y {
        for k in 0..=i {
            covariance[i][k] = (0..n).fold(zero, |sum, j| {
                (products[i * n + j] * pivots[j]).mul_add(products[k * n + j], sum)
            });
        }
        covariance[i][i] = covariance[i][i] + observation.variance[i];
    }
    let mut lower = [[zero; Y]; Y];
    let mut variance = [zero; Y];
    for i in 0..Y {
        for k in 0..i {
            let known = (0..k).fold(zero, |sum, l| {
                (lower[i][l] * variance[l]).mul_add(lower[k][l], sum)
            });
            lower[i][k] = (covariance[i][k] - known) / variance[k];
        }
        variance[i] = (0..i).fold(covariance[i][i], |rest, l| {
            rest - lower[i][l] * lower[i][l] * variance[l]
        });
        lower[i][i] = T::from_f64(1.0);
    }
    let reciprocal = variance.map(|variance| T::from_f64(1.0) / variance);
    let Observation {
        residual,
        observed,
        clip,
        variance: noise,
        ..
    } = *observation;
    let clip = clip.map(|clip| (clip, noise));
    let innovation =
        Innovation::from_factors(residual, observed, lower, variance, &reciprocal, clip);
    innovation.check()?;
    Ok(innovation)
}
