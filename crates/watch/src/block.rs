use gyrocal_scalar::Real;

use crate::step::{Observed, Step, Whitened};
use crate::table::Driven;

/// Columns that go through a step together: as many numbers of each row as registers hold.
const TILE: usize = 6;

/// Columns X and their Gram matrix M over the steps of a block. `L` = N (N + 1) / 2.
///
/// Row i of X has the deviations of state i, so that neighbouring numbers go through the same
/// operations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<T, const N: usize, const D: usize, const L: usize> {
    /// Deviations of the states now for a unit of each state at the beginning.
    pub(crate) unit: [[T; N]; N],
    /// The same for the driven columns, which begin at zero.
    pub(crate) driven: [[T; D]; N],
    /// Gram matrix of the unit columns, below and on its diagonal, by rows.
    pub(crate) gram: [T; L],
    /// Of driven columns with unit columns.
    pub(crate) mixed: [[T; N]; D],
    /// Of driven columns, below and on the diagonal.
    pub(crate) among: [[T; D]; D],
    /// Part of the block that has passed.
    pub(crate) passed: T,
}

impl<T: Real, const N: usize, const D: usize, const L: usize> Block<T, N, D, L> {
    pub(crate) const fn new() -> Self {
        const { assert!(L == N * (N + 1) / 2, "L = N (N + 1) / 2") };
        Self {
            unit: [[T::ZERO; N]; N],
            driven: [[T::ZERO; D]; N],
            gram: [T::ZERO; L],
            mixed: [[T::ZERO; N]; D],
            among: [[T::ZERO; D]; D],
            passed: T::ZERO,
        }
    }

    /// All numbers, in the order of [`Self::numbers_mut`].
    pub(crate) fn numbers(&self) -> [&[T]; 6] {
        [
            self.unit.as_flattened(),
            self.driven.as_flattened(),
            &self.gram,
            self.mixed.as_flattened(),
            self.among.as_flattened(),
            core::slice::from_ref(&self.passed),
        ]
    }

    pub(crate) fn numbers_mut(&mut self) -> [&mut [T]; 6] {
        [
            self.unit.as_flattened_mut(),
            self.driven.as_flattened_mut(),
            &mut self.gram,
            self.mixed.as_flattened_mut(),
            self.among.as_flattened_mut(),
            core::slice::from_mut(&mut self.passed),
        ]
    }

    #[inline]
    pub(crate) fn begin(&mut self) {
        for (j, row) in self.unit.iter_mut().enumerate() {
            *row = [T::ZERO; N];
            row[j] = T::from_f64(1.0);
        }
        self.driven = [[T::ZERO; D]; N];
        self.gram = [T::ZERO; L];
        self.mixed = [[T::ZERO; N]; D];
        self.among = [[T::ZERO; D]; D];
        self.passed = T::ZERO;
    }

    /// Carries all columns through a step of the filter.
    #[inline(always)]
    pub(crate) fn advance<const M: usize, const Y: usize>(
        &mut self,
        step: &Step<'_, T, M, Y, N>,
        table: &[Driven; D],
    ) -> Whitened<T, Y, N, D> {
        let mut whitened = Whitened {
            unit: [[T::ZERO; N]; Y],
            driven: [[T::ZERO; D]; Y],
        };
        let passed = self.passed + step.part;
        if let Some(observed) = step.observed {
            for (column, driven) in table.iter().enumerate() {
                let (output, size) = match *driven {
                    Driven::Slope(_) => continue,
                    Driven::Output(output) => (output, T::from_f64(1.0)),
                    Driven::OutputSlope(output) => (output, passed),
                };
                for k in 0..Y {
                    let element = observed.whitening[k].get(output).copied();
                    whitened.driven[k][column] = size * element.unwrap_or(T::ZERO);
                }
            }
        }
        columns(&mut self.unit, step, &mut whitened.unit);
        // A parameter that rises has its mean over the step.
        let half = T::from_f64(0.5) * step.part;
        self.raise(table, half);
        columns(&mut self.driven, step, &mut whitened.driven);
        self.raise(table, half);
        self.passed = passed;
        if step.observed.is_some() {
            self.add(&whitened);
        }
        whitened
    }

    #[inline(always)]
    fn raise(&mut self, table: &[Driven; D], by: T) {
        for (column, driven) in table.iter().enumerate() {
            if let Driven::Slope(state) = driven
                && let Some(row) = self.driven.get_mut(*state)
            {
                row[column] = row[column] + by;
            }
        }
    }

    /// Adds a step to the Gram matrix.
    #[inline(always)]
    fn add<const Y: usize>(&mut self, whitened: &Whitened<T, Y, N, D>) {
        let mut rest = self.gram.as_mut_slice();
        for i in 0..N {
            let Some((row, after)) = rest.split_at_mut_checked(i + 1) else {
                return;
            };
            let own = column(&whitened.unit, i);
            add_products(row, &own, &whitened.unit);
            rest = after;
        }
        for d in 0..D {
            let own = column(&whitened.driven, d);
            add_products(&mut self.mixed[d], &own, &whitened.unit);
            let (row, _) = self.among[d]
                .split_at_mut_checked(d + 1)
                .unwrap_or_default();
            add_products(row, &own, &whitened.driven);
        }
    }

    /// δ at the end of what has passed, of a deviation and driven columns with their coefficients.
    #[inline(always)]
    pub(crate) fn carry(&self, unit: &[T; N], driven: &[(usize, T); 2]) -> [T; N] {
        let mut sums = [T::ZERO; N];
        for ((sum, row), beside) in sums.iter_mut().zip(&self.unit).zip(&self.driven) {
            let mut total = T::ZERO;
            for (element, v) in row.iter().zip(unit) {
                total = element.mul_add(*v, total);
            }
            for (index, size) in driven {
                if let Some(element) = beside.get(*index) {
                    total = element.mul_add(*size, total);
                }
            }
            *sum = total;
        }
        sums
    }

