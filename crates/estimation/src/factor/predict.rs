//! Prediction of the factors (Thornton).

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::Transition;
use crate::unrolled::{load, multiply_add, small_product};

/// Carries the factors through Φ, adds held noise of the given variances, and moves the chart.
#[inline(always)]
pub(super) fn predict<T: Real, const M: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    transition: &Transition<'_, T, M>,
) -> Result<(), EstimationError> {
    let n = pivots.len();
    let p = n - M;
    let (mut moving, mut noise) = (transition.moving, transition.noise);
    if let Some(map) = &transition.map {
        moving = small_product(map, &moving);
        noise = small_product(map, &noise);
    }
    let parameters = transition.parameters;
    let phi: [&[T]; M] = core::array::from_fn(|i| &parameters[i * p..(i + 1) * p]);
    let blocks: [&[[T; 4]]; M] = core::array::from_fn(|i| phi[i].as_chunks().0);
    for (k, column) in factor[M * n..].chunks_exact_mut(n).enumerate() {
        let (head, rest) = column.split_at_mut(M);
        // Below its diagonal, at row k of the parameters, the column is zero.
        let used = k / 4 + 1;
        let (quads, tail) = rest.as_chunks::<4>();
        let mut sums = [[T::from_f64(0.0); 4]; M];
        for block in 0..used.min(quads.len()) {
            for (sum, phi) in sums.iter_mut().zip(&blocks) {
                *sum = multiply_add(phi[block], quads[block], *sum);
            }
        }
        let old: [T; M] = core::array::from_fn(|l| head[l]);
        for i in 0..M {
            let mut total = (sums[i][0] + sums[i][1]) + (sums[i][2] + sums[i][3]);
            for (phi, u) in transition.moving[i].iter().zip(old) {
                total = phi.mul_add(u, total);
            }
            if used > quads.len() {
                for (phi, u) in phi[i][4 * quads.len()..].iter().zip(tail.iter()) {
                    total = phi.mul_add(*u, total);
                }
            }
            head[i] = total;
        }
        if let Some(map) = &transition.map {
            let old: [T; M] = load(head, 0);
            for i in 0..M {
                let mut total = T::from_f64(0.0);
                for j in 0..M {
                    total = map[i][j].mul_add(old[j], total);
                }
                head[i] = total;
            }
        }
    }
    predict_corner(factor, pivots, &moving, &noise, &transition.variance)
}

/// The M × M corner: weighted Gram-Schmidt on the rows of [Φ_mm U_mm, Γ] with the weights
/// [D_m, variance].
#[inline(always)]
pub(super) fn predict_corner<T: Real, const M: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    transition: &[[T; M]; M],
    noise: &[[T; M]; M],
    variance: &[T; M],
) -> Result<(), EstimationError> {
    let n = pivots.len();
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let mut rows = [[zero; M]; M];
    for i in 0..M {
        for j in 0..M {
            // A range up to `j` would be a function of its own, which could panic.
            for k in 0..M {
                if k <= j {
                    rows[i][j] = transition[i][k].mul_add(factor[j * n + k], rows[i][j]);
                }
            }
        }
    }
    let mut noise = *noise;
    let mut weights = [zero; M];
    weights.copy_from_slice(&pivots[..M]);
    for j in (0..M).rev() {
        let mut weighted = [[zero; M]; 2];
        let mut pivot = zero;
        for k in 0..M {
            weighted[0][k] = rows[j][k] * weights[k];
            weighted[1][k] = noise[j][k] * variance[k];
            pivot = weighted[0][k].mul_add(rows[j][k], weighted[1][k].mul_add(noise[j][k], pivot));
        }
        if !(pivot.is_positive() && pivot.is_finite()) {
            return Err(EstimationError::NotPositiveDefinite { state: j });
        }
        pivots[j] = pivot;
        factor[j * n + j] = one;
        let reciprocal = one / pivot;
        for i in 0..j {
            let mut product = zero;
            for k in 0..M {
                product = weighted[0][k]
                    .mul_add(rows[i][k], weighted[1][k].mul_add(noise[i][k], product));
            }
            let u = product * reciprocal;
            factor[j * n + i] = u;
            for k in 0..M {
                rows[i][k] = rows[i][k] - u * rows[j][k];
                noise[i][k] = noise[i][k] - u * noise[j][k];
            }
        }
    }
    Ok(())
}
