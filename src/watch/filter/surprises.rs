use gyrocal_estimation::Innovation;
use gyrocal_watch::Grid;

use super::WatchedFilter;
use crate::controller_error::ControllerError;
use crate::saved::SavedNumber;

impl<T: SavedNumber, const E: usize, const D: usize> WatchedFilter<T, E, D> {
    /// The alarm of the last step, also of one whose sample was too surprising to be taken: the watch sees
    /// that sample, clipped as any.
    #[must_use]
    pub fn alarm(&self) -> Option<Grid> {
        self.alarm
    }

    /// Number of samples since the start that the filter has not taken because of their NIS.
    #[must_use]
    pub fn surprising_samples(&self) -> u32 {
        self.filter.surprising_samples()
    }

    /// Goes on after [`ControllerError::Diverged`], where no alarm has named a cause to adopt: as
    /// [`ControllerFilter::reopen`](crate::ControllerFilter::reopen), and the watch goes on with new onsets.
    ///
    /// # Errors
    /// The same.
    pub fn reopen(
        &mut self,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, ControllerError> {
        let innovation = self.filter.reopen(specific_force_g)?;
        self.go_on();
        Ok(innovation)
    }
}
