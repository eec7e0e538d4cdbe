//! Where a linear output does not serve: samples that surprise, and a first sample after a gap.

use gyrocal_estimation::Precision;
use gyrocal_estimation::form::Form;

use super::PlatformFilter;
use crate::rotation::dot;

/// Most times that the noise of a sample is doubled: from 1e-6 g to g.
const MOST_DOUBLINGS: u32 = 40;

impl<T: Precision, F: Form<T>> PlatformFilter<T, F> {
    /// Bound of what a linear output leaves out, squared, g². With an error of the attitude of a tilt t and
    /// a turn a about the vertical that is g t²/2 along the vertical and g a t/2 across. At six sigmas of
    /// all of them, which the largest NIS by default stands for, each is below 18 g times the product of
    /// the sigmas: six times the root of nine.
    pub(crate) fn curved_g2(&self) -> T {
        let [tilt_g2, whole] = self.spread();
        T::from_f64(9.0) * tilt_g2 * whole
    }

    /// Variance of the tilt times that of gravity, g², and of the whole attitude, rad².
    #[cold]
    #[inline(never)]
    fn spread(&self) -> [T; 2] {
        let up = &self.kernel.inputs().inputs().f_0;
        let (mut along, mut whole) = (T::ZERO, T::ZERO);
        for (i, own) in up.iter().enumerate() {
            for (j, other) in up.iter().enumerate() {
                let covariance = self.attitude_covariance(i, j);
                along = (*own * *other).mul_add(covariance, along);
                if i == j {
                    whole = whole + covariance;
                }
            }
        }
        [(whole * dot(up, up) - along).max(T::ZERO), whole]
    }

    /// Out of line, as elements are asked for one by one.
    #[inline(never)]
    fn attitude_covariance(&self, i: usize, j: usize) -> T {
        self.kernel.covariance(i, j)
    }

    /// Variance of the attitude, rad²: the sum over its axes.
    pub(crate) fn attitude_variance(&self) -> T {
        let [_, whole] = self.spread();
        whole
    }

    /// Variance of a component of a sample, g².
    pub(crate) fn noise_g2(&self) -> T {
        let [noise, ..] = self.accel_variance_g2;
        noise
    }

    /// Doublings of the noise until it is what a linear output leaves out; none while a variance of the
    /// attitude alone, rad², leaves less than that.
    #[cold]
    pub(crate) fn doublings(&self, variance: T) -> u32 {
        let up = &self.kernel.inputs().inputs().f_0;
        let mut noise = self.noise_g2();
        let alone = T::from_f64(9.0) * variance * variance * dot(up, up);
        let curved = self.curved_g2();
        let mut doublings = 0;
        while alone > noise && curved > noise && doublings < MOST_DOUBLINGS {
            noise = noise + noise;
            doublings += 1;
        }
        doublings
    }
}
