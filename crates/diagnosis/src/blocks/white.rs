//! Whether rows are white within blocks: what quadratics leave of them.

use gyrocal_record::Record;
use gyrocal_statistics::{two_sided_p, z_of_two_sided_p};

use crate::noise::lattice;

/// Probability that the rows of a sound record are not taken for white: it is then diagnosed row by row.
const FALSE_REFUSAL: f64 = 1e-3;

/// Most lags of the correlation within a block that are tested.
const MOST_LAGS: usize = 12;

/// Least share of the rows that whole blocks without gaps must hold.
const WHOLE: f64 = 0.5;

/// Length of an interval over the median one, less one, up to which rows are taken as equally spaced.
const SPACING: f64 = 0.01;

/// Smallest step of quantisation, in standard deviations of the noise, that the noise audit of rows names.
const LEAST_STEP: f64 = 0.5;

/// Coefficients of a quadratic.
const TERMS: usize = 3;

/// What quadratics through equally spaced rows leave of each block of an axis.
pub(super) struct Rows<'a> {
    record: &'a Record,
    /// Rows of a block.
    rows: usize,
    /// Residuals by axis, block after block.
    left: [Vec<f64>; 3],
    /// The matrix that takes the quadratic out of the rows of a block.
    out: Vec<Vec<f64>>,
}

impl<'a> Rows<'a> {
    /// Blocks of so many rows at an interval, none of which reaches over a jump. `None` if too few are whole.
    pub(super) fn new(
        record: &'a Record,
        (interval_s, rows): (f64, usize),
        jumps: &[usize],
    ) -> Option<Self> {
        let basis = quadratics(rows);
        let mut this = Self {
            record,
            rows,
            left: Default::default(),
            out: without(&basis),
        };
        let mut first = 0;
        while first + rows <= record.len() {
            let block = first..first + rows;
            let inside = jumps.partition_point(|row| *row <= first);
            if let Some(jump) = jumps.get(inside).filter(|row| **row < block.end) {
                first = *jump;
                continue;
            }
            let off = record.time_s[block.clone()]
                .windows(2)
                .position(|pair| ((pair[1] - pair[0]) / interval_s - 1.0).abs() > SPACING);
            if let Some(off) = off {
                first += off + 1;
                continue;
            }
            for (axis, left) in this.left.iter_mut().enumerate() {
                let values = record.accel_g[block.clone()].iter().map(|row| row[axis]);
                leave(values, &basis, left);
            }
            first += rows;
        }
        let enough = WHOLE * record.len() as f64;
        let is_enough = |left: &Vec<f64>| left.len() as f64 >= enough;
        this.left.iter().all(is_enough).then_some(this)
    }

    /// Standard deviation of a value of each axis, g.
    pub(super) fn noise_g(&self) -> [f64; 3] {
        let share = (self.rows - TERMS) as f64 / self.rows as f64;
        self.left.each_ref().map(|left| {
            let squares: f64 = left.iter().map(|value| value * value).sum();
            (squares / (share * left.len() as f64)).sqrt()
        })
    }

    /// Whether the rows are those of white, steady, normal and continuous noise.
    pub(super) fn are_white(&self) -> bool {
        // Largest value, steadiness, quantisation, and each lag, of each axis.
        let lags = MOST_LAGS.min(self.rows / 2);
        let each = FALSE_REFUSAL / (3 * (2 + lags)) as f64;
        let most = z_of_two_sided_p(each);
        let noise_g = self.noise_g();
        let is_continuous = |axis: usize| {
            let values = self.record.accel_g.iter().map(|row| row[axis]);
            lattice::find(values, LEAST_STEP * noise_g[axis]).is_none()
        };
        (0..3).all(|axis| {
            let (left, noise_g) = (&self.left[axis], noise_g[axis]);
            noise_g > 0.0
                && self.largest_p(left, noise_g) > each
                && self.steadiness(left, noise_g).abs() < most
                && (1..=lags).all(|lag| self.correlation(left, noise_g, lag).abs() < most)
                && is_continuous(axis)
        })
    }

    /// Probability of a residual as large as the largest among so many.
    fn largest_p(&self, left: &[f64], noise_g: f64) -> f64 {
        let spread: Vec<f64> = (0..self.rows)
            .map(|row| self.out[row][row].sqrt())
            .collect();
        let scaled = left.iter().zip(spread.iter().cycle());
        let largest = scaled.fold(0.0_f64, |most, (value, spread)| {
            most.max(value.abs() / (spread * noise_g))
        });
        two_sided_p(largest) * left.len() as f64
    }

