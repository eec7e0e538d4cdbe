use gyrocal_scalar::Real;

use crate::error::EstimationError;

/// The innovation of one measurement and its predicted covariance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation<T, const Y: usize> {
    /// Measured minus predicted output; zero where nothing was observed.
    pub residual: [T; Y],
    /// True for each output that was observed.
    pub observed: [bool; Y],
    /// Normalised innovation squared over the observed outputs; its expectation is their number.
    pub nis: T,
    /// Residual of each output given the earlier ones, over its variance; clipped where the update
    /// was.
    pub(crate) weights: [T; Y],
    /// L of S = L diag(variance) Lᵀ.
    pub(crate) lower: [[T; Y]; Y],
    /// Variance of each output given the earlier ones.
    pub(crate) variance: [T; Y],
}

impl<T: Real, const Y: usize> Innovation<T, Y> {
    /// From L, α and 1 / α of S = L diag(α) Lᵀ; [`Self::check`] says whether it is finite. `clip` is the
    /// largest standardised innovation, with the noise of each output.
    #[inline(always)]
    pub(crate) fn from_factors(
        residual: [T; Y],
        observed: [bool; Y],
        lower: [[T; Y]; Y],
        variance: [T; Y],
        reciprocal: &[T; Y],
        clip: Option<(T, [T; Y])>,
    ) -> Self {
        let zero = T::from_f64(0.0);
        let mut own = residual;
        let mut weights = [zero; Y];
        let mut nis = zero;
        for k in 0..Y {
            for l in 0..Y {
                if l < k {
                    own[k] = own[k] - lower[k][l] * own[l];
                }
            }
            weights[k] = own[k] * reciprocal[k];
            nis = weights[k].mul_add(own[k], nis);
        }
        if let Some((clip, noise)) = clip {
            for k in 0..Y {
                // Where the state is less certain than the sample, what the clip cuts off would stay
                // in the state as an error that nothing accounts for.
                if variance[k] > noise[k] + noise[k] {
                    continue;
                }
                let most = clip * variance[k].sqrt();
                weights[k] = own[k].max(-most).min(most) * reciprocal[k];
            }
        }
        Self {
            residual,
            observed,
            nis,
            weights,
            lower,
            variance,
        }
    }

    /// Checks that it is finite. An infinite variance would make a weight zero and the rest NaN.
    #[inline(always)]
    pub(crate) fn check(&self) -> Result<(), EstimationError> {
        let mut total = self.nis;
        for k in 0..Y {
            total = total + self.variance[k];
        }
        if total.is_finite() {
            return Ok(());
        }
        Err(EstimationError::NotFinite {
            quantity: "the normalised innovation",
        })
    }

    /// S = H P Hᵀ + R. Rows and columns of outputs that were not observed are NaN.
    #[must_use]
    pub fn covariance(&self) -> [[T; Y]; Y] {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                if !(self.observed[i] && self.observed[j]) {
                    return T::from_f64(f64::NAN);
                }
                (0..=i.min(j)).fold(T::from_f64(0.0), |sum, l| {
                    (self.lower[i][l] * self.variance[l]).mul_add(self.lower[j][l], sum)
                })
            })
        })
    }

    /// Number of observed outputs: the expectation of [`Self::nis`].
    #[must_use]
    pub fn degrees_of_freedom(&self) -> usize {
        self.observed.iter().filter(|observed| **observed).count()
    }

    /// Factor that whitens: rows of L⁻¹ over the root of each variance, so that
    /// [`Self::standardised`] is its product with the residuals where nothing was clipped.
    #[inline]
    #[must_use]
    pub fn whitening(&self) -> [[T; Y]; Y] {
        let one = T::from_f64(1.0);
        let mut rows = [[T::ZERO; Y]; Y];
        for k in 0..Y {
            let mut row = [T::ZERO; Y];
            row[k] = one;
            for l in 0..Y {
                if l < k {
                    for j in 0..Y {
                        row[j] = row[j] - self.lower[k][l] * rows[l][j];
                    }
                }
            }
            rows[k] = row;
        }
        for k in 0..Y {
            let reciprocal = one / self.variance[k].sqrt();
            rows[k] = rows[k].map(|element| element * reciprocal);
        }
        rows
    }

    /// Variance of each output given the earlier ones.
    #[must_use]
    pub fn conditional_variance(&self) -> &[T; Y] {
        &self.variance
    }

    /// Innovations made independent and of unit variance, output by output; zero where
    /// nothing was observed. In a clipped update they are those that the update took.
    #[must_use]
    pub fn standardised(&self) -> [T; Y] {
        core::array::from_fn(|k| self.weights[k] * self.variance[k].sqrt())
    }

    // emit: off
    /// Natural logarithm of the density of this innovation.
    #[must_use]
    pub fn log_likelihood(&self) -> T {
        let log_two_pi = T::from_f64(1.837_877_066_409_345_5);
        let mut sum = self.nis;
        for k in 0..Y {
            if self.observed[k] {
                sum = sum + self.variance[k].ln() + log_two_pi;
            }
        }
        T::from_f64(-0.5) * sum
    }
    // emit: on
}
