//! Structural zeros of a step as a model declares them, and products that leave them out.

use core::marker::PhantomData;

use gyrocal_scalar::{Real, Recentre};

use crate::form::Zeros;
use crate::unrolled::mul_add;

/// The zeros that a model knows of: those of its map to another chart, and, with `AT_ORIGIN`,
/// those of what consists of the Jacobians at the origin of the chart alone: of a transition of
/// one stage, and of an observation.
pub(crate) struct Known<'a, T, D, const M: usize, const Y: usize, const AT_ORIGIN: bool> {
    model: &'a D,
    scalar: PhantomData<T>,
}

impl<'a, T, D, const M: usize, const Y: usize, const AT_ORIGIN: bool>
    Known<'a, T, D, M, Y, AT_ORIGIN>
{
    #[inline(always)]
    pub(crate) fn of(model: &'a D) -> Self {
        Self {
            model,
            scalar: PhantomData,
        }
    }
}

impl<T, D, const M: usize, const Y: usize, const AT_ORIGIN: bool> Zeros
    for Known<'_, T, D, M, Y, AT_ORIGIN>
where
    T: Real,
    D: Recentre<T, M, Y>,
{
    #[inline(always)]
    fn moves(&self, i: usize, j: usize) -> bool {
        !AT_ORIGIN || self.model.moves_at_origin(i, j)
    }

    #[inline(always)]
    fn enters(&self, i: usize, j: usize) -> bool {
        !AT_ORIGIN || self.model.enters_at_origin(i, j)
    }

    #[inline(always)]
    fn drives(&self, i: usize, k: usize) -> bool {
        let same = self.model.noise_parameters();
        same.is_none_or(|same| self.enters(i, same[k]))
    }

    #[inline(always)]
    fn shows(&self, k: usize, j: usize) -> bool {
        !AT_ORIGIN || self.model.shows_at_origin(k, j)
    }

    #[inline(always)]
    fn maps(&self, i: usize, j: usize) -> bool {
        self.model.maps(i, j)
    }
}

/// `matrix` times `rows`, where `differs` says which elements are not those of the unit matrix.
#[inline(always)]
pub(crate) fn product<T: Real, const M: usize, const W: usize>(
    matrix: &[[T; M]; M],
    differs: impl Fn(usize, usize) -> bool,
    rows: &[[T; W]; M],
) -> [[T; W]; M] {
    let mut result = [[T::from_f64(0.0); W]; M];
    for i in 0..M {
        // The diagonal first: where it is one, the sum starts without a product.
        result[i] = if differs(i, i) {
            rows[i].map(|value| value * matrix[i][i])
        } else {
            rows[i]
        };
        for j in 0..M {
            if j != i && differs(i, j) {
                result[i] = mul_add(rows[j], matrix[i][j], result[i]);
            }
        }
    }
    result
}

/// `sum` and the product of `value` with an element of a matrix, which is that of the unit matrix
/// where it does not differ.
#[inline(always)]
pub(crate) fn add_product<T: Real>(
    value: T,
    element: T,
    differs: bool,
    on_diagonal: bool,
    sum: T,
) -> T {
    match (differs, on_diagonal) {
        (true, _) => value.mul_add(element, sum),
        (false, true) => sum + value,
        (false, false) => sum,
    }
}
