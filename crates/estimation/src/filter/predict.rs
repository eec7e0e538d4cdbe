use gyrocal_scalar::Recentre;

use super::{Filter, to_array};
use crate::error::EstimationError;
use crate::form::{Form, Numbers, Transition};
use crate::precision::Precision;
use crate::storage::Storage;
use crate::transition::{Integration, Integrator};
use crate::zeros::Known;

impl<T, D, S, const M: usize, const Y: usize, F> Filter<T, D, D::Inputs, S, M, Y, F>
where
    T: Precision,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
    F: Form<T>,
{
    /// Predicts over `dt` seconds with noise of the given spectral densities (unit of the
    /// noise input squared, times seconds).
    ///
    /// The noise is held over the step: its variance is density / dt.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if `dt` is not positive;
    /// [`EstimationError::NotFinite`] or [`EstimationError::NotPositiveDefinite`] if the
    /// prediction left the numbers.
    #[inline]
    pub fn predict(&mut self, dt: T, noise_density: &[T; M]) -> Result<(), EstimationError> {
        if !(dt.is_positive() && dt.is_finite()) {
            return Err(EstimationError::InvalidArgument {
                expected: "a positive step",
            });
        }
        let (n, at_origin) = (self.storage.states(), self.at_origin());
        let buffers = self.storage.buffers();
        let (moving_slice, parameters) = buffers.state.split_at_mut(M);
        let mut moving = to_array(moving_slice);
        let derivatives = Integrator {
            model: &self.model,
            inputs: &self.inputs,
            parameters,
            columns: buffers.transition,
            stages: buffers.stages,
            at_origin,
        }
        .integrate(self.integration, dt, &mut moving);
        if !moving.iter().all(|state| state.is_finite()) {
            return Err(EstimationError::NotFinite {
                quantity: "a predicted moving state",
            });
        }
        let mut map = None;
        if self.recentring.wanted(&moving) {
            map = self.model.recentre(&mut moving, &mut self.inputs);
        }
        let mut noise = derivatives.noise;
        if let Some(same) = self.model.noise_parameters() {
            for (i, row) in noise.iter_mut().enumerate() {
                for (noise, parameter) in row.iter_mut().zip(same) {
                    *noise = buffers.transition[i * (n - M) + parameter];
                }
            }
        }
        moving_slice.copy_from_slice(&moving);
        self.moving_transition = derivatives.moving;
        self.map = map;
        let transition = Transition {
            moving: derivatives.moving,
            parameters: &buffers.transition[..M * (n - M)],
            noise,
            variance: noise_density.map(|density| density / dt),
            map,
        };
        let numbers = &mut numbers!(buffers);
        if F::USES_ZEROS && at_origin && self.integration == Integration::EULER {
            F::predict::<M, true>(
                numbers,
                &transition,
                &Known::<T, D, M, Y, true>::of(&self.model),
            )
        } else {
            F::predict::<M, false>(
                numbers,
                &transition,
                &Known::<T, D, M, Y, false>::of(&self.model),
            )
        }
    }
}
