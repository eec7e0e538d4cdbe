//! The covariance as P = U D Uᵀ: prediction and update of the factors.
//!
//! U is unit upper triangular, states ordered moving first, parameters after. Then
//!
//! - a prediction changes the moving rows of U and the moving pivots only, because Φ is the
//!   identity on the parameters: U_mp ← Φ_mm U_mp + Φ_mp U_pp, and the M × M corner is
//!   orthogonalised again with the noise by weighted Gram-Schmidt (Thornton's method);
//! - an update takes the outputs one by one (Bierman's method), but all of them in a single
//!   sweep over U: what later outputs need of the earlier ones is known as soon as the rows
//!   that enter the output are, so those rows go first and yield the coefficients for the rest.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::innovation::Innovation;
use crate::lanes4::{load, mul_add, store};

/// Factors a covariance in place: on entry `factor` holds the upper triangle of a symmetric
/// matrix by columns (n × n), on return U, and `pivots` D.
///
/// # Errors
/// [`EstimationError::NotPositiveDefinite`] names the first pivot, from the last state, that
/// is not positive.
pub fn factorise<T: Real>(factor: &mut [T], pivots: &mut [T]) -> Result<(), EstimationError> {
    let n = pivots.len();
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    for j in (0..n).rev() {
        let pivot = factor[j * n + j];
        if !(pivot > zero && pivot.is_finite()) {
            return Err(EstimationError::NotPositiveDefinite { state: j });
        }
        pivots[j] = pivot;
        for i in 0..j {
            factor[j * n + i] = factor[j * n + i] / pivot;
        }
        for k in 0..j {
            let scaled = factor[j * n + k] * pivot;
            for i in 0..=k {
                factor[k * n + i] = factor[k * n + i] - factor[j * n + i] * scaled;
            }
        }
        factor[j * n + j] = one;
        for below in &mut factor[j * n + j + 1..(j + 1) * n] {
            *below = zero;
        }
    }
    Ok(())
}

/// Element (i, j) of P.
#[inline]
pub(crate) fn covariance<T: Real>(factor: &[T], pivots: &[T], i: usize, j: usize) -> T {
    let n = pivots.len();
    (i.max(j)..n).fold(T::from_f64(0.0), |sum, l| {
        (factor[l * n + i] * pivots[l]).mul_add(factor[l * n + j], sum)
    })
}

/// Carries the factors through Φ and adds held noise of the given variances.
///
/// `transition` are the moving, `parameter_columns` (M × p, by rows) the parameter columns of
/// Φ, `noise` is Γ.
#[inline(always)]
pub(crate) fn predict<T: Real, const M: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    transition: &[[T; M]; M],
    parameter_columns: &[T],
    noise: &[[T; M]; M],
    variance: &[T; M],
) -> Result<(), EstimationError> {
    let n = pivots.len();
    let p = n - M;
    let zero = T::from_f64(0.0);
    for j in M..n {
        let column = &mut factor[j * n..(j + 1) * n];
        let mut sums = [[zero; 4]; M];
        let mut l = 0;
        while l + 4 <= p && l + M <= j {
            let u: [T; 4] = load(column, M + l);
            for (i, sum) in sums.iter_mut().enumerate() {
                let phi: [T; 4] = load(parameter_columns, i * p + l);
                for lane in 0..4 {
                    sum[lane] = phi[lane].mul_add(u[lane], sum[lane]);
                }
            }
            l += 4;
        }
        let mut rows = [zero; M];
        for i in 0..M {
            let mut total = (sums[i][0] + sums[i][1]) + (sums[i][2] + sums[i][3]);
            for rest in l..(j - M + 1).max(l) {
                total = parameter_columns[i * p + rest].mul_add(column[M + rest], total);
            }
            for (k, phi) in transition[i].iter().enumerate() {
                total = phi.mul_add(column[k], total);
            }
            rows[i] = total;
        }
        column[..M].copy_from_slice(&rows);
    }
    predict_corner(factor, pivots, transition, noise, variance)
}

