//! The grid of jumps of moving states: onsets that follow each other closely and live shortly.

use gyrocal_scalar::Real;

use crate::step::{Observed, Step};

/// A jump of each moving state from one onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JumpCell<T, const M: usize> {
    /// Deviation of the moving states for a unit of each jump.
    pub deviation: [[T; M]; M],
    /// Information on the size of each jump.
    pub information: [T; M],
}

/// Closed loop of the moving states over some steps, and information on their deviation at the
/// beginning.
#[derive(Clone, Copy, Debug)]
struct Span<T, const M: usize> {
    through: [[T; M]; M],
    information: [[T; M]; M],
}

impl<T: Real, const M: usize> Span<T, M> {
    const fn zero() -> Self {
        Self {
            through: [[T::ZERO; M]; M],
            information: [[T::ZERO; M]; M],
        }
    }

    fn begin(&mut self) {
        *self = Self::zero();
        for i in 0..M {
            self.through[i][i] = T::from_f64(1.0);
        }
    }
}

/// Signatures of jumps of the moving states, for `K` onsets.
///
/// A jump dies out within hours, in which parameters hardly follow it: their part is left out.
#[derive(Clone, Debug)]
pub struct Jumps<T, const M: usize, const K: usize> {
    spans: [Span<T, M>; 2],
    live: bool,
    cells: [JumpCell<T, M>; K],
}

impl<T: Real, const M: usize, const K: usize> Default for Jumps<T, M, K> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const M: usize, const K: usize> Jumps<T, M, K> {
    /// No onset.
    #[must_use]
    pub const fn new() -> Self {
        let cell = JumpCell {
            deviation: [[T::ZERO; M]; M],
            information: [T::ZERO; M],
        };
        Self {
            spans: [Span::zero(); 2],
            live: false,
            cells: [cell; K],
        }
    }

    /// Calls `put` with all numbers, in the order of [`Self::numbers_mut`].
    pub(crate) fn numbers(&self, put: &mut dyn FnMut(T)) {
        for span in &self.spans {
            let matrices = [&span.through, &span.information];
            let numbers = matrices.into_iter().flat_map(|rows| rows.as_flattened());
            numbers.for_each(|number| put(*number));
        }
        for cell in &self.cells {
            let deviations = cell.deviation.as_flattened();
            let numbers = deviations.iter().chain(&cell.information);
            numbers.for_each(|number| put(*number));
        }
    }

    /// Calls `each` with the place of every number.
    pub(crate) fn numbers_mut(&mut self, each: &mut dyn FnMut(&mut T)) {
        for span in &mut self.spans {
            let matrices = [&mut span.through, &mut span.information];
            let numbers = matrices
                .into_iter()
                .flat_map(|rows| rows.as_flattened_mut());
            numbers.for_each(&mut *each);
        }
        for cell in &mut self.cells {
            let deviations = cell.deviation.as_flattened_mut();
            let numbers = deviations.iter_mut().chain(&mut cell.information);
            numbers.for_each(&mut *each);
        }
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
        let [first, second] = &mut self.spans;
        first.begin();
        second.begin();
        self.live = false;
        for cell in &mut self.cells {
            cell.deviation = [[T::ZERO; M]; M];
            cell.information = [T::ZERO; M];
        }
    }

    /// Takes a step; gives the deviation of its whitened innovation for a unit of each moving state
    /// at the beginning of the span.
    #[inline(always)]
    pub fn advance<const Y: usize, const N: usize>(
        &mut self,
        step: &Step<'_, T, M, Y, N>,
    ) -> [[T; M]; Y] {
        let [first, second] = &mut self.spans;
        let span = if self.live { second } else { first };
        let mut predicted = [[T::ZERO; M]; M];
        for i in 0..M {
            for l in 0..M {
                for j in 0..M {
                    predicted[i][j] =
                        step.transition[i][l].mul_add(span.through[l][j], predicted[i][j]);
                }
            }
        }
        span.through = predicted;
        let mut shown = [[T::ZERO; M]; Y];
        let Some(Observed { output, gain, .. }) = step.observed else {
            return shown;
        };
        for k in 0..Y {
            for l in 0..M {
                for j in 0..M {
                    shown[k][j] = output[k][l].mul_add(predicted[l][j], shown[k][j]);
                }
            }
        }
        for i in 0..M {
            for j in 0..M {
                for k in 0..Y {
                    span.through[i][j] = span.through[i][j] - gain[k][i] * shown[k][j];
                    span.information[i][j] =
                        shown[k][i].mul_add(shown[k][j], span.information[i][j]);
                }
            }
        }
        shown
    }

