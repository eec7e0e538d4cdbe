//! Variance added along a direction (Agee and Turner).

use gyrocal_scalar::Real;

/// U D Uᵀ + c a aᵀ: columns up to the last element of a that is not zero change, the last first
/// (Bierman, *Factorization Methods for Discrete Sequential Estimation*, 1977, section III.3).
///
/// `rest` is workspace of as many numbers as there are states.
#[inline]
pub(super) fn diffuse<T: Real>(
    factor: &mut [T],
    pivots: &mut [T],
    rest: &mut [T],
    direction: &[T],
    variance: T,
) {
    let n = pivots.len();
    let mut c = variance;
    for (element, a) in rest.iter_mut().zip(direction) {
        *element = *a;
    }
    let used = direction.iter().rposition(|a| *a != T::ZERO);
    let used = used.map_or(0, |last| last + 1);
    let columns = factor.chunks_exact_mut(n.max(1)).zip(pivots).enumerate();
    for (j, (column, pivot)) in columns.take(used).rev() {
        let own = rest.get(j).copied().unwrap_or(T::ZERO);
        let before = *pivot;
        let after = (c * own).mul_add(own, before);
        let reciprocal = T::from_f64(1.0) / after;
        let share = c * own * reciprocal;
        for (element, a) in column.iter_mut().zip(rest.iter_mut()).take(j) {
            *a = *a - own * *element;
            *element = share.mul_add(*a, *element);
        }
        *pivot = after;
        c = c * (before * reciprocal);
    }
}
