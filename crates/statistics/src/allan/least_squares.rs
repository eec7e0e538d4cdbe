//! Generalised least squares of Allan variances on the parts of a noise.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use super::parts::{NoisePart, PARTS};

/// Allan variances at some averaging times, with the weights of one covariance matrix.
pub(super) struct Weighted {
    /// Whitened variances of the parts at each averaging time.
    whitened: DMatrix<f64>,
    /// Factor of the covariance matrix.
    factor: Cholesky<f64, Dyn>,
    /// Normal matrix.
    normal: [[f64; PARTS]; PARTS],
}

/// Conditions on the variances of the parts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Conditions {
    /// The part 1/τ² may be negative: samples that are correlated for a short time have less variance
    /// at the shortest averaging times than white noise.
    pub(super) signed: bool,
    /// A part of known variance.
    pub(super) fixed: Option<(usize, f64)>,
}

impl Weighted {
    /// `None` if the covariance is not positive definite.
    pub(super) fn new(averaging: &[usize], covariance: DMatrix<f64>) -> Option<Self> {
        let factor = covariance.cholesky()?;
        let parts = DMatrix::from_fn(averaging.len(), PARTS, |row, part| {
            NoisePart::ALL[part].variance(averaging[row] as f64)
        });
        let whitened = factor.l_dirty().solve_lower_triangular(&parts)?;
        let mut normal = [[0.0; PARTS]; PARTS];
        for (p, row) in normal.iter_mut().enumerate() {
            for (q, value) in row.iter_mut().enumerate() {
                *value = whitened.column(p).dot(&whitened.column(q));
            }
        }
        Some(Self {
            whitened,
            factor,
            normal,
        })
    }

    /// Whitened Allan variances.
    pub(super) fn whiten(&self, variances: &DVector<f64>) -> DVector<f64> {
        let mut white = variances.clone();
        self.factor.l_dirty().solve_lower_triangular_mut(&mut white);
        white
    }

    /// Sum of squares of the whitened residuals.
    pub(super) fn chi_square(&self, white: &DVector<f64>, parts: &[f64; PARTS]) -> f64 {
        let mut sum = 0.0;
        for (row, value) in self.whitened.row_iter().zip(white.iter()) {
            let fitted: f64 = row
                .iter()
                .zip(parts)
                .map(|(shape, part)| shape * part)
                .sum();
            sum += (value - fitted) * (value - fitted);
        }
        sum
    }

    /// Standard deviation of the variance of a part, all being free; `None` if it is not determined.
    pub(super) fn sigma(&self, part: usize) -> Option<f64> {
        let mut right = [0.0; PARTS];
        right[part] = 1.0;
        let column = self.of_set((1 << PARTS) - 1, &right)?;
        Some(column[part].max(0.0).sqrt())
    }

    /// Variances of the parts by least squares, none negative but where the conditions allow it.
    pub(super) fn solve(&self, white: &DVector<f64>, conditions: Conditions) -> [f64; PARTS] {
        let mut right = [0.0; PARTS];
        for (value, column) in right.iter_mut().zip(self.whitened.column_iter()) {
            *value = column.dot(white);
        }
        let mut start = [0.0; PARTS];
        let mut free: [bool; PARTS] = [true; PARTS];
        if let Some((part, variance)) = conditions.fixed {
            start[part] = variance;
            free[part] = false;
            for (row, value) in right.iter_mut().enumerate() {
                *value -= self.normal[row][part] * variance;
            }
        }
        let all = free
            .iter()
            .enumerate()
            .fold(0_u8, |set, (part, free)| set | u8::from(*free) << part);
        let mut best = (f64::INFINITY, start);
        // All free parts first: with none negative that is the solution. Otherwise the best of the few
        // sets with no negative part.
        for set in (0..=all).rev().filter(|set| set & !all == 0) {
            let Some(parts) = self.of_set(set, &right) else {
                continue;
            };
            let negative = (0..PARTS).any(|p| parts[p] < 0.0 && !(p == 0 && conditions.signed));
            if negative {
                continue;
            }
            // Decrease of the sum of squares.
            let gain: f64 = parts.iter().zip(&right).map(|(part, r)| part * r).sum();
            if -gain < best.0 {
                let mut parts = parts;
                if let Some((part, variance)) = conditions.fixed {
                    parts[part] = variance;
                }
                best = (-gain, parts);
            }
            if set == all {
                break;
            }
        }
        best.1
    }

