use core::marker::PhantomData;

use gyrocal_scalar::{Real, Recentre};

use crate::covariance::{self, Observation, Projection};
use crate::error::EstimationError;
use crate::innovation::Innovation;
use crate::lanes4::{load_rows, mul_add, store};
use crate::storage::{Storage, View};
use crate::transition::{Integration, Integrator};

/// When the chart of the moving states is moved to the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Recentring<T> {
    /// At every step, and corrections are applied on the manifold: the consistent choice.
    EveryStep,
    /// When a moving state leaves ±limit; in between, corrections are added to coordinates.
    Beyond(T),
    /// Never: coordinates of the first chart all along.
    Never,
}

impl<T: Real> Recentring<T> {
    #[inline(always)]
    fn wanted<const M: usize>(self, moving: &[T; M]) -> bool {
        match self {
            Self::EveryStep => true,
            Self::Beyond(limit) => moving.iter().any(|state| state.abs() > limit),
            Self::Never => false,
        }
    }
}

/// Continuous-discrete extended Kalman filter on a generated model.
///
/// `M` moving states, `Y` outputs, and as many parameters as the model has. The state is
/// `[moving, parameters]`; noise enters the rates, held over each step.
#[derive(Clone, Debug)]
pub struct Filter<T, D, I, S, const M: usize, const Y: usize> {
    model: D,
    inputs: I,
    integration: Integration,
    recentring: Recentring<T>,
    storage: S,
    moving_transition: [[T; M]; M],
    number: PhantomData<T>,
}

