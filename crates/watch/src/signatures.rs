use gyrocal_scalar::Real;

use crate::block::Block;
use crate::step::{Step, Whitened};
use crate::table::{Course, Driven, Entry, Value};

/// An effect from an onset: the deviation that a unit of it has left in the filter, and the
/// information on its size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell<T, const N: usize> {
    /// δ: state minus estimate, per unit of the effect.
    pub deviation: [T; N],
    /// I: inverse variance of an estimate of its size.
    pub information: T,
}

/// Coefficients v of the columns of a block that make up an effect from an onset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction<T, const N: usize> {
    /// Of the unit columns.
    pub unit: [T; N],
    /// Of driven columns, with their indices.
    pub driven: [(usize, T); 2],
}

/// Signatures of `E` effects for `O` onsets, in blocks of steps.
///
/// A block is gathered while the cells are taken through the one before it, cell by cell, so that no
/// step has much to do.
#[derive(Clone, Debug)]
pub struct Signatures<
    T,
    const N: usize,
    const D: usize,
    const E: usize,
    const O: usize,
    const L: usize,
> {
    columns: [Driven; D],
    entries: [Entry; E],
    blocks: [Block<T, N, D, L>; 2],
    courses: [[Course<T>; E]; 2],
    /// The block that is gathered; the other one is complete.
    live: bool,
    cells: [[Cell<T, N>; E]; O],
}

