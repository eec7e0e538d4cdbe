//! The saved state of a watched filter: that of the filter, then that of its watch.
//!
//! | bytes | contents |
//! |---|---|
//! | `ControllerFilter::SAVED_BYTES` | the filter, see `src/saved.rs` |
//! | 4 | `GYRW` |
//! | 2 | version of this format |
//! | 1 | bytes of a number: 4 or 8 |
//! | 1 | columns of the watch |
//! | 4 | fingerprint of the effects: their ids in their order |
//! | 9 × 4 | counters |
//! | numbers | first values of courses, times of walks, state of the watch |
//! | 4 | CRC-32 (IEEE 802.3) of all from `GYRW` on |
//!
//! Integers and numbers are little-endian.

use gyrocal_watch::Counters;

use super::effects::WatchedEffect;
use crate::controller_error::ControllerError;
use crate::saved::{CHECKSUM, SavedNumber, copy, crc32, crc32_of, number_at};

const MAGIC: [u8; 4] = *b"GYRW";
const VERSION: u16 = 1;
/// Counters of the watch, and the turn of the walks.
const COUNTERS: usize = 9;
const HEAD: usize = 12;

/// Bytes of the saved state of a watch.
pub(super) const fn length(numbers: usize, number: usize) -> usize {
    HEAD + 4 * COUNTERS + numbers * number + CHECKSUM
}

/// The head: format, number type and effects.
fn head<T: SavedNumber>(effects: &[WatchedEffect], columns: usize) -> [[u8; 4]; 3] {
    let [low, high] = VERSION.to_le_bytes();
    let mut checksum = !0;
    for effect in effects {
        checksum = crc32_of(checksum, effect.id.as_bytes());
        checksum = crc32_of(checksum, b"\n");
    }
    [
        MAGIC,
        [low, high, T::BYTES as u8, columns as u8],
        (!checksum).to_le_bytes(),
    ]
}

/// Writes a watch; `each` puts its numbers one after the other.
pub(super) fn write<T: SavedNumber>(
    effects: &[WatchedEffect],
    columns: usize,
    counters: &Counters,
    turn: u32,
    each: impl FnOnce(&mut dyn FnMut(T)),
    place: &mut [u8],
) {
    let sealed = place.len().saturating_sub(CHECKSUM);
    let (state, seal) = place.split_at_mut_checked(sealed).unwrap_or_default();
    let (words, numbers) = state
        .split_at_mut_checked(HEAD + 4 * COUNTERS)
        .unwrap_or_default();
    let counters = counters.iter().chain(core::iter::once(&turn));
    let counters = counters.map(|counter| counter.to_le_bytes());
    let all = head::<T>(effects, columns).into_iter().chain(counters);
    for (bytes, place) in all.zip(words.chunks_exact_mut(4)) {
        copy(&bytes, place);
    }
    let mut places = numbers.chunks_exact_mut(T::BYTES);
    each(&mut |number: T| {
        if let Some(place) = places.next() {
            number.write(place);
        }
    });
    copy(&crc32(state).to_le_bytes(), seal);
}

/// A saved watch whose head, checksum and numbers are right.
pub(super) struct SavedWatch<'a> {
    pub(super) counters: Counters,
    pub(super) turn: u32,
    body: &'a [u8],
    next: usize,
}

impl<'a> SavedWatch<'a> {
    /// Checks a saved watch, whose length is right.
    pub(super) fn check<T: SavedNumber>(
        effects: &[WatchedEffect],
        columns: usize,
        numbers: usize,
        saved: &'a [u8],
    ) -> Result<Self, ControllerError> {
        let sealed = saved.len().saturating_sub(CHECKSUM);
        let (state, seal) = saved.split_at_checked(sealed).unwrap_or_default();
        let (words, body) = state
            .split_at_checked(HEAD + 4 * COUNTERS)
            .unwrap_or_default();
        let mut words = words.chunks_exact(4);
        let same = head::<T>(effects, columns)
            .iter()
            .all(|expected| words.next().is_some_and(|found| found == expected));
        if !same {
            return Err(ControllerError::SavedVersion);
        }
        if seal != crc32(state).to_le_bytes() {
            return Err(ControllerError::SavedChecksum);
        }
        let mut word = || {
            let bytes = words.next().and_then(|bytes| bytes.try_into().ok());
            u32::from_le_bytes(bytes.unwrap_or_default())
        };
        let mut counters = Counters::default();
        for counter in &mut counters {
            *counter = word();
        }
        let turn = word();
        for index in 0..numbers {
            if !number_at::<T>(body, index).is_some_and(|number| number.is_finite()) {
                return Err(ControllerError::SavedNumbers);
            }
        }
        Ok(Self {
            counters,
            turn,
            body,
            next: 0,
        })
    }

    /// The next number.
    pub(super) fn number<T: SavedNumber>(&mut self) -> T {
        let number = number_at(self.body, self.next);
        self.next += 1;
        number.unwrap_or(T::ZERO)
    }
}