/// The M × M corner: weighted Gram-Schmidt on the rows of [Φ_mm U_mm, Γ] with the weights
/// [D_m, variance].
#[inline(always)]
pub(crate) fn predict_corner<T: Real, const M: usize>(
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
            rows[i][j] = (0..=j).fold(zero, |sum, k| transition[i][k].mul_add(factor[j * n + k], sum));
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
        if !(pivot > zero && pivot.is_finite()) {
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

/// One measurement: Jacobian of the outputs, their noise and their residuals. An output
/// that was not observed has a zero row, unit variance and zero residual.
///
/// The columns of H of the parameters that enter the output are kept apart, as rows of
/// `output_parameters` numbers, because their number is the model's.
pub(crate) struct Observation<T, const M: usize, const Y: usize> {
    /// Moving columns of H.
    pub(crate) moving: [[T; M]; Y],
    /// Number of parameters that enter the output.
    pub(crate) output_parameters: usize,
    /// Noise variance of each output.
    pub(crate) variance: [T; Y],
    /// Measured minus predicted output.
    pub(crate) residual: [T; Y],
    /// Which outputs were observed.
    pub(crate) observed: [bool; Y],
}

/// The innovation alone: S = L diag(α) Lᵀ from H U and D, nothing updated.
///
/// `products` is workspace of Y × n numbers.
pub(crate) fn innovation<T: Real, const M: usize, const Y: usize>(
    factor: &[T],
    pivots: &[T],
    observation: &Observation<T, M, Y>,
    output: &[T],
    products: &mut [T],
) -> Result<Innovation<T, Y>, EstimationError> {
    let n = pivots.len();
    let q = observation.output_parameters;
    let zero = T::from_f64(0.0);
    for k in 0..Y {
        for j in 0..n {
            let column = &factor[j * n..(j + 1) * n];
            let moving = observation.moving[k].iter().zip(column);
            let parameters = output[k * q..(k + 1) * q].iter().zip(&column[M..]);
            products[k * n + j] = moving.chain(parameters).fold(zero, |sum, (h, u)| h.mul_add(*u, sum));
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
            let known = (0..k).fold(zero, |sum, l| (lower[i][l] * variance[l]).mul_add(lower[k][l], sum));
            lower[i][k] = (covariance[i][k] - known) / variance[k];
        }
        variance[i] = (0..i).fold(covariance[i][i], |rest, l| rest - lower[i][l] * lower[i][l] * variance[l]);
        lower[i][i] = T::from_f64(1.0);
    }
    Innovation::from_factors(observation.residual, observation.observed, lower, variance)
}

/// Bierman's update of the factors for all outputs in one sweep.
///
/// `gain` (Y × n) receives the unnormalised gain of each output given the ones before it.
/// The change of the state is the sum over outputs of gain times weight; `state_change` is
/// called with the moving rows of the gain, the weights and all of the gain.
/// `sweep` is workspace of 2 × n × Y numbers.
#[inline(always)]
pub(crate) fn update<T: Real, const M: usize, const Y: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    observation: &Observation<T, M, Y>,
    output: &[T],
    gain: &mut [T],
    sweep: &mut [T],
    state_change: impl FnOnce(&[[T; M]; Y], &[T; Y], &[T]),
) -> Result<Innovation<T, Y>, EstimationError> {
    let n = pivots.len();
    let q = observation.output_parameters;
    let head = sweep_head(factor, pivots, observation, output, gain, sweep);
    let (v, lambda) = sweep.split_at(n * Y);
    let mut row = M + q;
    while row + 4 <= n {
        sweep_rows::<T, Y, 4>(factor, gain, v, lambda, n, row);
        row += 4;
    }
    while row < n {
        sweep_rows::<T, Y, 1>(factor, gain, v, lambda, n, row);
        row += 1;
    }
    let innovation = head.innovation(observation, output, gain, n)?;
    state_change(&head.gain, &innovation.weights, gain);
    Ok(innovation)
}

/// What the rows that enter the output yield: everything about the innovation.
struct Head<T, const M: usize, const Y: usize> {
    gain: [[T; M]; Y],
    variance: [T; Y],
    reciprocal: [T; Y],
}

#[inline(always)]
fn sweep_head<T: Real, const M: usize, const Y: usize>(
    factor: &mut [T],
    pivots: &mut [T],
    observation: &Observation<T, M, Y>,
    output: &[T],
    gain: &mut [T],
    sweep: &mut [T],
) -> Head<T, M, Y> {
    let n = pivots.len();
    let q = observation.output_parameters;
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let h = observation.moving;
    let mut head = Head {
        gain: [[zero; M]; Y],
        variance: observation.variance,
        reciprocal: observation.variance.map(|variance| one / variance),
    };
    for k in 0..Y {
        gain[k * n + M..k * n + M + q].fill(zero);
    }
    let (v_all, lambda_all) = sweep.split_at_mut(n * Y);
    for j in 0..n {
        let mut column: [T; M] = load(factor, j * n);
        let mut pivot = pivots[j];
        for k in 0..Y {
            let mut f = zero;
            for (derivative, u) in h[k].iter().zip(column) {
                f = derivative.mul_add(u, f);
            }
            for i in 0..q {
                f = output[k * q + i].mul_add(factor[j * n + M + i], f);
            }
            let v = pivot * f;
            let before = head.variance[k];
            let after = v.mul_add(f, before);
            let reciprocal = one / after;
            let lambda = -f * head.reciprocal[k];
            pivot = pivot * (before * reciprocal);
            for i in 0..M {
                let u = column[i];
                column[i] = head.gain[k][i].mul_add(lambda, u);
                head.gain[k][i] = u.mul_add(v, head.gain[k][i]);
            }
            for i in 0..q {
                let (u, g) = (factor[j * n + M + i], gain[k * n + M + i]);
                factor[j * n + M + i] = g.mul_add(lambda, u);
                gain[k * n + M + i] = u.mul_add(v, g);
            }
            head.variance[k] = after;
            head.reciprocal[k] = reciprocal;
            v_all[j * Y + k] = v;
            lambda_all[j * Y + k] = lambda;
        }
        store(factor, j * n, column);
        pivots[j] = pivot;
    }
    for (k, moving) in head.gain.iter().enumerate() {
        store(gain, k * n, *moving);
    }
    head
}

/// Applies the coefficients of the sweep to `W` rows of U from `row`, and gathers their gain.
#[inline(always)]
fn sweep_rows<T: Real, const Y: usize, const W: usize>(
    factor: &mut [T],
    gain: &mut [T],
    v: &[T],
    lambda: &[T],
    n: usize,
    row: usize,
) {
    let mut gains = [[T::from_f64(0.0); W]; Y];
    for j in row..n {
        let mut u: [T; W] = load(factor, j * n + row);
        let v: [T; Y] = load(v, j * Y);
        let lambda: [T; Y] = load(lambda, j * Y);
        for k in 0..Y {
            let changed = mul_add(gains[k], lambda[k], u);
            gains[k] = mul_add(u, v[k], gains[k]);
            u = changed;
        }
        store(factor, j * n + row, u);
    }
    for (k, lanes) in gains.iter().enumerate() {
        store(gain, k * n + row, *lanes);
    }
}

impl<T: Real, const M: usize, const Y: usize> Head<T, M, Y> {
    /// The innovation with the factors of its covariance S = L diag(α) Lᵀ.
    #[inline(always)]
    fn innovation(
        &self,
        observation: &Observation<T, M, Y>,
        output: &[T],
        gain: &[T],
        n: usize,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        let q = observation.output_parameters;
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
        Innovation::from_factors(observation.residual, observation.observed, lower, self.variance)
    }
}
