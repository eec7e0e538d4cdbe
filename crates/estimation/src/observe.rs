//! From a measurement to what an update takes.

use gyrocal_scalar::{Real, Recentre};

use crate::error::EstimationError;
use crate::form::Observation;

/// Model and inputs that turn a measurement into an observation.
pub(crate) struct Sensor<'a, D, I> {
    pub(crate) model: &'a D,
    pub(crate) inputs: &'a I,
    pub(crate) at_origin: bool,
}

impl<D, I: Copy> Sensor<'_, D, I> {
    /// Residual, Jacobian and noise of a measurement; components that are NaN are blanked.
    #[inline(always)]
    pub(crate) fn observe<'b, T: Real, const M: usize, const Y: usize>(
        &self,
        moving: &[T; M],
        parameters: &[T],
        output: &'b mut [T],
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Observation<'b, T, M, Y>
    where
        D: Recentre<T, M, Y, Inputs = I>,
    {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let q = self.model.output_parameters();
        let output = &mut output[..Y * q];
        let mut jacobian = [[zero; M]; Y];
        let predicted = if self.at_origin {
            self.model
                .output_jacobian_at_origin(parameters, self.inputs, &mut jacobian, output)
        } else {
            self.model
                .output_jacobian(moving, parameters, self.inputs, &mut jacobian, output)
        };
        let mut residual = [zero; Y];
        let mut variance = [one; Y];
        let mut observed = [false; Y];
        for k in 0..Y {
            if measured[k].is_nan() {
                jacobian[k] = [zero; M];
                output[k * q..(k + 1) * q].fill(zero);
            } else {
                residual[k] = measured[k] - predicted[k];
                variance[k] = noise_variance[k];
                observed[k] = true;
            }
        }
        Observation {
            moving: jacobian,
            parameters: output,
            variance,
            residual,
            observed,
            clip: None,
            largest_nis: None,
        }
    }
}

#[inline(always)]
pub(crate) fn check_noise<T: Real, const Y: usize>(
    variance: &[T; Y],
) -> Result<(), EstimationError> {
    let (mut bad, mut sum) = (0_u32, T::from_f64(0.0));
    for variance in variance {
        bad |= u32::from(!variance.is_positive());
        sum = sum + *variance;
    }
    // A sum of positive numbers is finite only if all of them are.
    if bad == 0 && sum.is_finite() {
        return Ok(());
    }
    let mut variances = variance.iter();
    let output = variances.position(|variance| !(variance.is_positive() && variance.is_finite()));
    Err(EstimationError::InvalidNoise {
        output: output.unwrap_or(0),
    })
}
