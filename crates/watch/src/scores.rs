use gyrocal_scalar::Real;

use crate::block::add_dot;
use crate::signatures::Direction;
use crate::step::Whitened;

/// Scores of `E` effects for `O` onsets: the sums of whitened innovations, weighted with the
/// signatures of [`crate::Signatures`].
#[derive(Clone, Debug)]
pub struct Scores<T, const N: usize, const D: usize, const E: usize, const O: usize> {
    unit: [[T; N]; 2],
    driven: [[T; D]; 2],
    live: bool,
    cells: [[T; E]; O],
}

impl<T: Real, const N: usize, const D: usize, const E: usize, const O: usize> Default
    for Scores<T, N, D, E, O>
{
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize, const D: usize, const E: usize, const O: usize>
    Scores<T, N, D, E, O>
{
    /// All zero.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            unit: [[T::ZERO; N]; 2],
            driven: [[T::ZERO; D]; 2],
            live: false,
            cells: [[T::ZERO; E]; O],
        }
    }

    /// All numbers, in the order of [`Self::numbers_mut`].
    pub(crate) fn numbers(&self) -> [&[T]; 3] {
        [
            self.unit.as_flattened(),
            self.driven.as_flattened(),
            self.cells.as_flattened(),
        ]
    }

    pub(crate) fn numbers_mut(&mut self) -> [&mut [T]; 3] {
        [
            self.unit.as_flattened_mut(),
            self.driven.as_flattened_mut(),
            self.cells.as_flattened_mut(),
        ]
    }

    /// True if the second of both is gathered.
    pub(crate) fn second(&mut self) -> &mut bool {
        &mut self.live
    }

    pub(crate) fn is_second(&self) -> bool {
        self.live
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        self.unit = [[T::ZERO; N]; 2];
        self.driven = [[T::ZERO; D]; 2];
        self.cells = [[T::ZERO; E]; O];
        self.live = false;
    }

    /// Adds a step with its whitened innovation.
    #[inline(always)]
    pub fn add<const Y: usize>(&mut self, whitened: &Whitened<T, Y, N, D>, innovation: &[T; Y]) {
        let [early, late] = &mut self.unit;
        let [early_driven, late_driven] = &mut self.driven;
        let (unit, driven) = if self.live {
            (late, late_driven)
        } else {
            (early, early_driven)
        };
        for k in 0..Y {
            for (sum, shown) in unit.iter_mut().zip(&whitened.unit[k]) {
                *sum = shown.mul_add(innovation[k], *sum);
            }
            for (sum, shown) in driven.iter_mut().zip(&whitened.driven[k]) {
                *sum = shown.mul_add(innovation[k], *sum);
            }
        }
    }

    /// Ends the block that is gathered.
    pub fn end_block(&mut self) {
        self.live = !self.live;
        let index = usize::from(self.live);
        if let Some(unit) = self.unit.get_mut(index) {
            *unit = [T::ZERO; N];
        }
        if let Some(driven) = self.driven.get_mut(index) {
            *driven = [T::ZERO; D];
        }
    }

    /// An onset begins anew in a slot.
    pub fn restart(&mut self, slot: usize) {
        if let Some(cells) = self.cells.get_mut(slot) {
            *cells = [T::ZERO; E];
        }
    }

    /// Takes a cell through the complete block; gives its score.
    #[inline(always)]
    pub fn update(&mut self, slot: usize, effect: usize, direction: &Direction<T, N>) -> T {
        let index = usize::from(!self.live);
        let (Some(unit), Some(driven)) = (self.unit.get(index), self.driven.get(index)) else {
            return T::ZERO;
        };
        let mut sum = add_dot(&direction.unit, unit, T::ZERO);
        for (column, size) in &direction.driven {
            if let Some(score) = driven.get(*column) {
                sum = size.mul_add(*score, sum);
            }
        }
        let cell = self
            .cells
            .get_mut(slot)
            .and_then(|cells| cells.get_mut(effect));
        let Some(cell) = cell else {
            return T::ZERO;
        };
        *cell = *cell + sum;
        *cell
    }

    /// S of a cell.
    #[inline(always)]
    #[must_use]
    pub fn score(&self, slot: usize, effect: usize) -> T {
        let cells = self.cells.get(slot);
        let score = cells.and_then(|cells| cells.get(effect));
        score.copied().unwrap_or(T::ZERO)
    }
}
