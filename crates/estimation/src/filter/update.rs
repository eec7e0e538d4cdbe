use gyrocal_scalar::{Real, Recentre};

use super::{Filter, to_array};
use crate::error::EstimationError;
use crate::form::{Form, Numbers};
use crate::innovation::Innovation;
use crate::observe::{Sensor, check_noise};
use crate::precision::Precision;
use crate::recentring::Recentring;
use crate::storage::Storage;
use crate::zeros::Known;

impl<T, D, S, const M: usize, const Y: usize, F> Filter<T, D, D::Inputs, S, M, Y, F>
where
    T: Precision,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
    F: Form<T>,
{
    /// Updates with a measurement of the outputs, NaN where a component is missing.
    ///
    /// # Errors
    /// [`EstimationError::InvalidNoise`]; [`EstimationError::LostPrecision`];
    /// [`EstimationError::NotFinite`] if the innovation is not finite;
    /// [`EstimationError::NotPositiveDefinite`] if a variance is not positive afterwards.
    #[inline]
    pub fn update(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        if self.at_origin() {
            self.update_with::<true>(measured, noise_variance)
        } else {
            self.update_elsewhere(measured, noise_variance)
        }
    }

    /// As [`Self::update`], for a filter whose chart moves at every step: a program that calls only
    /// this one does without the code for other charts.
    ///
    /// # Errors
    /// As [`Self::update`]; [`EstimationError::InvalidArgument`] for a filter with another chart.
    #[inline]
    pub fn update_at_origin(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        if !self.at_origin() {
            return Err(EstimationError::InvalidArgument {
                expected: "a chart that moves at every step",
            });
        }
        self.update_with::<true>(measured, noise_variance)
    }

    /// A function of its own: the step from the origin is then not inlined together with it.
    #[inline(never)]
    fn update_elsewhere(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        self.update_with::<false>(measured, noise_variance)
    }

    #[inline(always)]
    fn update_with<const AT_ORIGIN: bool>(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        check_noise(noise_variance)?;
        let buffers = self.storage.buffers();
        let (moving_slice, parameters) = buffers.state.split_at_mut(M);
        let mut moving = to_array(moving_slice);
        let sensor = Sensor {
            model: &self.model,
            inputs: &self.inputs,
            at_origin: AT_ORIGIN,
        };
        let observation = sensor.observe(
            &moving,
            parameters,
            buffers.output,
            measured,
            noise_variance,
        );
        let (model, inputs, recentring) = (&self.model, &mut self.inputs, self.recentring);
        let known = Known::<T, D, M, Y, AT_ORIGIN>::of(&self.model);
        let correct = |correction: &[T; M]| match recentring {
            Recentring::EveryStep => model.correct(&mut moving, inputs, correction),
            _ => moving = add(&moving, correction),
        };
        let innovation = if T::is_coarse() {
            // The correction by itself, in workspace of a prediction, which no update uses.
            let (cross, none) = buffers.cross.split_at_mut(parameters.len());
            cross.fill(T::ZERO);
            let mut numbers = Numbers {
                matrix: buffers.matrix,
                pivots: buffers.pivots,
                gain: buffers.gain,
                sweep: buffers.sweep,
                cross: none,
            };
            let innovation = F::update(&mut numbers, cross, &observation, &known, correct)?;
            let remainder = buffers.remainder.iter_mut().skip(M);
            for ((number, left), change) in parameters.iter_mut().zip(remainder).zip(cross) {
                let change = *left + *change;
                let sum = *number + change;
                *left = change - (sum - *number);
                *number = sum;
            }
            innovation
        } else {
            F::update(
                &mut numbers!(buffers),
                parameters,
                &observation,
                &known,
                correct,
            )?
        };
        moving_slice.copy_from_slice(&moving);
        Ok(innovation)
    }

    /// As [`Self::update`], but a measurement whose NIS exceeds `largest_nis` is not used.
    /// Returns the innovation and whether the measurement was used. A NaN limit uses nothing.
    ///
    /// # Errors
    /// As [`Self::update`].
    pub fn update_gated(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
        largest_nis: T,
    ) -> Result<(Innovation<T, Y>, bool), EstimationError> {
        check_noise(noise_variance)?;
        let at_origin = self.at_origin();
        let buffers = self.storage.buffers();
        let (moving, parameters) = buffers.state.split_at(M);
        let sensor = Sensor {
            model: &self.model,
            inputs: &self.inputs,
            at_origin,
        };
        let observation = sensor.observe(
            &to_array(moving),
            parameters,
            buffers.output,
            measured,
            noise_variance,
        );
        let innovation = F::innovation(&mut numbers!(buffers), &observation)?;
        if innovation.nis > largest_nis || largest_nis.is_nan() {
            return Ok((innovation, false));
        }
        self.update(measured, noise_variance)
            .map(|innovation| (innovation, true))
    }
}

#[inline(always)]
fn add<T: Real, const M: usize>(a: &[T; M], b: &[T; M]) -> [T; M] {
    let mut sum = *a;
    for (sum, b) in sum.iter_mut().zip(b) {
        *sum = *sum + *b;
    }
    sum
}
