//! P projected on the outputs: the innovation, and the moving block after the update.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Observation, Zeros};
use crate::innovation::Innovation;
use crate::unrolled::{load_rows, mul_add, store};

/// Largest ratio of H P Hᵀ to R, output by output, up to which the moving block is updated by
/// subtraction: that costs a variance at most two bits more than the binary logarithm of this.
const NARROW: f64 = 256.0;

/// H P on the moving columns, and S = H P Hᵀ + R factored.
pub(crate) struct Projection<'a, T, const M: usize, const Y: usize> {
    pub(crate) observation: &'a Observation<'a, T, M, Y>,
    /// Moving columns of H P.
    pub(crate) moving: [[T; M]; Y],
    /// Diagonal of H P Hᵀ.
    projected: [T; Y],
    /// L, unit lower triangular.
    lower: [[T; Y]; Y],
    /// α.
    variance: [T; Y],
    /// α⁻¹.
    pub(crate) reciprocal: [T; Y],
}

impl<'a, T: Real, const M: usize, const Y: usize> Projection<'a, T, M, Y> {
    /// Projects P on the outputs; [`Self::check`] validates the result.
    ///
    /// Loops run over all outputs with conditions inside: bounds that depend on another index keep
    /// the compiler from unrolling them, and small matrices would then live in memory.
    #[inline(always)]
    pub(crate) fn new(
        p: &[T],
        n: usize,
        observation: &'a Observation<'a, T, M, Y>,
        zeros: &impl Zeros,
    ) -> Self {
        let output = observation.parameters;
        let q = output.len() / Y;
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let h = &observation.moving;
        let mut moving = [[zero; M]; Y];
        for k in 0..Y {
            for j in 0..M {
                let mut sum = zero;
                for i in 0..M {
                    if zeros.shows(k, i) {
                        sum = h[k][i].mul_add(p[i * n + j], sum);
                    }
                }
                for i in 0..q {
                    sum = output[k * q + i].mul_add(p[j * n + M + i], sum);
                }
                moving[k][j] = sum;
            }
        }
        // H P Hᵀ, then L diag(α), row by row: L without the division that the next pivot would
        // wait for.
        let mut scaled = [[zero; Y]; Y];
        for k in 0..Y {
            for l in 0..Y {
                if l <= k {
                    for j in 0..M {
                        if zeros.shows(l, j) {
                            scaled[k][l] = moving[k][j].mul_add(h[l][j], scaled[k][l]);
                        }
                    }
                    for i in 0..q {
                        let of_parameter = Self::of_parameter(p, n, h, output, k, i);
                        scaled[k][l] = of_parameter.mul_add(output[l * q + i], scaled[k][l]);
                    }
                }
            }
        }
        let mut projected = [zero; Y];
        let mut lower = [[zero; Y]; Y];
        let mut variance = [zero; Y];
        let mut reciprocal = [zero; Y];
        for k in 0..Y {
            projected[k] = scaled[k][k];
            scaled[k][k] = scaled[k][k] + observation.variance[k];
            for l in 0..Y {
                if l <= k {
                    for earlier in 0..Y {
                        if earlier < l {
                            let known = scaled[k][earlier] * lower[l][earlier];
                            scaled[k][l] = scaled[k][l] - known;
                        }
                    }
                    if l < k {
                        lower[k][l] = scaled[k][l] * reciprocal[l];
                    }
                }
            }
            variance[k] = scaled[k][k];
            reciprocal[k] = one / variance[k];
            lower[k][k] = one;
        }
        Self {
            observation,
            moving,
            projected,
            lower,
            variance,
            reciprocal,
        }
    }

    /// True if an output is so much more precise than the prediction that subtraction would lose
    /// digits.
    #[inline(always)]
    fn is_wide(&self) -> bool {
        let mut wide = false;
        for k in 0..Y {
            let bound = self.observation.variance[k] * T::from_f64(NARROW);
            wide |= self.projected[k] > bound;
        }
        wide
    }

    /// Checks that S has kept its precision, and is positive definite and finite.
    #[inline(always)]
    pub(crate) fn check(&self) -> Result<(), EstimationError> {
        if self.is_wide() {
            check_digits(&self.projected, &self.observation.variance)?;
        }
        let mut bad = false;
        let mut total = T::from_f64(0.0);
        for k in 0..Y {
            bad |= !self.variance[k].is_positive();
            total = total + self.variance[k];
        }
        // A sum of positive numbers is finite only if all of them are.
        if bad || !total.is_finite() {
            return Err(bad_pivot(&self.variance));
        }
        Ok(())
    }

    /// (H P) of output `k` and parameter `i`.
    #[inline(always)]
    fn of_parameter(p: &[T], n: usize, h: &[[T; M]; Y], output: &[T], k: usize, i: usize) -> T {
        let q = output.len() / Y;
        let mut sum = T::from_f64(0.0);
        for j in 0..M {
            sum = h[k][j].mul_add(p[j * n + M + i], sum);
        }
        for j in 0..q {
            sum = output[k * q + j].mul_add(p[(M + j) * n + M + i], sum);
        }
        sum
    }

    /// The innovation.
    #[inline(always)]
    pub(crate) fn innovation(&self) -> Innovation<T, Y> {
        let observation = self.observation;
        Innovation::from_factors(
            observation.residual,
            observation.observed,
            self.lower,
            self.variance,
            &self.reciprocal,
            observation.clip.map(|clip| (clip, observation.variance)),
        )
    }

