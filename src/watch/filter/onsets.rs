use gyrocal_watch::{Calendar, Candidate};

use super::{JUMPS, ONSETS, WatchedFilter};
use crate::saved::SavedNumber;

impl<T: SavedNumber, const E: usize, const D: usize> WatchedFilter<T, E, D> {
    /// Steps until the onset of a candidate is dropped, after which nothing speaks for the effect as this
    /// onset does: a set is to be asked for again before.
    #[must_use]
    pub fn steps_left(&self, candidate: &Candidate<T>) -> u32 {
        let test = self.settings.of_test([T::ZERO; 1]);
        let life = if candidate.effect < E {
            let blocks = Calendar::of_slots(ONSETS).life(candidate.slot);
            blocks.saturating_mul(test.block_steps)
        } else {
            (JUMPS as u32).saturating_mul(test.span_steps)
        };
        life.saturating_sub(candidate.steps_since)
    }
}
