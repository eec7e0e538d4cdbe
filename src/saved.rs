//! The saved state of a filter: bytes that survive a reset.
//!
//! | bytes | contents |
//! |---|---|
//! | 4 | `GYRC` |
//! | 2 | version of this format |
//! | 1 | bytes of a number: 4 or 8 |
//! | 1 | form of the covariance: 0 for P, 1 for its factors |
//! | 4 | fingerprint of the model: names and order of its parameters |
//! | 4 | turns of the chart |
//! | 12 numbers | North and Up along the axes of the chart, and what rounding left of them |
//! | 102 numbers | state, covariance and what rounding left, as `Filter::save` gives them |
//! | 4 | CRC-32 (IEEE 802.3) of all before |
//!
//! Integers and numbers are little-endian.

use gyrocal_estimation::form::Form;
use gyrocal_estimation::{Covariance, Factors, Precision};

use crate::controller_error::ControllerError;
use crate::filter::PlatformFilter;
use crate::generated::platform::{DRIFT, Platform};
use crate::rotation::dot;

const MAGIC: [u8; 4] = *b"GYRC";
const VERSION: u16 = 1;
const NUMBERS: usize = 3 * Platform::STATES + Platform::STATES * (Platform::STATES - 1) / 2;
const HEAD: usize = 16;
const CHART: usize = 12;
pub(crate) const CHECKSUM: usize = 4;

/// Bytes of a saved state of numbers of `number` bytes.
pub(crate) const fn length(number: usize) -> usize {
    HEAD + (CHART + NUMBERS) * number + CHECKSUM
}

/// A form of the covariance that a saved state can hold.
pub trait SavedForm {
    /// Its code in a saved state.
    const CODE: u8;
}

impl SavedForm for Covariance {
    const CODE: u8 = 0;
}

impl SavedForm for Factors {
    const CODE: u8 = 1;
}

/// A number type that a saved state can hold.
pub trait SavedNumber: Precision {
    /// Bytes of a number.
    const BYTES: usize;
    /// Writes the number to the first [`Self::BYTES`] bytes of `place`.
    fn write(self, place: &mut [u8]);
    /// Reads a number from [`Self::BYTES`] bytes; `None` if there are not as many.
    #[must_use]
    fn read(bytes: &[u8]) -> Option<Self>;
}

macro_rules! impl_saved_number {
    ($($float:ident),*) => {$(
        impl SavedNumber for $float {
            const BYTES: usize = size_of::<$float>();
            #[inline]
            fn write(self, place: &mut [u8]) {
                copy(&self.to_le_bytes(), place);
            }
            #[inline]
            fn read(bytes: &[u8]) -> Option<Self> {
                bytes.try_into().ok().map(Self::from_le_bytes)
            }
        }
    )*};
}
impl_saved_number!(f32, f64);

/// Writes the state of `filter` to `place`, whose length must be that of a saved state.
pub(crate) fn save<T: SavedNumber, F: Form<T> + SavedForm>(
    filter: &PlatformFilter<T, F>,
    place: &mut [u8],
) -> Result<(), ControllerError> {
    let expected = length(T::BYTES);
    if place.len() != expected {
        return Err(ControllerError::SavedLength { expected });
    }
    let kernel = filter.kernel();
    let (head, body) = place.split_at_mut_checked(HEAD).unwrap_or_default();
    let (chart, turns) = kernel.inputs().saved();
    for (bytes, place) in header::<T, F>(turns).iter().zip(head.chunks_exact_mut(4)) {
        copy(bytes, place);
    }
    let mut places = body.chunks_exact_mut(T::BYTES);
    let mut put = |number: T| {
        if let Some(place) = places.next() {
            number.write(place);
        }
    };
    chart.as_flattened().iter().for_each(|number| put(*number));
    kernel.save(put);
    let (sealed, seal) = place
        .split_at_mut_checked(expected - CHECKSUM)
        .unwrap_or_default();
    copy(&crc32(sealed).to_le_bytes(), seal);
    Ok(())
}