    /// L⁻¹ applied to rows.
    #[inline(always)]
    pub(crate) fn reduce<const W: usize>(&self, rows: &mut [[T; W]; Y]) {
        for k in 0..Y {
            for earlier in 0..Y {
                if earlier < k {
                    rows[k] = mul_add(rows[earlier], -self.lower[k][earlier], rows[k]);
                }
            }
        }
    }

    /// The moving block after the update, `whitened` being the moving columns of V.
    #[inline(always)]
    pub(crate) fn update_corner(&self, p: &mut [T], n: usize, whitened: &[[T; M]; Y]) {
        let mut rest: [[T; M]; M] = load_rows(p, n, 0);
        if self.is_wide() {
            self.corner_in_joseph_form(p, n, &mut rest);
        } else {
            for i in 0..M {
                for k in 0..Y {
                    rest[i] = mul_add(whitened[k], -whitened[k][i], rest[i]);
                }
            }
        }
        for (i, row) in rest.iter().enumerate() {
            store(p, i * n, *row);
        }
    }

    /// (I - K H) P (I - K H)ᵀ + K R Kᵀ of the moving block, which `corner` is. Of `p` it iterates
    /// over elements only, as an index could panic here, where the compiler knows no length.
    #[cold]
    #[inline(never)]
    fn corner_in_joseph_form(&self, p: &[T], n: usize, corner: &mut [[T; M]; M]) {
        let (observation, output) = (self.observation, self.observation.parameters);
        let q = output.len() / Y;
        let zero = T::from_f64(0.0);
        let mut reduced = self.moving;
        self.reduce(&mut reduced);
        // K_m = (L⁻¹ H P)_mᵀ diag(α)⁻¹ L⁻¹, row by row from the last output back.
        let mut gain = [[zero; M]; Y];
        for k in (0..Y).rev() {
            gain[k] = reduced[k].map(|value| value * self.reciprocal[k]);
            for later in k + 1..Y {
                gain[k] = mul_add(gain[later], -self.lower[later][k], gain[k]);
            }
        }
        let mut rest = *corner;
        for i in 0..M {
            for k in 0..Y {
                rest[i] = mul_add(self.moving[k], -gain[k][i], rest[i]);
            }
        }
        // (I - K H) P Hᵀ - K R, which is zero but for rounding.
        let mut excess = [[zero; M]; Y];
        for k in 0..Y {
            for i in 0..M {
                let mut sum = -(gain[k][i] * observation.variance[k]);
                for j in 0..M {
                    sum = rest[i][j].mul_add(observation.moving[k][j], sum);
                }
                let cross = p.iter().skip(i * n + M).zip(output.iter().skip(k * q));
                for (p, h) in cross.take(q) {
                    sum = p.mul_add(*h, sum);
                }
                excess[k][i] = sum;
            }
        }
        for i in 0..M {
            for j in 0..=i {
                let mut sum = T::from_f64(0.5) * (rest[i][j] + rest[j][i]);
                for k in 0..Y {
                    sum = sum - excess[k][i] * gain[k][j];
                }
                corner[i][j] = sum;
                corner[j][i] = sum;
            }
        }
    }
}

/// An update takes at most 1 + Σ S/R off a variance, in relative terms. What has more digits than
/// the number type, less the eight bits that sums over some dozen products lose, would leave
/// rounding only.
#[cold]
#[inline(never)]
fn check_digits<T: Real, const Y: usize>(
    projected: &[T; Y],
    noise: &[T; Y],
) -> Result<(), EstimationError> {
    for output in 0..Y {
        if projected[output] * T::epsilon() * T::from_f64(256.0) > noise[output] {
            return Err(EstimationError::LostPrecision { output });
        }
    }
    Ok(())
}

#[cold]
#[inline(never)]
fn bad_pivot<T: Real, const Y: usize>(pivots: &[T; Y]) -> EstimationError {
    let found = pivots.iter().find(|pivot| !is_variance(**pivot));
    not_positive(found.copied().unwrap_or(T::from_f64(f64::INFINITY)), 0)
}

#[inline(always)]
fn is_variance<T: Real>(value: T) -> bool {
    value.is_positive() && value.is_finite()
}

#[cold]
fn not_positive<T: Real>(value: T, state: usize) -> EstimationError {
    if value.is_finite() {
        EstimationError::NotPositiveDefinite { state }
    } else {
        EstimationError::NotFinite {
            quantity: "the covariance",
        }
    }
}

/// Checks that the first `count` variances of P are positive and finite.
#[inline(always)]
pub(crate) fn check_diagonal<T: Real>(
    p: &[T],
    n: usize,
    count: usize,
) -> Result<(), EstimationError> {
    let mut bad = 0_u32;
    // Several sums, as one would be a chain.
    let mut sums = [T::from_f64(0.0); 4];
    for i in 0..count {
        let variance = p[i * n + i];
        bad |= u32::from(!variance.is_positive());
        sums[i % 4] = sums[i % 4] + variance;
    }
    let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    // A sum of positive numbers is finite only if all of them are.
    if bad == 0 && sum.is_finite() {
        return Ok(());
    }
    for state in 0..count {
        if !is_variance(p[state * n + state]) {
            return Err(not_positive(p[state * n + state], state));
        }
    }
    // Each is finite, but not their sum.
    Err(not_positive(T::from_f64(1.0), 0))
}
