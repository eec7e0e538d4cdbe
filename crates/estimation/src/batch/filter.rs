//! The small Kalman filter of the moving states given the parameters, with sensitivity columns.

use alloc::vec;
use alloc::vec::Vec;

use gyrocal_scalar::Scalar;

use super::step::{add, map_columns, sandwich};
use super::walk::{Joint, WalkStep};
use crate::error::EstimationError;

/// Mean, sensitivities and covariance of the deviation of the moving states, and of parameters that
/// walk, from the linearisation trajectory. Column 0 is the mean.
pub(crate) struct Conditional<const M: usize> {
    /// One row of 1 + count numbers for each moving state, then for each walk.
    pub(crate) columns: Vec<f64>,
    pub(crate) stride: usize,
    pub(crate) covariance: Joint<M>,
    /// The whitened row of the last output: residual, then columns.
    pub(crate) whitened: Vec<f64>,
    /// Covariance of the moving states with the last output before its update, and of the walks.
    pub(crate) cross: [f64; M],
    pub(crate) walk_cross: Vec<f64>,
}

impl<const M: usize> Conditional<M> {
    pub(crate) fn new(columns: usize, covariance: [[f64; M]; M], walks: usize) -> Self {
        let stride = columns + 1;
        Self {
            columns: vec![0.0; (M + walks) * stride],
            stride,
            covariance: Joint::new(covariance, walks),
            whitened: vec![0.0; stride],
            cross: [0.0; M],
            walk_cross: vec![0.0; walks],
        }
    }

    /// Mean of moving states and walks.
    pub(crate) fn whole_mean(&self) -> Vec<f64> {
        self.columns.iter().step_by(self.stride).copied().collect()
    }

    /// Row `i` of the columns.
    pub(crate) fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.columns[i * self.stride..(i + 1) * self.stride]
    }

    /// Multiplies by the transition and adds its noise; what drives the columns is added by the
    /// caller.
    pub(crate) fn predict(
        &mut self,
        transition: &[[f64; M]; M],
        noise: &[[f64; M]; M],
        steps: &[WalkStep<M>],
    ) {
        predict_columns(transition, steps, &mut self.columns, self.stride);
        self.covariance.predict(transition, steps);
        add(&mut self.covariance.moving, noise);
        for (walk, step) in steps.iter().enumerate() {
            self.covariance.add_walk(walk, step);
        }
    }

    /// Takes one output. `whitened` holds the residual at the linearisation point and minus the
    /// direct derivatives of the output on entry; on return it is the innovation of each column
    /// over the returned standard deviation.
    pub(crate) fn update(
        &mut self,
        jacobian: &[f64; M],
        variance: f64,
    ) -> Result<f64, EstimationError> {
        let cross = self.covariance.with_output(jacobian, &mut self.walk_cross);
        self.cross = cross;
        let mut total = variance;
        for i in 0..M {
            total += jacobian[i] * cross[i];
        }
        if !(total.is_finite() && total > 0.0) {
            return Err(EstimationError::NotFinite {
                quantity: "the variance of an innovation",
            });
        }
        let deviation = Scalar::sqrt(total);
        let reciprocal = 1.0 / deviation;
        let stride = self.stride;
        for i in 0..M {
            let row = &self.columns[i * stride..(i + 1) * stride];
            for (innovation, value) in self.whitened.iter_mut().zip(row) {
                *innovation -= jacobian[i] * value;
            }
        }
        for innovation in &mut self.whitened {
            *innovation *= reciprocal;
        }
        let all = cross.iter().chain(&self.walk_cross);
        for (row, cross) in self.columns.chunks_exact_mut(stride).zip(all) {
            let gain = cross * reciprocal;
            for (value, innovation) in row.iter_mut().zip(&self.whitened) {
                *value += gain * innovation;
            }
        }
        let joint = &mut self.covariance;
        joint.moving = reduced(&joint.moving, &cross, jacobian, variance, total);
        let count = self.walk_cross.len();
        for (w, walk) in self.walk_cross.iter().enumerate() {
            for i in 0..M {
                joint.cross[w][i] -= cross[i] * (walk / total);
            }
            for (v, other) in self.walk_cross.iter().enumerate() {
                joint.walks[w * count + v] -= walk * other / total;
            }
        }
        Ok(deviation)
    }
}

/// Multiplies columns, a row for each moving state and then for each walk, by a transition.
pub(crate) fn predict_columns<const M: usize>(
    transition: &[[f64; M]; M],
    steps: &[WalkStep<M>],
    columns: &mut [f64],
    stride: usize,
) {
    map_columns(transition, columns, stride);
    let (moving, walks) = columns.split_at_mut(M * stride);
    for (step, walk) in steps.iter().zip(walks.chunks_exact(stride)) {
        for (row, effect) in moving.chunks_exact_mut(stride).zip(step.effect) {
            for (value, change) in row.iter_mut().zip(walk) {
                *value += effect * change;
            }
        }
    }
}