    /// Solution with the parts of a set alone; `None` if they are not distinguishable.
    fn of_set(&self, set: u8, right: &[f64; PARTS]) -> Option<[f64; PARTS]> {
        let members = || (0..PARTS).filter(move |part| set >> part & 1 == 1);
        let scale = |part: usize| self.normal[part][part].sqrt();
        // Cholesky factor of the normal matrix with a diagonal of ones.
        let mut lower = [[0.0; PARTS]; PARTS];
        let mut solution = [0.0; PARTS];
        for i in members() {
            let mut value = right[i] / scale(i);
            for j in members().take_while(|j| *j <= i) {
                let mut sum = self.normal[i][j] / (scale(i) * scale(j));
                for k in members().take_while(|k| *k < j) {
                    sum -= lower[i][k] * lower[j][k];
                }
                if i == j {
                    if sum < SINGULAR {
                        return None;
                    }
                    lower[i][i] = sum.sqrt();
                } else {
                    lower[i][j] = sum / lower[j][j];
                }
            }
            for k in members().take_while(|k| *k < i) {
                value -= lower[i][k] * solution[k];
            }
            solution[i] = value / lower[i][i];
        }
        for i in members().collect::<Vec<_>>().into_iter().rev() {
            for k in members().filter(|k| *k > i) {
                solution[i] -= lower[k][i] * solution[k];
            }
            solution[i] /= lower[i][i];
        }
        for part in members() {
            solution[part] /= scale(part);
        }
        Some(solution)
    }
}

/// Parts are not distinguishable if less than this share of one is left beside the others.
const SINGULAR: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    fn weighted() -> Weighted {
        Weighted::new(&[1, 2, 4, 8, 16, 32, 64], DMatrix::identity(7, 7)).expect("an identity")
    }

    fn sum(parts: [f64; PARTS]) -> DVector<f64> {
        let of = |row: i32| {
            let averaging = 2_f64.powi(row);
            let parts = NoisePart::ALL.iter().zip(parts);
            parts.map(|(part, v)| v * part.variance(averaging)).sum()
        };
        DVector::from_iterator(7, (0..7).map(of))
    }

    #[test]
    fn a_sum_of_parts_is_found_again() {
        let (weighted, truth) = (weighted(), [2.0, 3.0, 0.5, 0.01]);
        let found = weighted.solve(&weighted.whiten(&sum(truth)), Conditions::default());
        for (found, truth) in found.iter().zip(truth) {
            assert!((found / truth - 1.0).abs() < 1e-9, "{found} {truth}");
        }
    }

    #[test]
    fn only_the_shortest_part_may_be_negative() {
        let (weighted, truth) = (weighted(), [-0.2, 3.0, 0.5, 0.01]);
        let white = weighted.whiten(&sum(truth));
        let signed = Conditions {
            signed: true,
            fixed: None,
        };
        assert!((weighted.solve(&white, signed)[0] + 0.2).abs() < 1e-9);
        assert_eq!(weighted.solve(&white, Conditions::default())[0], 0.0);
        let fixed = Conditions {
            signed: true,
            fixed: Some((2, 0.5)),
        };
        let found = weighted.solve(&white, fixed);
        assert!(
            (found[1] - 3.0).abs() < 1e-9 && found[2] == 0.5,
            "{found:?}"
        );
    }
}