/// Restores the state of a filter that has started; nothing changes unless all of it is right.
pub(crate) fn restore<T: SavedNumber, F: Form<T> + SavedForm>(
    filter: &mut PlatformFilter<T, F>,
    saved: &[u8],
) -> Result<(), ControllerError> {
    let expected = length(T::BYTES);
    let sealed = saved.split_at_checked(expected - CHECKSUM);
    let Some((sealed, seal)) = sealed.filter(|(_, seal)| seal.len() == CHECKSUM) else {
        return Err(ControllerError::SavedLength { expected });
    };
    let (head, body) = sealed.split_at_checked(HEAD).unwrap_or_default();
    // What the head says of format, model and numbers; of another version nothing else is known.
    let same = header::<T, F>(0)
        .iter()
        .zip(head.chunks_exact(4))
        .take(3)
        .all(|(expected, found)| found == expected);
    if !same {
        return Err(ControllerError::SavedVersion);
    }
    if seal != crc32(sealed).to_le_bytes() {
        return Err(ControllerError::SavedChecksum);
    }
    let number = |index: usize| number_at::<T>(body, index);
    let mut chart = [[T::ZERO; 3]; 4];
    for (index, place) in chart.as_flattened_mut().iter_mut().enumerate() {
        *place = number(index).unwrap_or(T::ZERO);
    }
    if !is_rotation(&chart) {
        return Err(ControllerError::SavedNumbers);
    }
    let turns = head
        .chunks_exact(4)
        .nth(3)
        .and_then(|bytes| bytes.try_into().ok());
    let kernel = filter.kernel_mut();
    kernel
        .restore(|index| number(CHART + index))
        .map_err(|_| ControllerError::SavedNumbers)?;
    kernel
        .inputs_mut()
        .restore(chart, u32::from_le_bytes(turns.unwrap_or_default()));
    Ok(())
}

/// The number at an index; out of line, as a state is read number by number at several places.
#[inline(never)]
pub(crate) fn number_at<T: SavedNumber>(body: &[u8], index: usize) -> Option<T> {
    body.chunks_exact(T::BYTES).nth(index).and_then(T::read)
}

/// North and Up are orthogonal unit vectors to a thousand roundings, more than a filter leaves, and
/// what rounding left of them is as small.
fn is_rotation<T: Precision>([north, up, north_low, up_low]: &[[T; 3]; 4]) -> bool {
    let most = T::from_f64(1e3) * T::epsilon();
    let off = [
        dot(north, north) - T::from_f64(1.0),
        dot(up, up) - T::from_f64(1.0),
        dot(north, up),
    ];
    let mut all = off.iter().chain(north_low).chain(up_low);
    all.all(|off| off.abs() < most)
}

fn header<T: SavedNumber, F: SavedForm>(turns: u32) -> [[u8; 4]; 4] {
    let [low, high] = VERSION.to_le_bytes();
    [
        MAGIC,
        [low, high, T::BYTES as u8, F::CODE],
        MODEL.to_le_bytes(),
        turns.to_le_bytes(),
    ]
}

/// Fingerprint of the state: ids of the parameters in their order.
const MODEL: u32 = {
    let mut checksum = !0;
    let mut i = 0;
    while i < DRIFT.len() {
        checksum = crc32_of(checksum, DRIFT[i].id.as_bytes());
        checksum = crc32_of(checksum, b"\n");
        i += 1;
    }
    !checksum
};

#[inline(always)]
pub(crate) fn copy(from: &[u8], to: &mut [u8]) {
    for (place, byte) in to.iter_mut().zip(from) {
        *place = *byte;
    }
}

pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    !crc32_of(!0, bytes)
}

/// CRC-32 of IEEE 802.3, bit by bit: a table would take a kilobyte.
pub(crate) const fn crc32_of(mut checksum: u32, bytes: &[u8]) -> u32 {
    let mut rest = bytes;
    while let Some((byte, tail)) = rest.split_first() {
        checksum ^= *byte as u32;
        let mut bit = 0;
        while bit < 8 {
            let mask = (checksum & 1).wrapping_neg();
            checksum = (checksum >> 1) ^ (0xedb8_8320 & mask);
            bit += 1;
        }
        rest = tail;
    }
    checksum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_standard() {
        // The check value of the catalogue of CRC algorithms (reveng.sourceforge.io).
        assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
    }
}
