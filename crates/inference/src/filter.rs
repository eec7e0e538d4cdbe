//! The small Kalman filter of the states given the parameters, with sensitivity columns.

use gyrocal_estimation::EstimationError;

use crate::record::Start;
use crate::small::{apply, dot, product, sandwich};

/// Mean, sensitivities and covariance of the deviation of the states from the trajectory. Column 0 is the
/// mean.
pub(crate) struct Filter {
    pub(crate) states: usize,
    pub(crate) stride: usize,
    /// One row of 1 + count numbers for each state.
    pub(crate) columns: Vec<f64>,
    /// By rows.
    pub(crate) covariance: Vec<f64>,
    /// The whitened row of the last output: residual, then columns.
    pub(crate) whitened: Vec<f64>,
    /// Covariance of the states with the last output before its update.
    pub(crate) cross: Vec<f64>,
    /// Whether the states have any noise.
    is_noisy: bool,
    /// Memory of the size of the columns, and of that of the covariance.
    moved: Vec<f64>,
    memory: Vec<f64>,
    gain: Vec<f64>,
}

impl Filter {
    pub(crate) fn new(columns: usize, start: &Start, is_driven: bool) -> Self {
        let (n, stride) = (start.deviation.len(), columns + 1);
        let mut all = vec![0.0; n * stride];
        for (row, mean) in all.chunks_exact_mut(stride).zip(&start.deviation) {
            row[0] = *mean;
        }
        Self {
            states: n,
            stride,
            columns: all,
            covariance: start.covariance.clone(),
            whitened: vec![0.0; stride],
            cross: vec![0.0; n],
            is_noisy: is_driven || start.covariance.iter().any(|element| *element != 0.0),
            moved: vec![0.0; n * stride],
            memory: vec![0.0; n * n],
            gain: vec![0.0; n],
        }
    }

