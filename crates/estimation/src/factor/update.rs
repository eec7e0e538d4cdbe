//! Update of the factors (Bierman), all outputs in one sweep.

use gyrocal_scalar::Real;

use super::innovation::innovation;
use crate::error::EstimationError;
use crate::form::{Numbers, Observation};
use crate::innovation::Innovation;
use crate::unrolled::{load, mul_add, store};

/// Bierman's update of the factors for all outputs in one sweep.
///
/// `gain` (Y × n) receives the unnormalised gain of each output given the ones before it.
/// Adds the correction to `parameters` and hands that of the moving states to `correct`. When the
/// innovation turns out not to be finite, the factors' head has changed already.
#[inline(always)]
pub(super) fn update<T: Real, const M: usize, const Y: usize>(
    numbers: &mut Numbers<'_, T>,
    parameters: &mut [T],
    observation: &Observation<'_, T, M, Y>,
    correct: impl FnOnce(&[T; M]),
) -> Result<Innovation<T, Y>, EstimationError> {
    let Numbers {
        matrix: factor,
        pivots,
        gain,
        sweep,
        kept,
        ..
    } = numbers;
    let output = observation.parameters;
    let n = pivots.len();
    let q = output.len() / Y;
    if observation.largest_nis.is_some() {
        if q > 0 {
            // Rows of parameters change too, which are not kept.
            let innovation = innovation(factor, pivots, observation, gain)?;
            if observation.is_refused(innovation.nis) {
                return Ok(innovation);
            }
        }
        keep::<T, M>(factor, pivots, kept);
    }
    let (v, rest) = sweep.as_chunks_mut::<Y>().0.split_at_mut(n);
    let mut sweep = Sweep {
        v,
        lambda: &mut rest[..n],
    };
    let head = sweep_head(factor, pivots, observation, gain, &mut sweep);
    let innovation = head.innovation(observation, gain, n)?;
    if observation.is_refused(innovation.nis) {
        put_back::<T, M>(factor, pivots, kept);
        return Ok(innovation);
    }
    if !head.positive {
        // Underflow: nothing else makes a positive pivot vanish.
        let state = pivots.iter().position(|pivot| !pivot.is_positive());
        let state = state.unwrap_or(0);
        return Err(EstimationError::NotPositiveDefinite { state });
    }
    let mut correction = [T::from_f64(0.0); M];
    for k in 0..Y {
        correction = mul_add(head.gain[k], innovation.weights[k], correction);
    }
    correct(&correction);
    for i in 0..q {
        for k in 0..Y {
            parameters[i] = gain[k * n + M + i].mul_add(innovation.weights[k], parameters[i]);
        }
    }
    let mut row = M + q;
    while row + 4 <= n {
        sweep_rows::<T, M, Y, 4>(factor, gain, &sweep, &innovation.weights, parameters, row);
        row += 4;
    }
    while row < n {
        sweep_rows::<T, M, Y, 1>(factor, gain, &sweep, &innovation.weights, parameters, row);
        row += 1;
    }
    Ok(innovation)
}

/// Keeps what the sweep over the moving rows changes.
#[inline(always)]
fn keep<T: Real, const M: usize>(factor: &[T], pivots: &[T], [rows, diagonal]: &mut [&mut [T]; 2]) {
    let columns = factor.chunks_exact(pivots.len().max(1));
    for (place, column) in rows.chunks_exact_mut(M).zip(columns) {
        store(place, 0, load::<T, M>(column, 0));
    }
    diagonal.copy_from_slice(pivots);
}

#[cold]
#[inline(never)]
fn put_back<T: Real, const M: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    [rows, diagonal]: &[&mut [T]; 2],
) {
    let columns = factor.chunks_exact_mut(pivots.len().max(1));
    for (column, kept) in columns.zip(rows.chunks_exact(M)) {
        for (place, element) in column.iter_mut().zip(kept) {
            *place = *element;
        }
    }
    for (place, element) in pivots.iter_mut().zip(diagonal.iter()) {
        *place = *element;
    }
}

/// Coefficients of the sweep for each column of U and each output.
struct Sweep<'a, T, const Y: usize> {
    v: &'a mut [[T; Y]],
    lambda: &'a mut [[T; Y]],
}

/// Result of the sweep over the rows that enter the output: all that the innovation needs.
struct Head<T, const M: usize, const Y: usize> {
    gain: [[T; M]; Y],
    variance: [T; Y],
    reciprocal: [T; Y],
    /// True if every pivot is still positive.
    positive: bool,
}

