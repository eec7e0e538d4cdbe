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
    let n = pivots.len().max(1);
    let output = observation.parameters;
    let q = output.len() / Y;
    let zero = T::from_f64(0.0);
    // Iterators, and conditions inside of loops over all outputs: an index could panic here, where the
    // compiler knows no length.
    for (k, (row, moving)) in products
        .chunks_exact_mut(n)
        .zip(&observation.moving)
        .enumerate()
    {
        let of_parameters = output.get(k * q..(k + 1) * q).unwrap_or_default();
        for (place, column) in row.iter_mut().zip(factor.chunks_exact(n)) {
            let moving = moving.iter().zip(column);
            let parameters = of_parameters.iter().zip(column.iter().skip(M));
            *place = moving
                .chain(parameters)
                .fold(zero, |sum, (h, u)| h.mul_add(*u, sum));
        }
    }
    let mut rows: [&[T]; Y] = [&[]; Y];
    for (place, row) in rows.iter_mut().zip(products.chunks_exact(n)) {
        *place = row;
    }
    let mut covariance = [[zero; Y]; Y];
    for i in 0..Y {
        for k in 0..Y {
            if k <= i {
                let pairs = rows[i].iter().zip(rows[k]).zip(pivots);
                covariance[i][k] = pairs.fold(zero, |sum, ((own, other), pivot)| {
                    (*own * *pivot).mul_add(*other, sum)
                });
            }
        }
        covariance[i][i] = covariance[i][i] + observation.variance[i];
    }
    let mut lower = [[zero; Y]; Y];
    let mut variance = [zero; Y];
    for i in 0..Y {
        let mut rest = covariance[i][i];
        for k in 0..Y {
            if k < i {
                let mut known = zero;
                for l in 0..Y {
                    if l < k {
                        known = (lower[i][l] * variance[l]).mul_add(lower[k][l], known);
                    }
                }
                lower[i][k] = (covariance[i][k] - known) / variance[k];
                rest = rest - lower[i][k] * lower[i][k] * variance[k];
            }
        }
        variance[i] = rest;
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
