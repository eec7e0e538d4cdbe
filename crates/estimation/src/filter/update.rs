use gyrocal_scalar::{Real, Recentre};

use super::{Filter, to_array};
use crate::error::EstimationError;
use crate::form::{Form, Numbers, Observation};
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
            self.update_with::<true>(measured, noise_variance, None, None)
        } else {
            self.update_elsewhere(measured, noise_variance)
        }
    }

    /// As [`Self::update`], for a filter whose chart moves at every step: a program that calls only
    /// this one does without the code for other charts. A measurement whose NIS exceeds `largest_nis`
    /// changes nothing, and takes no longer; a negative limit asks for the innovation alone.
    ///
    /// # Errors
    /// As [`Self::update`]; [`EstimationError::InvalidArgument`] for a filter with another chart.
    #[inline]
    pub fn update_at_origin(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
        largest_nis: T,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        if !self.at_origin() {
            return Err(EstimationError::InvalidArgument {
                expected: "a chart that moves at every step",
            });
        }
        self.update_with::<true>(measured, noise_variance, None, Some(largest_nis))
    }

    /// As [`Self::update_at_origin`], but the correction takes standardised innovations up to `clip`
    /// only, and larger ones as this one with their sign: what an outlier does is bounded. An output
    /// that the state predicts worse than its own noise is not clipped, as after a start. NIS and
    /// covariance are as ever.
    ///
    /// # Errors
    /// As [`Self::update_at_origin`].
    #[inline]
    pub fn update_clipped(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
        clip: T,
        largest_nis: T,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        if !self.at_origin() {
            return Err(EstimationError::InvalidArgument {
                expected: "a chart that moves at every step",
            });
        }
        self.update_with::<true>(measured, noise_variance, Some(clip), Some(largest_nis))
    }

    /// The state has moved along a direction, by a size of which an estimate and its variance are
    /// known; a random walk moves a parameter by zero with the variance of its step. Errors of the
    /// size must be independent of those of the state. Moving states are errors at the origin of the
    /// chart, as a correction is.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] for a direction of another length, or one or a size that
    /// is not finite, or a variance that is negative; nothing has changed.
    #[inline]
    pub fn displace(
        &mut self,
        direction: &[T],
        size: T,
        variance: T,
    ) -> Result<(), EstimationError> {
        let finite = direction.iter().all(|element| element.is_finite())
            && size.is_finite()
            && variance.is_finite();
        if direction.len() != self.storage.states() || !finite || variance < T::ZERO {
            return Err(EstimationError::InvalidArgument {
                expected: "a direction of as many finite numbers as states, and a variance",
            });
        }
        let buffers = self.storage.buffers();
        let (head, rest) = direction.split_at_checked(M).unwrap_or_default();
        if size != T::ZERO {
            let (moving_slice, parameters) = buffers.state.split_at_mut(M);
            let mut moving = to_array(moving_slice);
            let mut correction = [T::ZERO; M];
            for (place, element) in correction.iter_mut().zip(head) {
                *place = *element * size;
            }
            match self.recentring {
                Recentring::EveryStep => {
                    let inputs = &mut self.inputs;
                    self.model.correct(&mut moving, inputs, &correction);
                }
                _ => moving = add(&moving, &correction),
            }
            moving_slice.copy_from_slice(&moving);
            for (parameter, element) in parameters.iter_mut().zip(rest) {
                *parameter = element.mul_add(size, *parameter);
            }
        }
        F::diffuse(&mut numbers!(buffers), direction, variance);
        Ok(())
    }

    /// A function of its own: the step from the origin is then not inlined together with it.
    #[inline(never)]
    fn update_elsewhere(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        self.update_with::<false>(measured, noise_variance, None, None)
    }

    #[inline(always)]
    fn update_with<const AT_ORIGIN: bool>(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
        clip: Option<T>,
        largest_nis: Option<T>,
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
        let observation = Observation {
            clip,
            largest_nis,
            ..sensor.observe(
                &moving,
                parameters,
                buffers.output,
                measured,
                noise_variance,
            )
        };
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
                kept: buffers.kept,
            };
            let innovation = F::update(&mut numbers, cross, &observation, &known, correct)?;
            if observation.is_refused(innovation.nis) {
                return Ok(innovation);
            }
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

    /// P ← `factor` P: every error is as much more uncertain, with the correlations that it has.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if the factor is not positive and finite;
    /// nothing has changed.
    pub fn widen(&mut self, factor: T) -> Result<(), EstimationError> {
        if !(factor.is_positive() && factor.is_finite()) {
            return Err(EstimationError::InvalidArgument {
                expected: "a positive factor",
            });
        }
        let buffers = self.storage.buffers();
        F::widen(&mut numbers!(buffers), factor);
        Ok(())
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