    /// How much more than by chance the variance changes from block to block, in standard deviations.
    fn steadiness(&self, left: &[f64], noise_g: f64) -> f64 {
        let freedom = (self.rows - TERMS) as f64;
        let blocks = left.chunks_exact(self.rows);
        let count = blocks.len() as f64;
        let squares = blocks.map(|block| {
            let square: f64 = block.iter().map(|value| value * value).sum();
            (square / (noise_g * noise_g) - freedom).powi(2) / (2.0 * freedom)
        });
        // Fourth moment of chi-square about its mean: 12 ν² + 48 ν.
        (squares.sum::<f64>() / count - 1.0) / ((2.0 + 12.0 / freedom) / count).sqrt()
    }

    /// Sum of products of values `lag` rows apart less its expectation in white noise, in standard deviations.
    fn correlation(&self, left: &[f64], noise_g: f64, lag: usize) -> f64 {
        let blocks = left.chunks_exact(self.rows);
        let count = blocks.len() as f64;
        let products = |block: &[f64]| -> f64 {
            let pairs = block.iter().zip(&block[lag..]);
            pairs.map(|(a, b)| a * b).sum()
        };
        let sum: f64 = blocks.map(products).sum::<f64>() / (noise_g * noise_g);
        let expected: f64 = (lag..self.rows).map(|row| self.out[row - lag][row]).sum();
        // Of eᵀ A e with e = M w of white w: 2 tr(A M A M), A the symmetric matrix of the lag.
        let shifted = |row: usize, column: usize| {
            let before = row
                .checked_sub(lag)
                .map_or(0.0, |row| self.out[row][column]);
            let after = self.out.get(row + lag).map_or(0.0, |row| row[column]);
            0.5 * (before + after)
        };
        let places = (0..self.rows).flat_map(|row| (0..self.rows).map(move |column| (row, column)));
        let trace: f64 = places
            .map(|(row, column)| shifted(row, column) * shifted(column, row))
            .sum();
        (sum - count * expected) / (2.0 * trace * count).sqrt()
    }
}

/// Orthonormal polynomials of degree 0 to 2 at equally spaced places.
fn quadratics(rows: usize) -> [Vec<f64>; TERMS] {
    let middle = (rows - 1) as f64 / 2.0;
    let mut basis: [Vec<f64>; TERMS] = core::array::from_fn(|power| {
        let places = (0..rows).map(|row| row as f64 - middle);
        places.map(|place| place.powi(power as i32)).collect()
    });
    for power in 0..TERMS {
        let (lower, rest) = basis.split_at_mut(power);
        let own = &mut rest[0];
        for lower in lower {
            let along: f64 = own.iter().zip(&*lower).map(|(a, b)| a * b).sum();
            for (own, lower) in own.iter_mut().zip(&*lower) {
                *own -= along * lower;
            }
        }
        let length = own.iter().map(|value| value * value).sum::<f64>().sqrt();
        own.iter_mut().for_each(|value| *value /= length);
    }
    basis
}

/// One less the projection on a basis.
fn without(basis: &[Vec<f64>; TERMS]) -> Vec<Vec<f64>> {
    let rows = basis[0].len();
    let entry = |row: usize, column: usize| {
        let along: f64 = basis.iter().map(|own| own[row] * own[column]).sum();
        f64::from(u8::from(row == column)) - along
    };
    let of_row = |row| (0..rows).map(|column| entry(row, column)).collect();
    (0..rows).map(of_row).collect()
}

/// Adds what a basis leaves of some values; nothing if one is missing.
fn leave(
    values: impl Iterator<Item = f64> + Clone,
    basis: &[Vec<f64>; TERMS],
    left: &mut Vec<f64>,
) {
    if values.clone().any(f64::is_nan) {
        return;
    }
    let along = basis.each_ref().map(|own| -> f64 {
        let products = own.iter().zip(values.clone());
        products.map(|(own, value)| own * value).sum()
    });
    left.extend(values.enumerate().map(|(row, value)| {
        let smooth: f64 = basis
            .iter()
            .zip(along)
            .map(|(own, along)| own[row] * along)
            .sum();
        value - smooth
    }));
}