    /// vᵀ M v.
    #[inline(always)]
    pub(crate) fn information(&self, unit: &[T; N], driven: &[(usize, T); 2]) -> T {
        let two = T::from_f64(2.0);
        let mut total = T::ZERO;
        let mut rest = self.gram.as_slice();
        for (i, v) in unit.iter().enumerate() {
            let Some((row, after)) = rest.split_at_checked(i) else {
                return total;
            };
            let Some((own, after)) = after.split_first() else {
                return total;
            };
            let mut beside = T::ZERO;
            for (element, other) in row.iter().zip(unit) {
                beside = element.mul_add(*other, beside);
            }
            total = v.mul_add(two.mul_add(beside, *own * *v), total);
            rest = after;
        }
        for (place, (index, size)) in driven.iter().enumerate() {
            let (Some(mixed), Some(among)) = (self.mixed.get(*index), self.among.get(*index))
            else {
                continue;
            };
            let mut sum = T::ZERO;
            for j in 0..N {
                sum = mixed[j].mul_add(unit[j], sum);
            }
            let own = among.get(*index).copied().unwrap_or(T::ZERO) * *size;
            total = size.mul_add(two.mul_add(sum, own), total);
            for (other, other_size) in driven.iter().take(place) {
                let (low, high) = (*index.min(other), *index.max(other));
                let row = self.among.get(high).and_then(|row| row.get(low));
                let element = row.copied().unwrap_or(T::ZERO);
                total = (two * *size * *other_size).mul_add(element, total);
            }
        }
        total
    }
}

#[inline(always)]
fn column<T: Real, const Y: usize, const C: usize>(rows: &[[T; C]; Y], at: usize) -> [T; Y] {
    let mut own = [T::ZERO; Y];
    for k in 0..Y {
        own[k] = rows[k][at];
    }
    own
}

/// Adds the products of a column with the columns of `rows` to `sums`, each of which is read and
/// written once.
#[inline(always)]
fn add_products<T: Real, const Y: usize, const C: usize>(
    sums: &mut [T],
    own: &[T; Y],
    rows: &[[T; C]; Y],
) {
    for (j, sum) in sums.iter_mut().enumerate().take(C) {
        let mut total = *sum;
        for k in 0..Y {
            total = rows[k][j].mul_add(own[k], total);
        }
        *sum = total;
    }
}

/// Carries columns through a step. `shown` has the part of their whitened innovations that does not
/// come from the state, and receives all of them.
#[inline(always)]
fn columns<T: Real, const M: usize, const Y: usize, const N: usize, const C: usize>(
    rows: &mut [[T; C]; N],
    step: &Step<'_, T, M, Y, N>,
    shown: &mut [[T; C]; Y],
) {
    let mut at = 0;
    while at + TILE <= C {
        tile::<T, M, Y, N, C, TILE>(rows, step, shown, at);
        at += TILE;
    }
    while at < C {
        tile::<T, M, Y, N, C, 1>(rows, step, shown, at);
        at += 1;
    }
}

#[inline(always)]
fn tile<T: Real, const M: usize, const Y: usize, const N: usize, const C: usize, const W: usize>(
    rows: &mut [[T; C]; N],
    step: &Step<'_, T, M, Y, N>,
    shown: &mut [[T; C]; Y],
    at: usize,
) {
    let mut moving = [[T::ZERO; W]; M];
    for (j, row) in rows.iter().enumerate() {
        let values: [T; W] = load(row, at);
        for i in 0..M {
            multiply_add(&mut moving[i], &values, step.transition[i][j]);
        }
    }
    let Some(Observed { output, gain, .. }) = step.observed else {
        for (row, values) in rows.iter_mut().zip(&moving) {
            store(row, at, values);
        }
        return;
    };
    let mut seen = [[T::ZERO; W]; Y];
    for k in 0..Y {
        seen[k] = load(&shown[k], at);
        for i in 0..M {
            multiply_add(&mut seen[k], &moving[i], output[k][i]);
        }
        store(&mut shown[k], at, &seen[k]);
    }
    for (j, row) in rows.iter_mut().enumerate() {
        let mut values = match moving.get(j) {
            Some(values) => *values,
            None => load(row, at),
        };
        for k in 0..Y {
            multiply_add(&mut values, &seen[k], -gain[k][j]);
        }
        store(row, at, &values);
    }
}

#[inline(always)]
fn load<T: Real, const C: usize, const W: usize>(row: &[T; C], at: usize) -> [T; W] {
    match row.get(at..at + W).and_then(|part| part.first_chunk::<W>()) {
        Some(values) => *values,
        None => [T::ZERO; W],
    }
}

#[inline(always)]
fn store<T: Real, const C: usize, const W: usize>(row: &mut [T; C], at: usize, values: &[T; W]) {
    if let Some(part) = row.get_mut(at..at + W) {
        part.copy_from_slice(values);
    }
}

/// `sum + values * factor`, number by number.
#[inline(always)]
fn multiply_add<T: Real, const W: usize>(sum: &mut [T; W], values: &[T; W], factor: T) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum = value.mul_add(factor, *sum);
    }
}

#[inline(always)]
pub(crate) fn add_dot<T: Real, const Y: usize>(a: &[T; Y], b: &[T; Y], sum: T) -> T {
    let mut sum = sum;
    for k in 0..Y {
        sum = a[k].mul_add(b[k], sum);
    }
    sum
}