impl<T, D, S, const M: usize, const Y: usize> Filter<T, D, D::Inputs, S, M, Y>
where
    T: Real,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
{
    /// A filter at `state` with independent prior errors of the given standard deviations.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if lengths differ from the model's number of
    /// states or `integration` has no sub-step; [`EstimationError::NotPositiveDefinite`] if a
    /// sigma is not positive.
    pub fn new(
        model: D,
        inputs: D::Inputs,
        integration: Integration,
        recentring: Recentring<T>,
        mut storage: S,
        state: &[T],
        sigma: &[T],
    ) -> Result<Self, EstimationError> {
        let n = storage.states();
        if M + model.parameters() != n || state.len() != n || sigma.len() != n {
            return Err(EstimationError::InvalidArgument {
                expected: "as many states, sigmas and places in the storage as the model has",
            });
        }
        if integration.substeps() == 0 {
            return Err(EstimationError::InvalidArgument {
                expected: "at least one sub-step",
            });
        }
        let buffers = storage.buffers();
        buffers.state.copy_from_slice(state);
        buffers.covariance.fill(T::from_f64(0.0));
        for (j, sigma) in sigma.iter().enumerate() {
            let variance = *sigma * *sigma;
            if !(sigma.is_positive() && variance.is_finite()) {
                return Err(EstimationError::NotPositiveDefinite { state: j });
            }
            buffers.covariance[j * n + j] = variance;
        }
        let mut filter = Self {
            model,
            inputs,
            integration,
            recentring,
            storage,
            moving_transition: [[T::from_f64(0.0); M]; M],
            number: PhantomData,
        };
        filter.recentre_at_start()?;
        Ok(filter)
    }

    /// The prior is given in the coordinates of the first chart; carries it to a chart at the
    /// first state where the policy wants one.
    fn recentre_at_start(&mut self) -> Result<(), EstimationError> {
        let n = self.storage.states();
        let buffers = self.storage.buffers();
        let mut moving = to_array(&buffers.state[..M]);
        if !self.recentring.wanted(&moving) {
            return Ok(());
        }
        let Some(map) = self.model.recentre(&mut moving, &mut self.inputs) else {
            return Ok(());
        };
        buffers.state[..M].copy_from_slice(&moving);
        let zero = [T::from_f64(0.0); M];
        buffers.transition.fill(T::from_f64(0.0));
        let columns = &buffers.transition[..M * (n - M)];
        covariance::predict(buffers.covariance, n, &map, columns, &[zero; M], &zero)
    }

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
        let n = self.storage.states();
        let buffers = self.storage.buffers();
        let (moving_slice, parameters) = buffers.state.split_at_mut(M);
        let mut moving = to_array(moving_slice);
        let mut transition = Integrator {
            model: &self.model,
            inputs: &self.inputs,
            parameters,
            columns: buffers.transition,
            stages: buffers.stages,
            at_origin: self.recentring == Recentring::EveryStep && self.model.has_chart(),
        }
        .integrate(self.integration, dt, &mut moving);
        if !moving.iter().all(|state| state.is_finite()) {
            return Err(EstimationError::NotFinite {
                quantity: "a predicted moving state",
            });
        }
        if self.recentring.wanted(&moving)
            && let Some(map) = self.model.recentre(&mut moving, &mut self.inputs)
        {
            transition.moving = small_product(&map, &transition.moving);
            if self.model.noise_parameters().is_none() {
                transition.noise = small_product(&map, &transition.noise);
            }
            map_rows(&map, buffers.transition, n - M);
        }
        if let Some(same) = self.model.noise_parameters() {
            for (i, row) in transition.noise.iter_mut().enumerate() {
                for (noise, parameter) in row.iter_mut().zip(same) {
                    *noise = buffers.transition[i * (n - M) + parameter];
                }
            }
        }
        moving_slice.copy_from_slice(&moving);
        self.moving_transition = transition.moving;
        let variance = noise_density.map(|density| density / dt);
        covariance::predict(
            buffers.covariance,
            n,
            &transition.moving,
            &buffers.transition[..M * (n - M)],
            &transition.noise,
            &variance,
        )
    }

    /// Updates with a measurement of the outputs, NaN where a component is missing.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`] if a noise variance is not positive (index of
    /// the output); [`EstimationError::NotFinite`] if the innovation is not finite.
    #[inline]
    pub fn update(
        &mut self,
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Result<Innovation<T, Y>, EstimationError> {
        check_noise(noise_variance)?;
        let mut moving = to_array(&self.storage.view().state[..M]);
        let observation = self.observe(&moving, measured, noise_variance);
        let (n, q) = (self.storage.states(), self.model.output_parameters());
        let buffers = self.storage.buffers();
        let (moving_slice, parameters) = buffers.state.split_at_mut(M);
        let output = &buffers.output[..Y * q];
        let projection = Projection::new(buffers.covariance, n, &observation, output)?;
        let innovation = projection.innovation()?;
        let correction =
            projection.update(buffers.covariance, n, parameters, &innovation, buffers.gain)?;
        match self.recentring {
            Recentring::EveryStep => {
                self.model
                    .correct(&mut moving, &mut self.inputs, &correction);
            }
            _ => {
                for i in 0..M {
                    moving[i] = moving[i] + correction[i];
                }
            }
        }
        moving_slice.copy_from_slice(&moving);
        Ok(innovation)
    }

    /// Residual, Jacobian and noise of a measurement; components that are NaN are blanked.
    #[inline(always)]
    fn observe(
        &mut self,
        moving: &[T; M],
        measured: &[T; Y],
        noise_variance: &[T; Y],
    ) -> Observation<T, M, Y> {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let q = self.model.output_parameters();
        let buffers = self.storage.buffers();
        let mut observation = Observation {
            moving: [[zero; M]; Y],
            variance: [one; Y],
            residual: [zero; Y],
            observed: [false; Y],
        };
        let (parameters, d_parameters) = (&buffers.state[M..], &mut buffers.output[..Y * q]);
        let d_moving = &mut observation.moving;
        let predicted = if self.recentring == Recentring::EveryStep && self.model.has_chart() {
            self.model
                .output_jacobian_at_origin(parameters, &self.inputs, d_moving, d_parameters)
        } else {
            self.model
                .output_jacobian(moving, parameters, &self.inputs, d_moving, d_parameters)
        };
        for k in 0..Y {
            if measured[k].is_nan() {
                observation.moving[k] = [zero; M];
                buffers.output[k * q..(k + 1) * q].fill(zero);
            } else {
                observation.residual[k] = measured[k] - predicted[k];
                observation.variance[k] = noise_variance[k];
                observation.observed[k] = true;
            }
        }
        observation
    }

    /// As [`Self::update`], but a measurement whose NIS exceeds `largest_nis` is not used.
    /// Returns the innovation and whether the measurement was used.
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
        let moving = to_array(&self.storage.view().state[..M]);
        let observation = self.observe(&moving, measured, noise_variance);
        let (n, q) = (self.storage.states(), self.model.output_parameters());
        let buffers = self.storage.buffers();
        let output = &buffers.output[..Y * q];
        let innovation =
            Projection::new(buffers.covariance, n, &observation, output)?.innovation()?;
        if innovation.nis > largest_nis {
            return Ok((innovation, false));
        }
        self.update(measured, noise_variance)
            .map(|innovation| (innovation, true))
    }

    /// The state: moving states in the current chart, then parameters.
    #[must_use]
    pub fn state(&self) -> &[T] {
        self.storage.view().state
    }

    /// Element (`i`, `j`) of the error covariance.
    ///
    /// # Panics
    /// If an index is not that of a state.
    #[must_use]
    pub fn covariance(&self, i: usize, j: usize) -> T {
        covariance::element(
            self.storage.view().covariance,
            self.storage.states(),
            M,
            i,
            j,
        )
    }

    /// Standard deviation of the error of state `i`.
    ///
    /// # Panics
    /// If `i` is not the index of a state.
    #[must_use]
    pub fn sigma(&self, i: usize) -> T {
        self.covariance(i, i).sqrt()
    }

    /// What the model depends on besides its state; it carries the chart.
    #[must_use]
    pub fn inputs(&self) -> &D::Inputs {
        &self.inputs
    }

    /// The inputs, to change what is held over the next step.
    pub fn inputs_mut(&mut self) -> &mut D::Inputs {
        &mut self.inputs
    }

    /// Numbers that persist between steps: factors, last transition and gain.
    #[must_use]
    pub fn view(&self) -> View<'_, T> {
        self.storage.view()
    }

    /// Moving columns of the last transition.
    #[must_use]
    pub fn moving_transition(&self) -> &[[T; M]; M] {
        &self.moving_transition
    }
}

