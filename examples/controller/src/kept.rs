//! Memory that keeps its contents over a reset: two places, written in turn, so that a reset in the
//! middle of writing leaves the older state whole.

use gyrocal::{ControllerError, ControllerFilter};

const BYTES: usize = ControllerFilter::<f32>::SAVED_BYTES;

/// Two saved states.
pub(crate) struct Kept {
    places: [[u8; BYTES]; 2],
    newer: bool,
}

impl Kept {
    pub(crate) const fn new() -> Self {
        Self {
            places: [[0; BYTES]; 2],
            newer: false,
        }
    }

    /// Saves the state over the older one.
    pub(crate) fn save(&mut self, filter: &ControllerFilter) -> Result<(), ControllerError> {
        let [first, second] = &mut self.places;
        filter.save(if self.newer { first } else { second })?;
        self.newer = !self.newer;
        Ok(())
    }

    /// Restores the newer state, or the older one if that is damaged.
    pub(crate) fn restore(&self, filter: &mut ControllerFilter) -> Result<(), ControllerError> {
        let [first, second] = &self.places;
        let (newer, older) = if self.newer {
            (second, first)
        } else {
            (first, second)
        };
        filter.restore(newer).or_else(|_| filter.restore(older))
    }
}