#[inline(always)]
fn sweep_head<T: Real, const M: usize, const Y: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    observation: &Observation<'_, T, M, Y>,
    gain: &mut [T],
    sweep: &mut Sweep<'_, T, Y>,
) -> Head<T, M, Y> {
    let n = pivots.len();
    let output = observation.parameters;
    let q = output.len() / Y;
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let h = observation.moving;
    let mut gains = [[zero; M]; Y];
    let mut variances = observation.variance;
    let mut reciprocals = variances.map(|variance| one / variance);
    for k in 0..Y {
        gain[k * n + M..k * n + M + q].fill(zero);
    }
    let mut positive = true;
    let columns = factor.chunks_exact_mut(n).zip(pivots.iter_mut());
    let coefficients = sweep.v.iter_mut().zip(sweep.lambda.iter_mut());
    for ((column, pivot), (v_out, lambda_out)) in columns.zip(coefficients) {
        let mut u: [T; M] = load(column, 0);
        let mut d = *pivot;
        for k in 0..Y {
            let mut f = h[k][0] * u[0];
            for i in 1..M {
                f = h[k][i].mul_add(u[i], f);
            }
            for i in 0..q {
                f = output[k * q + i].mul_add(column[M + i], f);
            }
            let v = d * f;
            let before = variances[k];
            let after = v.mul_add(f, before);
            let reciprocal = one / after;
            let lambda = -(f * reciprocals[k]);
            d = d * (before * reciprocal);
            let old = u;
            u = mul_add(gains[k], lambda, u);
            gains[k] = mul_add(old, v, gains[k]);
            for i in 0..q {
                let (u, g) = (column[M + i], gain[k * n + M + i]);
                column[M + i] = g.mul_add(lambda, u);
                gain[k * n + M + i] = u.mul_add(v, g);
            }
            variances[k] = after;
            reciprocals[k] = reciprocal;
            v_out[k] = v;
            lambda_out[k] = lambda;
        }
        store(column, 0, u);
        *pivot = d;
        positive &= d.is_positive();
    }
    for (k, moving) in gains.iter().enumerate() {
        store(gain, k * n, *moving);
    }
    Head {
        gain: gains,
        variance: variances,
        reciprocal: reciprocals,
        positive,
    }
}

/// Applies the coefficients of the sweep to `W` rows of U from `row`, gathers their gain, and
/// corrects their parameters.
#[inline(always)]
fn sweep_rows<T: Real, const M: usize, const Y: usize, const W: usize>(
    factor: &mut [T],
    gain: &mut [T],
    sweep: &Sweep<'_, T, Y>,
    weights: &[T; Y],
    parameters: &mut [T],
    row: usize,
) {
    let n = sweep.v.len();
    let mut gains = [[T::from_f64(0.0); W]; Y];
    let coefficients = sweep.v[row..].iter().zip(&sweep.lambda[row..]);
    for (column, (v, lambda)) in factor[row * n..].chunks_exact_mut(n).zip(coefficients) {
        let mut u: [T; W] = load(column, row);
        for k in 0..Y {
            let changed = mul_add(gains[k], lambda[k], u);
            gains[k] = mul_add(u, v[k], gains[k]);
            u = changed;
        }
        store(column, row, u);
    }
    let mut corrected: [T; W] = load(parameters, row - M);
    for k in 0..Y {
        store(gain, k * n + row, gains[k]);
        corrected = mul_add(gains[k], weights[k], corrected);
    }
    store(parameters, row - M, corrected);
}

impl<T: Real, const M: usize, const Y: usize> Head<T, M, Y> {
    /// The innovation with the factors of its covariance S = L diag(α) Lᵀ.
    #[inline(always)]
    fn innovation(
        &self,
        observation: &Observation<'_, T, M, Y>,
        gain: &[T],
        n: usize,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        let output = observation.parameters;
        let q = output.len() / Y;
        let zero = T::from_f64(0.0);
        let mut lower = [[zero; Y]; Y];
        for k in 0..Y {
            for earlier in 0..k {
                let mut product = zero;
                for i in 0..M {
                    product = observation.moving[k][i].mul_add(self.gain[earlier][i], product);
                }
                for i in 0..q {
                    product = output[k * q + i].mul_add(gain[earlier * n + M + i], product);
                }
                lower[k][earlier] = product * self.reciprocal[earlier];
            }
            lower[k][k] = T::from_f64(1.0);
        }
        let innovation = Innovation::from_factors(
            observation.residual,
            observation.observed,
            lower,
            self.variance,
            &self.reciprocal,
            observation.clip.map(|clip| (clip, observation.variance)),
        );
        innovation.check()?;
        Ok(innovation)
    }
}
