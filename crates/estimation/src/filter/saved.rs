use gyrocal_scalar::Recentre;

use super::Filter;
use crate::error::EstimationError;
use crate::form::{Form, Numbers};
use crate::precision::Precision;
use crate::storage::{Storage, View};

impl<T, D, S, const M: usize, const Y: usize, F> Filter<T, D, D::Inputs, S, M, Y, F>
where
    T: Precision,
    D: Recentre<T, M, Y>,
    S: Storage<T>,
    F: Form<T>,
{
    /// The numbers that the next steps depend on, one after the other: n of the state, n that must
    /// be positive, n (n - 1) / 2 more of the covariance, and n that rounding left of the state. The inputs, which carry the chart, are
    /// not among them.
    pub fn save(&self, mut put: impl FnMut(T)) {
        let View {
            state,
            remainder,
            matrix,
            pivots,
            ..
        } = self.storage.view();
        state.iter().for_each(|number| put(*number));
        F::save(matrix, pivots, &mut put);
        remainder.iter().for_each(|number| put(*number));
    }

    /// Takes numbers of [`Self::save`] back, in a filter that has started: `number` gives the one at an index. Steps from there
    /// have the bits that they would have had in the filter that was saved, if the inputs are the
    /// same.
    ///
    /// # Errors
    /// [`EstimationError::NotFinite`] and [`EstimationError::NotPositiveDefinite`], and the filter
    /// is unchanged.
    pub fn restore(&mut self, number: impl Fn(usize) -> Option<T>) -> Result<(), EstimationError> {
        let n = self.storage.states();
        for index in 0..3 * n + n * n.saturating_sub(1) / 2 {
            let value = number(index).filter(|value| value.is_finite());
            let Some(value) = value else {
                return Err(EstimationError::NotFinite {
                    quantity: "a restored number",
                });
            };
            if (n..2 * n).contains(&index) && !value.is_positive() {
                return Err(EstimationError::NotPositiveDefinite { state: index - n });
            }
        }
        let mut index = 0;
        let mut next = || {
            index += 1;
            number(index - 1)
        };
        let buffers = self.storage.buffers();
        for place in buffers.state.iter_mut() {
            *place = next().unwrap_or(*place);
        }
        F::restore(&mut numbers!(buffers), &mut next);
        for place in buffers.remainder.iter_mut() {
            *place = next().unwrap_or(*place);
        }
        self.map = None;
        Ok(())
    }
}
