//! Onsets in time: one begins with every block, and lives the longer the rarer its kind is.

use gyrocal_scalar::Real;

/// Slots of onsets, by the dyadic order of their number.
///
/// Onset j, counted from zero, has the order v of its trailing zero bits, at most `top`. It lives
/// 2^(v + 1) blocks. So there is one onset of each order below the top at any time, and two of the
/// top order: `top` + 2 slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Calendar {
    top: u32,
}

impl Calendar {
    /// For a number of slots, at least two.
    #[must_use]
    pub const fn of_slots(slots: usize) -> Self {
        Self {
            top: (slots as u32).saturating_sub(2),
        }
    }

    /// Order of an onset.
    #[inline]
    #[must_use]
    pub fn order(self, onset: u32) -> u32 {
        onset.trailing_zeros().min(self.top)
    }

    /// The slot that an onset takes, from one that has lived long enough.
    #[inline]
    #[must_use]
    pub fn slot(self, onset: u32) -> usize {
        let order = self.order(onset);
        let second = order == self.top && (onset >> self.top) & 1 == 1;
        order as usize + usize::from(second)
    }

    /// The weight of the onsets of a slot: their mean over all onsets is one.
    #[inline]
    #[must_use]
    pub fn weight<T: Real>(self, slot: usize) -> T {
        let doublings = (slot as u32 + 1).min(self.top).min(31);
        T::from_u32(1 << doublings) / T::from_u32(self.top + 1)
    }

    /// The latest onset in a slot when the last one was `latest`; `None` if there was none yet.
    #[inline]
    #[must_use]
    pub fn latest(self, slot: usize, latest: u32) -> Option<u32> {
        let slot = slot as u32;
        let (period, offset) = if slot < self.top {
            (2_u32 << slot, 1_u32 << slot)
        } else {
            (2_u32 << self.top, (slot - self.top) << self.top)
        };
        let since = latest.checked_sub(offset)?;
        Some(offset + since / period * period)
    }

    /// Blocks that the onsets of a slot live.
    #[must_use]
    pub fn life(self, slot: usize) -> u32 {
        2 << (slot as u32).min(self.top)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_onset_lives_until_its_slot_is_taken_again() {
        let calendar = Calendar::of_slots(5);
        let mut taken = [None; 5];
        let mut weights = 0.0;
        for onset in 0..64 {
            let slot = calendar.slot(onset);
            if let Some(before) = taken[slot].replace(onset) {
                assert_eq!(onset - before, calendar.life(slot), "slot {slot}");
            }
            weights += calendar.weight::<f64>(slot);
            for (slot, taken) in taken.iter().enumerate() {
                assert_eq!(calendar.latest(slot, onset), *taken, "slot {slot}");
            }
            // Onset zero is a top one that no eight onsets before it have paid for.
            let paid = calendar.weight::<f64>(4);
            assert!(weights <= f64::from(onset) + paid + 1e-9);
        }
        // The mean weight is one.
        assert!((weights - 64.0).abs() < 1e-9, "{weights}");
    }
}