    /// Ends the span that is gathered and begins the next.
    pub fn end_span(&mut self) {
        self.live = !self.live;
        let [first, second] = &mut self.spans;
        if self.live { second } else { first }.begin();
    }

    /// An onset begins anew in a slot.
    pub fn restart(&mut self, slot: usize) {
        if let Some(cell) = self.cells.get_mut(slot) {
            cell.deviation = [[T::ZERO; M]; M];
            for i in 0..M {
                cell.deviation[i][i] = T::from_f64(1.0);
            }
            cell.information = [T::ZERO; M];
        }
    }

    /// Takes the jumps of an onset through the complete span; `each` gets them as they were at its
    /// beginning.
    #[inline(always)]
    pub fn update(&mut self, slot: usize, mut each: impl FnMut(usize, &[T; M])) {
        let [first, second] = &self.spans;
        let span = if self.live { first } else { second };
        let Some(cell) = self.cells.get_mut(slot) else {
            return;
        };
        for jump in 0..M {
            let before = cell.deviation[jump];
            each(jump, &before);
            let mut after = [T::ZERO; M];
            let mut information = cell.information[jump];
            for i in 0..M {
                let mut seen = T::ZERO;
                for j in 0..M {
                    after[i] = span.through[i][j].mul_add(before[j], after[i]);
                    seen = span.information[i][j].mul_add(before[j], seen);
                }
                information = seen.mul_add(before[i], information);
            }
            cell.deviation[jump] = after;
            cell.information[jump] = information;
        }
    }

    /// The jumps of an onset.
    #[must_use]
    pub fn cell(&self, slot: usize) -> Option<&JumpCell<T, M>> {
        self.cells.get(slot)
    }
}

/// Scores of jumps, beside [`Jumps`].
#[derive(Clone, Debug)]
pub struct JumpScores<T, const M: usize, const K: usize> {
    spans: [[T; M]; 2],
    live: bool,
    cells: [[T; M]; K],
}

impl<T: Real, const M: usize, const K: usize> Default for JumpScores<T, M, K> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const M: usize, const K: usize> JumpScores<T, M, K> {
    /// All zero.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            spans: [[T::ZERO; M]; 2],
            live: false,
            cells: [[T::ZERO; M]; K],
        }
    }

    /// All numbers, in the order of [`Self::numbers_mut`].
    pub(crate) fn numbers(&self) -> [&[T]; 2] {
        [self.spans.as_flattened(), self.cells.as_flattened()]
    }

    pub(crate) fn numbers_mut(&mut self) -> [&mut [T]; 2] {
        [self.spans.as_flattened_mut(), self.cells.as_flattened_mut()]
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
        self.spans = [[T::ZERO; M]; 2];
        self.live = false;
        self.cells = [[T::ZERO; M]; K];
    }

    /// Adds a step with its whitened innovation.
    #[inline(always)]
    pub fn add<const Y: usize>(&mut self, shown: &[[T; M]; Y], innovation: &[T; Y]) {
        let [first, second] = &mut self.spans;
        let sums = if self.live { second } else { first };
        for k in 0..Y {
            for j in 0..M {
                sums[j] = shown[k][j].mul_add(innovation[k], sums[j]);
            }
        }
    }

    /// Ends the span that is gathered.
    pub fn end_span(&mut self) {
        self.live = !self.live;
        let [first, second] = &mut self.spans;
        *if self.live { second } else { first } = [T::ZERO; M];
    }

    /// An onset begins anew in a slot.
    pub fn restart(&mut self, slot: usize) {
        if let Some(cell) = self.cells.get_mut(slot) {
            *cell = [T::ZERO; M];
        }
    }

    /// Takes a jump of an onset through the complete span, `deviation` being that at its beginning.
    #[inline(always)]
    pub fn update(&mut self, slot: usize, jump: usize, deviation: &[T; M]) {
        let [first, second] = &self.spans;
        let sums = if self.live { first } else { second };
        let mut sum = T::ZERO;
        for j in 0..M {
            sum = sums[j].mul_add(deviation[j], sum);
        }
        let cell = self.cells.get_mut(slot).and_then(|cell| cell.get_mut(jump));
        if let Some(cell) = cell {
            *cell = *cell + sum;
        }
    }

    /// Scores of the jumps of an onset.
    #[must_use]
    pub fn scores(&self, slot: usize) -> [T; M] {
        self.cells.get(slot).copied().unwrap_or([T::ZERO; M])
    }
}
