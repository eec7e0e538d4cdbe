use core::marker::PhantomData;

use gyrocal_scalar::Recentre;

use crate::error::EstimationError;
use crate::form::{Form, Numbers};
use crate::precision::Precision;
use crate::recentring::Recentring;
use crate::storage::{Storage, View};
use crate::transition::Integration;

/// The part of the buffers that belongs to the covariance.
macro_rules! numbers {
    ($buffers:ident) => {
        Numbers {
            matrix: $buffers.matrix,
            pivots: $buffers.pivots,
            gain: $buffers.gain,
            sweep: $buffers.sweep,
            cross: $buffers.cross,
            kept: $buffers.kept,
        }
    };
}

mod predict;
mod saved;
mod update;

/// Continuous-discrete extended Kalman filter on a generated model.
///
/// `M` moving states, `Y` outputs, and as many parameters as the model has. The state is
/// `[moving, parameters]`; noise enters the rates, held over each step.
#[derive(Clone, Debug)]
pub struct Filter<T, D, I, S, const M: usize, const Y: usize, F = <T as Precision>::Form>
where
    T: Precision,
{
    model: D,
    inputs: I,
    integration: Integration,
    recentring: Recentring<T>,
    storage: S,
    moving_transition: [[T; M]; M],
    map: Option<[[T; M]; M]>,
    form: PhantomData<F>,
}

impl<T, D, S, const M: usize, const Y: usize> Filter<T, D, D::Inputs, S, M, Y>
where
    T: Precision,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
{
    /// A filter in the form that suits its numbers, see [`Self::with_form`].
    ///
    /// # Errors
    /// As [`Self::with_form`].
    pub fn new(
        model: D,
        inputs: D::Inputs,
        integration: Integration,
        recentring: Recentring<T>,
        storage: S,
        state: &[T],
        sigma: &[T],
    ) -> Result<Self, EstimationError> {
        Self::with_form(
            model,
            inputs,
            integration,
            recentring,
            storage,
            state,
            sigma,
        )
    }
}

impl<T, D, S, const M: usize, const Y: usize, F> Filter<T, D, D::Inputs, S, M, Y, F>
where
    T: Precision,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
    F: Form<T>,
{
    /// A filter at `state` with independent prior errors of the given standard deviations.
    ///
    /// # Errors
    /// As [`Self::start`].
    pub fn with_form(
        model: D,
        inputs: D::Inputs,
        integration: Integration,
        recentring: Recentring<T>,
        storage: S,
        state: &[T],
        sigma: &[T],
    ) -> Result<Self, EstimationError> {
        let mut filter = Self::unset(model, inputs, storage);
        filter.start(integration, recentring, state, sigma)?;
        Ok(filter)
    }

    /// A filter that has not started: every step of it fails.
    #[must_use]
    pub const fn unset(model: D, inputs: D::Inputs, storage: S) -> Self {
        Self {
            model,
            inputs,
            integration: Integration::RK4,
            recentring: Recentring::Never,
            storage,
            moving_transition: [[T::ZERO; M]; M],
            map: None,
            form: PhantomData,
        }
    }

    /// Starts in place, at `state` with independent prior errors of the given standard deviations,
    /// whatever the filter was before. The inputs stay.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if lengths differ from the model's number of
    /// states or `integration` has no sub-step; [`EstimationError::NotPositiveDefinite`] if a
    /// sigma is not positive. The filter is unchanged then.
    pub fn start(
        &mut self,
        integration: Integration,
        recentring: Recentring<T>,
        state: &[T],
        sigma: &[T],
    ) -> Result<(), EstimationError> {
        let n = self.storage.states();
        if M + self.model.parameters() != n || state.len() != n || sigma.len() != n {
            return Err(EstimationError::InvalidArgument {
                expected: "as many states, sigmas and places in the storage as the model has",
            });
        }
        if integration.substeps() == 0 {
            return Err(EstimationError::InvalidArgument {
                expected: "at least one sub-step",
            });
        }
        for (j, sigma) in sigma.iter().enumerate() {
            if !(sigma.is_positive() && (*sigma * *sigma).is_finite()) {
                return Err(EstimationError::NotPositiveDefinite { state: j });
            }
        }
        let buffers = self.storage.buffers();
        buffers.state.copy_from_slice(state);
        buffers.remainder.fill(T::ZERO);
        // A model writes structural nonzeros only.
        buffers.stages.fill(T::from_f64(0.0));
        buffers.transition.fill(T::from_f64(0.0));
        buffers.output.fill(T::from_f64(0.0));
        F::start(
            &mut numbers!(buffers),
            sigma.iter().map(|sigma| *sigma * *sigma),
        );
        self.integration = integration;
        self.recentring = recentring;
        self.map = None;
        self.recentre_at_start()
    }

    /// The prior is given in the coordinates of the first chart; carries it to a chart at the
    /// first state where the policy wants one.
    fn recentre_at_start(&mut self) -> Result<(), EstimationError> {
        let buffers = self.storage.buffers();
        let mut moving = to_array(&buffers.state[..M]);
        if !self.recentring.wanted(&moving) {
            return Ok(());
        }
        let Some(map) = self.model.recentre(&mut moving, &mut self.inputs) else {
            return Ok(());
        };
        buffers.state[..M].copy_from_slice(&moving);
        F::recentre(&mut numbers!(buffers), &map)
    }

    /// True if the moving states are zero between calls.
    #[inline(always)]
    fn at_origin(&self) -> bool {
        self.recentring == Recentring::EveryStep && self.model.has_chart()
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
        let View { matrix, pivots, .. } = self.storage.view();
        F::element(matrix, pivots, M, i, j)
    }

    /// Standard deviation of the error of state `i`.
    ///
    /// # Panics
    /// If `i` is not the index of a state.
    #[must_use]
    pub fn sigma(&self, i: usize) -> T {
        self.covariance(i, i).sqrt()
    }

    /// Inputs of the model besides its state; they carry the chart.
    #[must_use]
    pub fn inputs(&self) -> &D::Inputs {
        &self.inputs
    }

    /// The inputs, to set values that are held over the next step.
    pub fn inputs_mut(&mut self) -> &mut D::Inputs {
        &mut self.inputs
    }

    /// Numbers that persist between steps: covariance or factors, last transition and gain.
    #[must_use]
    pub fn view(&self) -> View<'_, T> {
        self.storage.view()
    }

    /// Moving columns of the last transition, in the chart that its step began in.
    #[must_use]
    pub fn moving_transition(&self) -> &[[T; M]; M] {
        &self.moving_transition
    }

    /// Map of the moving states' errors by which the chart moved after the last step: it multiplies
    /// the moving rows of the transition from the left. `None` if the chart did not move.
    #[must_use]
    pub fn chart_map(&self) -> Option<&[[T; M]; M]> {
        self.map.as_ref()
    }
}

#[inline(always)]
fn to_array<T: Precision, const M: usize>(slice: &[T]) -> [T; M] {
    let mut array = [T::ZERO; M];
    array.copy_from_slice(slice);
    array
}
