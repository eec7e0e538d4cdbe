//! Update of P by whitened gains.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Observation, Zeros};
use crate::innovation::Innovation;
use crate::projection::{Projection, check_diagonal};
use crate::unrolled::{load, load_rows, mul_add, store};

/// Quantities of the pass over P.
pub(super) struct Pass<'a, T, const M: usize, const Y: usize> {
    projection: &'a Projection<'a, T, M, Y>,
    /// diag(α)^-1/2.
    root: [T; Y],
    /// Weights of the rows of L⁻¹ H P in the correction of the state.
    weights: [T; Y],
    /// Moving columns of V.
    head: [[T; M]; Y],
}

impl<'a, T: Real, const M: usize, const Y: usize> Pass<'a, T, M, Y> {
    /// `head` are the moving columns of L⁻¹ H P.
    #[inline(always)]
    pub(super) fn new(
        projection: &'a Projection<'a, T, M, Y>,
        innovation: &Innovation<T, Y>,
        mut head: [[T; M]; Y],
    ) -> Self {
        let root = projection.reciprocal.map(T::sqrt);
        for k in 0..Y {
            head[k] = head[k].map(|value| value * root[k]);
        }
        Self {
            projection,
            root,
            weights: innovation.weights,
            head,
        }
    }

    /// P ← (I - K H) P and the parameters' correction; V (Y × n) is left in `gain`.
    #[inline(always)]
    pub(super) fn run(
        &self,
        p: &mut [T],
        n: usize,
        parameters: &mut [T],
        gain: &mut [T],
    ) -> Result<(), EstimationError> {
        let count = n - M;
        for (k, head) in self.head.iter().enumerate() {
            store(gain, k * n, *head);
        }
        let mut column = 0;
        while column + 4 <= count {
            self.columns::<4>(p, n, parameters, gain, column);
            column += 4;
        }
        while column < count {
            self.columns::<1>(p, n, parameters, gain, column);
            column += 1;
        }
        self.projection.update_corner(p, n, &self.head);
        for i in 0..count {
            let weights: [[T; 1]; Y] = load_rows(gain, n, M + i);
            let mut column = 0;
            while column + 4 <= count && column <= i {
                downdate::<T, M, Y, 4>(p, n, gain, &weights, i, column);
                column += 4;
            }
            while column <= i {
                downdate::<T, M, Y, 1>(p, n, gain, &weights, i, column);
                column += 1;
            }
        }
        check_diagonal(p, n, n)
    }

    /// V, the cross block and the parameters, for `W` columns.
    #[inline(always)]
    fn columns<const W: usize>(
        &self,
        p: &mut [T],
        n: usize,
        parameters: &mut [T],
        gain: &mut [T],
        column: usize,
    ) {
        let at = M + column;
        let mut cross: [[T; W]; M] = load_rows(p, n, at);
        let mut v: [[T; W]; Y] = load_rows(gain, n, at);
        self.projection.reduce(&mut v);
        let mut corrected: [T; W] = load(parameters, column);
        for k in 0..Y {
            corrected = mul_add(v[k], self.weights[k], corrected);
            v[k] = v[k].map(|value| value * self.root[k]);
            for i in 0..M {
                cross[i] = mul_add(v[k], -self.head[k][i], cross[i]);
            }
            store(gain, k * n + at, v[k]);
        }
        store(parameters, column, corrected);
        for (i, row) in cross.iter().enumerate() {
            store(p, i * n + at, *row);
        }
    }
}

/// Leaves the parameter columns of H P in `products` (Y × n).
#[inline(always)]
pub(super) fn project_parameters<T: Real, Z: Zeros, const M: usize, const Y: usize>(
    p: &[T],
    n: usize,
    observation: &Observation<'_, T, M, Y>,
    zeros: &Z,
    products: &mut [T],
) {
    let count = n - M;
    let mut column = 0;
    while column + 4 <= count {
        project_columns::<_, _, M, Y, 4>(p, n, observation, zeros, products, M + column);
        column += 4;
    }
    while column < count {
        project_columns::<_, _, M, Y, 1>(p, n, observation, zeros, products, M + column);
        column += 1;
    }
}

#[inline(always)]
fn project_columns<T: Real, Z: Zeros, const M: usize, const Y: usize, const W: usize>(
    p: &[T],
    n: usize,
    observation: &Observation<'_, T, M, Y>,
    zeros: &Z,
    products: &mut [T],
    at: usize,
) {
    let q = observation.parameters.len() / Y;
    let mut sums = [[T::from_f64(0.0); W]; Y];
    for i in 0..M + q {
        let row: [T; W] = load(p, i * n + at);
        for k in 0..Y {
            let h = if i < M {
                observation.moving[k][i]
            } else {
                observation.parameters[k * q + i - M]
            };
            if i >= M || zeros.shows(k, i) {
                sums[k] = mul_add(row, h, sums[k]);
            }
        }
    }
    for (k, sum) in sums.iter().enumerate() {
        store(products, k * n + at, *sum);
    }
}

/// Subtracts Vᵀ V from `W` columns of row `i` of the parameter block, and puts those that end
/// before the diagonal to the other side of it too.
#[inline(always)]
fn downdate<T: Real, const M: usize, const Y: usize, const W: usize>(
    p: &mut [T],
    n: usize,
    gain: &[T],
    weights: &[[T; 1]; Y],
    i: usize,
    column: usize,
) {
    let mut value: [T; W] = load(p, (M + i) * n + M + column);
    for k in 0..Y {
        let v: [T; W] = load(gain, k * n + M + column);
        value = mul_add(v, -weights[k][0], value);
    }
    store(p, (M + i) * n + M + column, value);
    if column + W <= i {
        for (j, element) in value.into_iter().enumerate() {
            p[(M + column + j) * n + M + i] = element;
        }
    }
}