/// An element of K H beyond which Joseph's form loses more to rounding than it saves: with its square,
/// here sixteen, it multiplies what rounding has left in P.
const LARGE_GAIN: f64 = 4.0;

/// Covariance after one output, `cross` being P Hᵀ and `total` the variance of the innovation.
///
/// Joseph's form squares I − K H, and with it what rounding has left in P: where a direction
/// that is nearly unknown is seen at a small angle, as the azimuth is near a pole, elements of K H
/// reach 1e5 and that is more than is left of P. What is taken from P is then taken once.
fn reduced<const M: usize>(
    covariance: &[[f64; M]; M],
    cross: &[f64; M],
    jacobian: &[f64; M],
    variance: f64,
    total: f64,
) -> [[f64; M]; M] {
    let mut left = [[0.0; M]; M];
    let mut largest: f64 = 0.0;
    for i in 0..M {
        let gain = cross[i] / total;
        for j in 0..M {
            let taken = gain * jacobian[j];
            largest = largest.max(taken.abs());
            left[i][j] = f64::from(u8::from(i == j)) - taken;
        }
    }
    if largest > LARGE_GAIN {
        return core::array::from_fn(|i| {
            core::array::from_fn(|j| covariance[i][j] - cross[i] * (cross[j] / total))
        });
    }
    // Rounding cannot take more from P than there is.
    let mut updated = sandwich(&left, covariance);
    for i in 0..M {
        for j in 0..M {
            updated[i][j] += cross[i] / total * variance * (cross[j] / total);
        }
    }
    updated
}

/// Cholesky factor of a small symmetric matrix, or `None` if it is not positive definite.
pub(crate) fn cholesky<const M: usize>(matrix: &[[f64; M]; M]) -> Option<[[f64; M]; M]> {
    let mut lower = [[0.0; M]; M];
    for i in 0..M {
        for j in 0..=i {
            let mut sum = matrix[i][j];
            for l in 0..j {
                sum -= lower[i][l] * lower[j][l];
            }
            if i == j {
                if !(sum > 0.0 && sum.is_finite()) {
                    return None;
                }
                lower[i][i] = Scalar::sqrt(sum);
            } else {
                lower[i][j] = sum / lower[j][j];
            }
        }
    }
    Some(lower)
}

/// L⁻¹ v.
pub(crate) fn forward<const M: usize>(lower: &[[f64; M]; M], vector: &[f64; M]) -> [f64; M] {
    let mut solution = [0.0; M];
    for i in 0..M {
        let mut sum = vector[i];
        for l in 0..i {
            sum -= lower[i][l] * solution[l];
        }
        solution[i] = sum / lower[i][i];
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::reduced;

    /// A direction that is nearly unknown, seen at an angle at which it moves the output by a few
    /// sigmas: a platform's azimuth near a pole.
    #[test]
    fn rounding_takes_no_more_than_there_is_where_the_gain_is_large() {
        let (unknown, known, angle, noise) = (3.3, 1e-10, 1e-5, 1e-10);
        // Axes that hide it, as those of a platform do.
        let (u, v) = ([0.8, 0.6], [-0.6, 0.8]);
        let covariance: [[f64; 2]; 2] = core::array::from_fn(|i| {
            core::array::from_fn(|j| unknown * u[i] * u[j] + known * v[i] * v[j])
        });
        let jacobian: [f64; 2] = core::array::from_fn(|i| v[i] + angle * u[i]);
        let cross: [f64; 2] = core::array::from_fn(|i| unknown * angle * u[i] + known * v[i]);
        let total = unknown * angle * angle + known + noise;
        let updated = reduced(&covariance, &cross, &jacobian, noise, total);
        let along = |a: [f64; 2], b: [f64; 2]| -> f64 {
            (0..2)
                .map(|i| (0..2).map(|j| a[i] * updated[i][j] * b[j]).sum::<f64>())
                .sum()
        };
        // By hand, without differences of large numbers.
        let of_unknown = unknown * (known + noise) / total;
        let of_known = known * (unknown * angle * angle + noise) / total;
        // Rounding of numbers of 3.3, some of them: Joseph's form is off by 2e-7.
        assert!((along(u, u) - of_unknown).abs() < 1e-14, "{}", along(u, u));
        assert!((along(v, v) - of_known).abs() < 1e-14, "{}", along(v, v));
    }
}