#[inline(always)]
fn check_noise<T: Real, const Y: usize>(variance: &[T; Y]) -> Result<(), EstimationError> {
    for (output, variance) in variance.iter().enumerate() {
        if !(variance.is_positive() && variance.is_finite()) {
            return Err(EstimationError::NotPositiveDefinite { state: output });
        }
    }
    Ok(())
}

#[inline(always)]
fn to_array<T: Copy + Default, const M: usize>(slice: &[T]) -> [T; M] {
    let mut array = [T::default(); M];
    array.copy_from_slice(slice);
    array
}

#[inline(always)]
fn small_product<T: Real, const M: usize>(a: &[[T; M]; M], b: &[[T; M]; M]) -> [[T; M]; M] {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            (0..M).fold(T::from_f64(0.0), |sum, l| a[i][l].mul_add(b[l][j], sum))
        })
    })
}

/// Replaces the M rows of `rows` (stride p) by their product with `map` from the left.
#[inline(always)]
fn map_rows<T: Real, const M: usize>(map: &[[T; M]; M], rows: &mut [T], p: usize) {
    let mut column = 0;
    while column + 4 <= p {
        map_columns::<T, M, 4>(map, rows, p, column);
        column += 4;
    }
    while column < p {
        map_columns::<T, M, 1>(map, rows, p, column);
        column += 1;
    }
}

#[inline(always)]
fn map_columns<T: Real, const M: usize, const W: usize>(
    map: &[[T; M]; M],
    rows: &mut [T],
    p: usize,
    column: usize,
) {
    let old: [[T; W]; M] = load_rows(rows, p, column);
    for (i, weights) in map.iter().enumerate() {
        let mut sum = [T::from_f64(0.0); W];
        for (row, weight) in old.iter().zip(weights) {
            sum = mul_add(*row, *weight, sum);
        }
        store(rows, i * p + column, sum);
    }
}
