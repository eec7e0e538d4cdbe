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
use crate::form::{Form, Numbers, Observation, Transition, Zeros};
use crate::innovation::Innovation;
use crate::lanes4::{load, mul_add, multiply_add, small_product, store};

/// The factors U and D: P is symmetric and positive definite whatever rounding does, in single
/// precision and from wide priors. `cargo figures kernel` prints how much longer a step takes than
/// with [`crate::Covariance`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Factors;

impl<T: Real> Form<T> for Factors {
    const USES_ZEROS: bool = false;

    #[inline]
    fn start(numbers: &mut Numbers<'_, T>, variances: impl Iterator<Item = T>) {
        let n = numbers.pivots.len();
        numbers.matrix.fill(T::from_f64(0.0));
        for (j, variance) in variances.enumerate() {
            numbers.matrix[j * n + j] = T::from_f64(1.0);
            numbers.pivots[j] = variance;
        }
    }

    #[inline]
    fn element(matrix: &[T], pivots: &[T], _moving: usize, i: usize, j: usize) -> T {
        let n = pivots.len();
        (i.max(j)..n).fold(T::from_f64(0.0), |sum, l| {
            (matrix[l * n + i] * pivots[l]).mul_add(matrix[l * n + j], sum)
        })
    }

    #[inline(always)]
    fn predict<const M: usize, const SPARSE: bool>(
        numbers: &mut Numbers<'_, T>,
        transition: &Transition<'_, T, M>,
        _zeros: &impl Zeros,
    ) -> Result<(), EstimationError> {
        predict(numbers.matrix, numbers.pivots, transition)
    }

    #[inline(always)]
    fn innovation<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        observation: &Observation<'_, T, M, Y>,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        innovation(numbers.matrix, numbers.pivots, observation, numbers.gain)
    }

    #[inline(always)]
    fn update<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        parameters: &mut [T],
        observation: &Observation<'_, T, M, Y>,
        _zeros: &impl Zeros,
        correct: impl FnOnce(&[T; M]),
    ) -> Result<Innovation<T, Y>, EstimationError> {
        update(numbers, parameters, observation, correct)
    }
}

/// Carries the factors through Φ, adds held noise of the given variances, and moves the chart.
#[inline(always)]
fn predict<T: Real, const M: usize>(
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
fn predict_corner<T: Real, const M: usize>(
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
            rows[i][j] = (0..=j).fold(zero, |sum, k| {
                transition[i][k].mul_add(factor[j * n + k], sum)
            });
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

/// The innovation alone: S = L diag(α) Lᵀ from H U and D, nothing updated.
///
/// `products` is workspace of Y × n numbers.
fn innovation<T: Real, const M: usize, const Y: usize>(
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
        residual, observed, ..
    } = *observation;
    let innovation = Innovation::from_factors(residual, observed, lower, variance, &reciprocal);
    innovation.check()?;
    Ok(innovation)
}

/// Bierman's update of the factors for all outputs in one sweep.
///
/// `gain` (Y × n) receives the unnormalised gain of each output given the ones before it.
/// Adds the correction to `parameters` and hands that of the moving states to `correct`. When the
/// innovation turns out not to be finite, the factors' head has changed already.
#[inline(always)]
fn update<T: Real, const M: usize, const Y: usize>(
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
        ..
    } = numbers;
    let output = observation.parameters;
    let n = pivots.len();
    let q = output.len() / Y;
    let (v, rest) = sweep.as_chunks_mut::<Y>().0.split_at_mut(n);
    let mut sweep = Sweep {
        v,
        lambda: &mut rest[..n],
    };
    let head = sweep_head(factor, pivots, observation, gain, &mut sweep);
    let innovation = head.innovation(observation, gain, n)?;
    if !head.positive {
        // Underflow: nothing else makes a positive pivot vanish.
        let state = (0..n).find(|j| !pivots[*j].is_positive()).unwrap_or(0);
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

/// Coefficients of the sweep for each column of U and each output.
struct Sweep<'a, T, const Y: usize> {
    v: &'a mut [[T; Y]],
    lambda: &'a mut [[T; Y]],
}

/// What the rows that enter the output yield: everything about the innovation.
struct Head<T, const M: usize, const Y: usize> {
    gain: [[T; M]; Y],
    variance: [T; Y],
    reciprocal: [T; Y],
    /// Whether every pivot is still positive.
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
        );
        innovation.check()?;
        Ok(innovation)
    }
}
