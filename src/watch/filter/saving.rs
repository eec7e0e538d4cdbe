use gyrocal_estimation::Factors;
use gyrocal_watch::Watch;

use super::{JUMPS, L, N, ONSETS, WatchedFilter};
use crate::controller::ControllerFilter;
use crate::controller_error::ControllerError;
use crate::saved::SavedNumber;
use crate::watch::saved::{self, SavedWatch};

impl<T: SavedNumber, const E: usize, const D: usize> WatchedFilter<T, E, D> {
    /// First values of courses, times of walks, and those of the watch.
    const NUMBERS: usize = E + 3 + Watch::<T, 3, 3, N, D, E, ONSETS, JUMPS, L>::NUMBERS;

    /// Bytes of a saved state of the filter alone: the first ones of a saved state.
    pub const FILTER_BYTES: usize = ControllerFilter::<T, Factors>::SAVED_BYTES;

    /// Bytes of a saved state.
    pub const SAVED_BYTES: usize = Self::FILTER_BYTES + saved::length(Self::NUMBERS, T::BYTES);

    /// Writes the state of the filter and of its watch to `place`, each with version and checksum.
    ///
    /// # Errors
    /// [`ControllerError::SavedLength`] unless `place` has [`Self::SAVED_BYTES`];
    /// [`ControllerError::NotRunning`].
    pub fn save(&self, place: &mut [u8]) -> Result<(), ControllerError> {
        let expected = Self::SAVED_BYTES;
        if place.len() != expected {
            return Err(ControllerError::SavedLength { expected });
        }
        let (of_filter, of_watch) = place
            .split_at_mut_checked(Self::FILTER_BYTES)
            .unwrap_or_default();
        self.filter.save(of_filter)?;
        saved::write(
            self.effects,
            D,
            &self.watch.counters(),
            self.next_walk,
            |put| {
                let own = self.early.iter().chain(&self.walked_s);
                own.for_each(|number| put(*number));
                self.watch.save(put);
            },
            of_watch,
        );
        Ok(())
    }

    /// Takes over a saved state. Filter and watch must have started with the settings of the ones that
    /// were saved; the steps that follow then have the same bits as without a reset. The onsets that
    /// have begun stay begun: the watch goes on with what is left of its probability of a false alarm.
    ///
    /// # Errors
    /// [`ControllerError::SavedLength`], [`ControllerError::SavedVersion`] (also for other effects),
    /// [`ControllerError::SavedChecksum`] or [`ControllerError::SavedNumbers`], and nothing has changed;
    /// [`ControllerError::NotRunning`] if it was never started.
    pub fn restore(&mut self, saved: &[u8]) -> Result<(), ControllerError> {
        if !self.watch.has_started() {
            return Err(ControllerError::NotRunning);
        }
        let expected = Self::SAVED_BYTES;
        let parts = saved.split_at_checked(Self::FILTER_BYTES);
        let parts = parts.filter(|_| saved.len() == expected);
        let Some((of_filter, of_watch)) = parts else {
            return Err(ControllerError::SavedLength { expected });
        };
        let mut state = SavedWatch::check::<T>(self.effects, D, Self::NUMBERS, of_watch)?;
        if !self.watch.can_stand_at(&state.counters) || state.turn >= super::WALK_TURNS {
            return Err(ControllerError::SavedNumbers);
        }
        self.filter.restore(of_filter)?;
        for place in self.early.iter_mut().chain(&mut self.walked_s) {
            *place = state.number();
        }
        self.next_walk = state.turn;
        let counters = state.counters;
        self.watch.restore(&counters, &mut || state.number());
        Ok(())
    }

    /// Takes over the state of the filter alone, the first [`Self::FILTER_BYTES`] of a saved state. The
    /// watch begins anew.
    ///
    /// # Errors
    /// As [`ControllerFilter::restore`].
    pub fn restore_filter(&mut self, saved: &[u8]) -> Result<(), ControllerError> {
        self.filter.restore(saved)?;
        self.go_on();
        Ok(())
    }
}
