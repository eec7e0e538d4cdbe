//! The covariance as P = U D Uᵀ: prediction and update of the factors.
//!
//! U is unit upper triangular, states ordered moving first, parameters after. Then
//!
//! - a prediction changes the moving rows of U and the moving pivots only, because Φ is the
//!   identity on the parameters: U_mp ← Φ_mm U_mp + Φ_mp U_pp, and the M × M corner is
//!   orthogonalised again with the noise by weighted Gram-Schmidt (Thornton's method);
//! - an update takes the outputs one by one (Bierman's method), but all of them in a single
//!   sweep over U: what later outputs need of the earlier ones is known as soon as the rows
//!   that enter the output are, so those rows go first and yield the coefficients for the rest.

mod diffuse;
mod innovation;
mod predict;
mod update;

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Form, Numbers, Observation, Transition, Zeros};
use crate::innovation::Innovation;

/// The factors U and D: P is symmetric and positive definite whatever rounding does, in single
/// precision and from wide priors. `cargo figures kernel --part filter` prints how much longer a step takes than
/// with [`crate::Covariance`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Factors;

impl<T: Real> Form<T> for Factors {
    const USES_ZEROS: bool = false;

    #[inline]
    fn start(numbers: &mut Numbers<'_, T>, variances: impl Iterator<Item = T>) {
        let n = numbers.pivots.len();
        numbers.matrix.fill(T::from_f64(0.0));
        for (j, variance) in variances.enumerate() {
            numbers.matrix[j * n + j] = T::from_f64(1.0);
            numbers.pivots[j] = variance;
        }
    }

    #[inline]
    fn element(matrix: &[T], pivots: &[T], _moving: usize, i: usize, j: usize) -> T {
        let n = pivots.len();
        (i.max(j)..n).fold(T::from_f64(0.0), |sum, l| {
            (matrix[l * n + i] * pivots[l]).mul_add(matrix[l * n + j], sum)
        })
    }

    #[inline]
    fn save(matrix: &[T], pivots: &[T], mut put: impl FnMut(T)) {
        pivots.iter().for_each(|pivot| put(*pivot));
        for (j, column) in matrix.chunks_exact(pivots.len().max(1)).enumerate() {
            column.iter().take(j).for_each(|element| put(*element));
        }
    }

    #[inline]
    fn restore(numbers: &mut Numbers<'_, T>, mut get: impl FnMut() -> Option<T>) {
        let n = numbers.pivots.len().max(1);
        for (place, value) in numbers.pivots.iter_mut().zip(core::iter::from_fn(&mut get)) {
            *place = value;
        }
        // Column by column; the diagonal and what is below it are the same since the start. One
        // loop, which a compiler does not write out for every element as it does nested ones.
        let (mut row, mut column) = (0, 1);
        for _ in 0..n * (n - 1) / 2 {
            if let (Some(place), Some(value)) = (numbers.matrix.get_mut(column * n + row), get()) {
                *place = value;
            }
            row += 1;
            if row == column {
                (row, column) = (0, column + 1);
            }
        }
    }

    #[inline(always)]
    fn predict<const M: usize, const SPARSE: bool>(
        numbers: &mut Numbers<'_, T>,
        transition: &Transition<'_, T, M>,
        _zeros: &impl Zeros,
    ) -> Result<(), EstimationError> {
        predict::predict(numbers.matrix, numbers.pivots, transition)
    }

    #[inline(always)]
    fn recentre<const M: usize>(
        numbers: &mut Numbers<'_, T>,
        map: &[[T; M]; M],
    ) -> Result<(), EstimationError> {
        let none = [T::from_f64(0.0); M];
        predict::predict_corner(numbers.matrix, numbers.pivots, map, &[none; M], &none)
    }

    #[inline]
    fn diffuse(numbers: &mut Numbers<'_, T>, direction: &[T], variance: T) {
        let Numbers {
            matrix,
            pivots,
            cross,
            ..
        } = numbers;
        let rest = cross.get_mut(..pivots.len()).unwrap_or_default();
        diffuse::diffuse(matrix, pivots, rest, direction, variance);
    }

    #[inline]
    fn widen(numbers: &mut Numbers<'_, T>, factor: T) {
        for pivot in numbers.pivots.iter_mut() {
            *pivot = *pivot * factor;
        }
    }

    #[inline(always)]
    fn innovation<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        observation: &Observation<'_, T, M, Y>,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        innovation::innovation(numbers.matrix, numbers.pivots, observation, numbers.gain)
    }

    #[inline(always)]
    fn update<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        parameters: &mut [T],
        observation: &Observation<'_, T, M, Y>,
        _zeros: &impl Zeros,
        correct: impl FnOnce(&[T; M]),
    ) -> Result<Innovation<T, Y>, EstimationError> {
        update::update(numbers, parameters, observation, correct)
    }
}