    /// Mean of the states.
    pub(crate) fn mean(&self) -> impl Iterator<Item = f64> + '_ {
        self.columns.iter().step_by(self.stride).copied()
    }

    /// Row of a state in the columns.
    pub(crate) fn row_mut(&mut self, state: usize) -> &mut [f64] {
        &mut self.columns[state * self.stride..(state + 1) * self.stride]
    }

    /// Multiplies by the transition and adds the noise of the step; what drives the columns is added by the
    /// caller.
    pub(crate) fn predict(&mut self, transition: &[f64], noise: &[f64]) {
        match self.states {
            3 => self.predict_of(3, transition, noise),
            states => self.predict_of(states, transition, noise),
        }
    }

    #[inline(always)]
    fn predict_of(&mut self, n: usize, transition: &[f64], noise: &[f64]) {
        product(transition, &self.columns, n, self.stride, &mut self.moved);
        core::mem::swap(&mut self.columns, &mut self.moved);
        if !self.is_noisy {
            return;
        }
        sandwich(transition, &mut self.covariance, n, &mut self.memory);
        for (sum, value) in self.covariance.iter_mut().zip(noise) {
            *sum += value;
        }
    }

    /// Takes one output. [`Self::whitened`] holds the residual of the trajectory and minus the direct
    /// derivatives of the output on entry; on return it is the innovation of each column over the returned
    /// standard deviation.
    pub(crate) fn update(
        &mut self,
        jacobian: &[f64],
        variance: f64,
    ) -> Result<f64, EstimationError> {
        match self.states {
            3 => self.update_of(3, jacobian, variance),
            states => self.update_of(states, jacobian, variance),
        }
    }

    #[inline(always)]
    fn update_of(
        &mut self,
        n: usize,
        jacobian: &[f64],
        variance: f64,
    ) -> Result<f64, EstimationError> {
        let stride = self.stride;
        let jacobian = &jacobian[..n];
        for (by, row) in jacobian.iter().zip(self.columns.chunks_exact(stride)) {
            if *by != 0.0 {
                for (innovation, value) in self.whitened.iter_mut().zip(row) {
                    *innovation -= by * value;
                }
            }
        }
        let mut total = variance;
        if self.is_noisy {
            let cross = &mut self.cross[..n];
            apply(&self.covariance[..n * n], jacobian, cross);
            total += dot(jacobian, cross);
        }
        if !(total.is_finite() && total > 0.0) {
            return Err(EstimationError::NotFinite {
                quantity: "the variance of an innovation",
            });
        }
        let deviation = total.sqrt();
        let reciprocal = 1.0 / deviation;
        for innovation in &mut self.whitened {
            *innovation *= reciprocal;
        }
        if !self.is_noisy {
            return Ok(deviation);
        }
        for (row, cross) in self.columns.chunks_exact_mut(stride).zip(&self.cross) {
            let gain = cross * reciprocal;
            if gain != 0.0 {
                for (value, innovation) in row.iter_mut().zip(&self.whitened) {
                    *value += gain * innovation;
                }
            }
        }
        self.reduce_covariance(n, jacobian, variance, total);
        Ok(deviation)
    }

    /// The covariance after one output, `total` being the variance of the innovation.
    ///
    /// Joseph's form squares I − K H, and with it what rounding has left in P: where a direction
    /// that is nearly unknown is seen at a small angle, as the azimuth is near a pole, elements of K H
    /// reach 1e5 and that is more than is left of P. What is taken from P is then taken once.
    #[inline(always)]
    fn reduce_covariance(&mut self, n: usize, jacobian: &[f64], variance: f64, total: f64) {
        let (cross, gain) = (&self.cross[..n], &mut self.gain[..n]);
        let (covariance, excess) = (&mut self.covariance[..n * n], &mut self.memory[..n]);
        for (gain, cross) in gain.iter_mut().zip(cross) {
            *gain = cross / total;
        }
        let most = |all: &[f64]| all.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        let is_large = most(gain) * most(jacobian) > LARGE_GAIN;
        for i in 0..n {
            for j in 0..n {
                covariance[i * n + j] -= gain[i] * cross[j];
            }
        }
        if is_large {
            return;
        }
        // (I − K H) P Hᵀ − K R, which is zero but for rounding: rounding cannot take more from P than there is.
        apply(covariance, jacobian, excess);
        for (excess, gain) in excess.iter_mut().zip(&*gain) {
            *excess -= gain * variance;
        }
        for i in 0..n {
            for j in 0..=i {
                let both = covariance[i * n + j] + covariance[j * n + i];
                let sum = 0.5 * (both - (excess[i] * gain[j] + excess[j] * gain[i]));
                covariance[i * n + j] = sum;
                covariance[j * n + i] = sum;
            }
        }
    }
}

/// An element of K H beyond which Joseph's form loses more to rounding than it saves: with its square,
/// here sixteen, it multiplies what rounding has left in P.
const LARGE_GAIN: f64 = 4.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction that is nearly unknown, seen at an angle at which it moves the output by a few
    /// sigmas: a platform's azimuth near a pole.
    #[test]
    fn rounding_takes_no_more_than_there_is_where_the_gain_is_large() {
        let (unknown, known, angle, noise) = (3.3, 1e-10, 1e-5, 1e-10);
        // Axes that hide it, as those of a platform do.
        let (u, v) = ([0.8, 0.6], [-0.6, 0.8]);
        let element = |i: usize, j: usize| unknown * u[i] * u[j] + known * v[i] * v[j];
        let covariance = (0..4).map(|place| element(place / 2, place % 2)).collect();
        let start = Start {
            deviation: vec![0.0; 2],
            covariance,
            cost: 0.0,
            noises: Vec::new(),
        };
        let mut filter = Filter::new(0, &start, true);
        let jacobian: [f64; 2] = core::array::from_fn(|i| v[i] + angle * u[i]);
        // By hand, since rounding of P alone would move the variance of the innovation by a part in 1e6.
        filter.cross = (0..2)
            .map(|i| unknown * angle * u[i] + known * v[i])
            .collect();
        let total = unknown * angle * angle + known + noise;
        filter.reduce_covariance(2, &jacobian, noise, total);
        let along = |a: [f64; 2], b: [f64; 2]| -> f64 {
            (0..2)
                .map(|i| {
                    (0..2)
                        .map(|j| a[i] * filter.covariance[2 * i + j] * b[j])
                        .sum::<f64>()
                })
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