impl<T: Real, const N: usize, const D: usize, const E: usize, const O: usize, const L: usize>
    Signatures<T, N, D, E, O, L>
{
    /// Nothing gathered, and no onset.
    #[must_use]
    pub const fn new(columns: [Driven; D], entries: [Entry; E]) -> Self {
        let course = Course {
            start: T::ZERO,
            change: T::ZERO,
        };
        let cell = Cell {
            deviation: [T::ZERO; N],
            information: T::ZERO,
        };
        Self {
            columns,
            entries,
            blocks: [Block::new(); 2],
            courses: [[course; E]; 2],
            live: false,
            cells: [[cell; E]; O],
        }
    }

    /// Calls `put` with all numbers, in the order of [`Self::numbers_mut`].
    pub(crate) fn numbers(&self, put: &mut dyn FnMut(T)) {
        for slice in self.blocks.iter().flat_map(Block::numbers) {
            slice.iter().for_each(|number| put(*number));
        }
        for course in self.courses.as_flattened() {
            put(course.start);
            put(course.change);
        }
        for cell in self.cells.as_flattened() {
            cell.deviation.iter().for_each(|number| put(*number));
            put(cell.information);
        }
    }

    /// Calls `each` with the place of every number.
    pub(crate) fn numbers_mut(&mut self, each: &mut dyn FnMut(&mut T)) {
        for slice in self.blocks.iter_mut().flat_map(Block::numbers_mut) {
            slice.iter_mut().for_each(&mut *each);
        }
        for course in self.courses.as_flattened_mut() {
            each(&mut course.start);
            each(&mut course.change);
        }
        for cell in self.cells.as_flattened_mut() {
            cell.deviation.iter_mut().for_each(&mut *each);
            each(&mut cell.information);
        }
    }

    /// True if the second of both blocks is gathered.
    pub(crate) fn second(&mut self) -> &mut bool {
        &mut self.live
    }

    pub(crate) fn is_second(&self) -> bool {
        self.live
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        for slot in 0..O {
            self.restart(slot);
        }
        let [first, second] = &mut self.blocks;
        first.begin();
        second.begin();
        self.live = false;
    }

    #[inline(always)]
    fn gathered(&mut self) -> (&mut Block<T, N, D, L>, &mut [Course<T>; E]) {
        let [first, second] = &mut self.blocks;
        let [early, late] = &mut self.courses;
        if self.live {
            (second, late)
        } else {
            (first, early)
        }
    }

    #[inline(always)]
    fn complete(&self) -> (&Block<T, N, D, L>, &[Course<T>; E]) {
        let [first, second] = &self.blocks;
        let [early, late] = &self.courses;
        if self.live {
            (first, early)
        } else {
            (second, late)
        }
    }

    /// Takes a step of the filter into the block that is gathered; gives the deviations of its
    /// whitened innovation.
    #[inline(always)]
    pub fn advance<const M: usize, const Y: usize>(
        &mut self,
        step: &Step<'_, T, M, Y, N>,
    ) -> Whitened<T, Y, N, D> {
        let columns = self.columns;
        self.gathered().0.advance(step, &columns)
    }

    /// Ends the block that is gathered and begins the next one, with the courses of the effects
    /// over it.
    pub fn end_block(&mut self, next: &[Course<T>; E]) {
        self.live = !self.live;
        let (block, courses) = self.gathered();
        block.begin();
        *courses = *next;
    }

    /// Sets the courses over the block that is gathered, before its first step.
    pub fn begin(&mut self, courses: &[Course<T>; E]) {
        let (block, place) = self.gathered();
        block.begin();
        *place = *courses;
    }

    /// An onset begins anew in a slot.
    pub fn restart(&mut self, slot: usize) {
        if let Some(cells) = self.cells.get_mut(slot) {
            for cell in cells {
                cell.deviation = [T::ZERO; N];
                cell.information = T::ZERO;
            }
        }
    }

    /// The direction in the complete block of the effect `effect` from the onset in `slot`, which
    /// is `age` blocks old at its beginning.
    #[inline(always)]
    #[must_use]
    pub fn direction(&self, slot: usize, effect: usize, age: u32) -> Option<Direction<T, N>> {
        let cell = self.cell(slot, effect)?;
        let course = self.complete().1.get(effect)?;
        self.directed(effect, &cell.deviation, course, age)
    }

    #[inline(always)]
    fn directed(
        &self,
        effect: usize,
        deviation: &[T; N],
        course: &Course<T>,
        age: u32,
    ) -> Option<Direction<T, N>> {
        let entry = self.entries.get(effect)?;
        let (start, change) = entry.course(course, age);
        let mut unit = *deviation;
        let mut driven = [(D, T::ZERO), (entry.slope, change)];
        match entry.value {
            Value::State(state) => {
                let place = unit.get_mut(state)?;
                *place = *place + start;
            }
            Value::Driven(column) => driven[0] = (column, start),
        }
        Some(Direction { unit, driven })
    }

    /// Takes a cell through the complete block.
    #[inline(always)]
    pub fn update(&mut self, slot: usize, effect: usize, age: u32, direction: &Direction<T, N>) {
        let (block, courses) = self.complete();
        let information = block.information(&direction.unit, &direction.driven);
        let mut deviation = block.carry(&direction.unit, &direction.driven);
        if let (Some(entry), Some(course)) = (self.entries.get(effect), courses.get(effect)) {
            entry.take_back(&mut deviation, course, age, block.passed);
        }
        if let Some(cell) = self
            .cells
            .get_mut(slot)
            .and_then(|cells| cells.get_mut(effect))
        {
            cell.deviation = deviation;
            cell.information = cell.information + information;
        }
    }

    /// A cell, as the last complete block that it was taken through left it.
    #[inline(always)]
    #[must_use]
    pub fn cell(&self, slot: usize, effect: usize) -> Option<&Cell<T, N>> {
        self.cells.get(slot)?.get(effect)
    }

    /// The deviation of a cell now, `age` being that of its onset at the beginning of the block
    /// that is gathered.
    #[must_use]
    pub fn deviation_now(&self, slot: usize, effect: usize, age: u32) -> Option<[T; N]> {
        let cell = self.cell(slot, effect)?;
        let index = usize::from(self.live);
        let (block, courses) = (self.blocks.get(index)?, self.courses.get(index)?);
        let course = courses.get(effect)?;
        let direction = self.directed(effect, &cell.deviation, course, age)?;
        let mut deviation = block.carry(&direction.unit, &direction.driven);
        let entry = self.entries.get(effect)?;
        entry.take_back(&mut deviation, course, age, block.passed);
        Some(deviation)
    }
}

impl Entry {
    #[inline(always)]
    fn course<T: Real>(&self, course: &Course<T>, age: u32) -> (T, T) {
        if self.from_onset {
            (T::from_u32(age) * course.change, course.change)
        } else {
            (course.start, course.change)
        }
    }

    /// The parameter of the filter has not changed: the effect only enters as it would. The next
    /// block begins with the value of its own.
    #[inline(always)]
    fn take_back<T: Real, const N: usize>(
        &self,
        deviation: &mut [T; N],
        course: &Course<T>,
        age: u32,
        passed: T,
    ) {
        let (start, change) = self.course(course, age);
        if let Value::State(state) = self.value
            && let Some(place) = deviation.get_mut(state)
        {
            *place = *place - change.mul_add(passed, start);
        }
    }
}
