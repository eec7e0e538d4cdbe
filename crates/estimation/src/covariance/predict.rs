//! Prediction of P.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Transition, Zeros};
use crate::projection::check_diagonal;
use crate::unrolled::{load, load_rows, mul_add, multiply_add, store};
use crate::zeros::{add_product, product};

/// P ← W (Φ P Φᵀ + Γ diag(variance) Γᵀ) Wᵀ. W, which waits for the end of the step and for its
/// sines and cosines, comes last.
#[inline(always)]
pub(super) fn predict<T: Real, Z: Zeros, const M: usize, const SPARSE: bool>(
    p: &mut [T],
    n: usize,
    transition: &Transition<'_, T, M>,
    workspace: &mut [T],
    zeros: &Z,
) -> Result<(), EstimationError> {
    let count = n - M;
    let half = T::from_f64(0.5);
    let Transition {
        moving,
        noise,
        variance,
        map,
        ..
    } = transition;
    let mut column = 0;
    while column + 4 <= count {
        predict_columns::<_, _, M, 4, SPARSE>(p, n, transition, zeros, workspace, column);
        column += 4;
    }
    while column < count {
        predict_columns::<_, _, M, 1, SPARSE>(p, n, transition, zeros, workspace, column);
        column += 1;
    }
    let added = added::<_, _, M, SPARSE>(transition.parameters, count, workspace, zeros);
    let old: [[T; M]; M] = load_rows(p, n, 0);
    let mapped = product(moving, |i, j| zeros.moves(i, j), &old);
    let mut corner = [[T::from_f64(0.0); M]; M];
    for i in 0..M {
        for j in 0..=i {
            let mut sum = half * (added[i][j] + added[j][i]);
            for k in 0..M {
                sum = add_product(mapped[i][k], moving[j][k], zeros.moves(j, k), j == k, sum);
                if zeros.drives(i, k) && zeros.drives(j, k) {
                    sum = (noise[i][k] * variance[k]).mul_add(noise[j][k], sum);
                }
            }
            corner[i][j] = sum;
            corner[j][i] = sum;
        }
    }
    if let Some(map) = map {
        let rows = product(map, |i, j| zeros.maps(i, j), &corner);
        for i in 0..M {
            for j in 0..=i {
                let mut sum = T::from_f64(0.0);
                for k in 0..M {
                    sum = add_product(rows[i][k], map[j][k], zeros.maps(j, k), j == k, sum);
                }
                corner[i][j] = sum;
                corner[j][i] = sum;
            }
        }
    }
    for (i, row) in corner.iter().enumerate() {
        store(p, i * n, *row);
    }
    check_diagonal(p, n, M)
}

/// The moving rows W (Φ_mm P_mp + Φ_mp P_pp), for `W` columns. C = Φ_mp P_pp + 2 Φ_mm P_mp is left
/// in `workspace`.
#[inline(always)]
fn predict_columns<T: Real, Z: Zeros, const M: usize, const W: usize, const SPARSE: bool>(
    p: &mut [T],
    n: usize,
    transition: &Transition<'_, T, M>,
    zeros: &Z,
    workspace: &mut [T],
    column: usize,
) {
    let (count, at) = (n - M, M + column);
    let columns = transition.parameters;
    let old: [[T; W]; M] = load_rows(p, n, at);
    let mapped = product(&transition.moving, |i, j| zeros.moves(i, j), &old);
    let mut sums = mapped;
    for l in 0..count {
        let row: [T; W] = load(p, (M + l) * n + at);
        for i in 0..M {
            if !SPARSE || zeros.enters(i, l) {
                sums[i] = mul_add(row, columns[i * count + l], sums[i]);
            }
        }
    }
    for i in 0..M {
        let both = mul_add(mapped[i], T::from_f64(1.0), sums[i]);
        store(workspace, i * count + column, both);
    }
    if let Some(map) = &transition.map {
        sums = product(map, |i, j| zeros.maps(i, j), &sums);
    }
    for (i, row) in sums.iter().enumerate() {
        store(p, i * n + at, *row);
    }
}

/// C Φ_mpᵀ, whose symmetric part is all that the parameters add to the moving block. C (M × p, by
/// rows) is in `workspace`.
#[inline(always)]
fn added<T: Real, Z: Zeros, const M: usize, const SPARSE: bool>(
    columns: &[T],
    count: usize,
    workspace: &[T],
    zeros: &Z,
) -> [[T; M]; M] {
    let mut added = [[T::from_f64(0.0); M]; M];
    let mut rest = 0;
    if !SPARSE {
        rest = count / 4 * 4;
        for i in 0..M {
            let mut lanes = [[T::from_f64(0.0); 4]; M];
            for column in (0..rest).step_by(4) {
                let row: [T; 4] = load(workspace, i * count + column);
                for j in 0..M {
                    lanes[j] = multiply_add(row, load(columns, j * count + column), lanes[j]);
                }
            }
            for j in 0..M {
                let [a, b, c, d] = lanes[j];
                added[i][j] = (a + b) + (c + d);
            }
        }
    }
    for l in rest..count {
        for j in 0..M {
            if !SPARSE || zeros.enters(j, l) {
                let phi = columns[j * count + l];
                for i in 0..M {
                    added[i][j] = workspace[i * count + l].mul_add(phi, added[i][j]);
                }
            }
        }
    }
    added
}

/// The moving block carried through a map, for independent errors: nothing else changes.
#[inline(always)]
pub(super) fn recentre<T: Real, const M: usize>(
    p: &mut [T],
    n: usize,
    map: &[[T; M]; M],
) -> Result<(), EstimationError> {
    let old: [[T; M]; M] = load_rows(p, n, 0);
    let mapped = product(map, |_, _| true, &old);
    let mut corner = [[T::from_f64(0.0); M]; M];
    for i in 0..M {
        for j in 0..M {
            if j <= i {
                let mut sum = T::from_f64(0.0);
                for k in 0..M {
                    sum = mapped[i][k].mul_add(map[j][k], sum);
                }
                corner[i][j] = sum;
                corner[j][i] = sum;
            }
        }
    }
    for (i, row) in corner.iter().enumerate() {
        store(p, i * n, *row);
    }
    check_diagonal(p, n, M)
}
