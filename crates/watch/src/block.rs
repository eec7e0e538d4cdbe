use gyrocal_scalar::Real;

use crate::step::{Observed, Step, Whitened};
use crate::table::Driven;

/// Columns X and their Gram matrix M over the steps of a block. `L` = N (N + 1) / 2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Block<T, const N: usize, const D: usize, const L: usize> {
    /// Deviation of the state now for a unit of each state at the beginning.
    pub(crate) unit: [[T; N]; N],
    /// The same for the driven columns, which begin at zero.
    pub(crate) driven: [[T; N]; D],
    /// Gram matrix of the unit columns, below and on its diagonal, by rows.
    pub(crate) gram: [T; L],
    /// Of driven columns with unit columns.
    pub(crate) mixed: [[T; N]; D],
    /// Of driven columns.
    pub(crate) among: [[T; D]; D],
    /// Part of the block that has passed.
    pub(crate) passed: T,
}

impl<T: Real, const N: usize, const D: usize, const L: usize> Block<T, N, D, L> {
    pub(crate) const fn new() -> Self {
        const { assert!(L == N * (N + 1) / 2, "L = N (N + 1) / 2") };
        Self {
            unit: [[T::ZERO; N]; N],
            driven: [[T::ZERO; N]; D],
            gram: [T::ZERO; L],
            mixed: [[T::ZERO; N]; D],
            among: [[T::ZERO; D]; D],
            passed: T::ZERO,
        }
    }

    #[inline]
    pub(crate) fn begin(&mut self) {
        for (j, column) in self.unit.iter_mut().enumerate() {
            *column = [T::ZERO; N];
            column[j] = T::from_f64(1.0);
        }
        self.driven = [[T::ZERO; N]; D];
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
            unit: [[T::ZERO; Y]; N],
            driven: [[T::ZERO; Y]; D],
        };
        let passed = self.passed + step.part;
        for (column, shown) in self.unit.iter_mut().zip(&mut whitened.unit) {
            predict(column, step.transition);
            if let Some(observed) = step.observed {
                *shown = correct(column, observed, [T::ZERO; Y]);
            }
        }
        let half = T::from_f64(0.5) * step.part;
        let columns = self.driven.iter_mut().zip(&mut whitened.driven);
        for ((column, shown), driven) in columns.zip(table) {
            // A parameter that rises has its mean over the step.
            raise(column, driven, half);
            predict(column, step.transition);
            raise(column, driven, half);
            if let Some(observed) = step.observed {
                let (output, size) = match *driven {
                    Driven::Slope(_) => (Y, T::ZERO),
                    Driven::Output(output) => (output, T::from_f64(1.0)),
                    Driven::OutputSlope(output) => (output, passed),
                };
                let mut direct = [T::ZERO; Y];
                for k in 0..Y {
                    let element = observed.whitening[k].get(output).copied();
                    direct[k] = size * element.unwrap_or(T::ZERO);
                }
                *shown = correct(column, observed, direct);
            }
        }
        self.passed = passed;
        if step.observed.is_some() {
            self.add(&whitened);
        }
        whitened
    }

    /// Adds a step to the Gram matrix.
    #[inline(always)]
    fn add<const Y: usize>(&mut self, whitened: &Whitened<T, Y, N, D>) {
        let mut place = self.gram.iter_mut();
        for i in 0..N {
            for (j, place) in (0..N).take(i + 1).zip(&mut place) {
                *place = add_dot(&whitened.unit[i], &whitened.unit[j], *place);
            }
        }
        for (d, shown) in whitened.driven.iter().enumerate() {
            for j in 0..N {
                self.mixed[d][j] = add_dot(shown, &whitened.unit[j], self.mixed[d][j]);
            }
            for other in 0..D {
                if other <= d {
                    let sum = self.among[d][other];
                    self.among[d][other] = add_dot(shown, &whitened.driven[other], sum);
                }
            }
        }
    }

    /// δ at the end of what has passed, of a deviation and driven columns with their coefficients.
    #[inline(always)]
    pub(crate) fn carry(&self, unit: &[T; N], driven: &[(usize, T); 2]) -> [T; N] {
        let mut sum = [T::ZERO; N];
        for (column, size) in self.unit.iter().zip(unit) {
            for i in 0..N {
                sum[i] = column[i].mul_add(*size, sum[i]);
            }
        }
        for (index, size) in driven {
            if let Some(column) = self.driven.get(*index) {
                for i in 0..N {
                    sum[i] = column[i].mul_add(*size, sum[i]);
                }
            }
        }
        sum
    }

    /// vᵀ M v.
    #[inline(always)]
    pub(crate) fn information(&self, unit: &[T; N], driven: &[(usize, T); 2]) -> T {
        let two = T::from_f64(2.0);
        let mut total = T::ZERO;
        let mut elements = self.gram.iter();
        for i in 0..N {
            let mut beside = T::ZERO;
            for (element, v) in (&mut elements).take(i).zip(unit) {
                beside = element.mul_add(*v, beside);
            }
            let own = elements.next().copied().unwrap_or(T::ZERO) * unit[i];
            total = unit[i].mul_add(two.mul_add(beside, own), total);
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
fn raise<T: Real, const N: usize>(column: &mut [T; N], driven: &Driven, by: T) {
    if let Driven::Slope(state) = driven
        && let Some(place) = column.get_mut(*state)
    {
        *place = *place + by;
    }
}

#[inline(always)]
fn predict<T: Real, const M: usize, const N: usize>(
    column: &mut [T; N],
    transition: &[[T; N]; M],
) {
    let mut moving = [T::ZERO; M];
    for i in 0..M {
        let mut sum = transition[i][0] * column[0];
        for j in 1..N {
            sum = transition[i][j].mul_add(column[j], sum);
        }
        moving[i] = sum;
    }
    for (place, value) in column.iter_mut().zip(moving) {
        *place = value;
    }
}

/// The whitened innovation of a column, `direct` being the part that does not come from the state,
/// and the column after the correction.
#[inline(always)]
fn correct<T: Real, const M: usize, const Y: usize, const N: usize>(
    column: &mut [T; N],
    observed: &Observed<T, M, Y, N>,
    direct: [T; Y],
) -> [T; Y] {
    let mut shown = direct;
    for k in 0..Y {
        for i in 0..M {
            shown[k] = observed.output[k][i].mul_add(column[i], shown[k]);
        }
    }
    for j in 0..N {
        let mut value = column[j];
        for k in 0..Y {
            value = value - observed.gain[k][j] * shown[k];
        }
        column[j] = value;
    }
    shown
}

#[inline(always)]
pub(crate) fn add_dot<T: Real, const Y: usize>(a: &[T; Y], b: &[T; Y], sum: T) -> T {
    let mut sum = sum;
    for k in 0..Y {
        sum = a[k].mul_add(b[k], sum);
    }
    sum
}
