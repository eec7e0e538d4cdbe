//! Whether rows are white: what quadratics leave of them.

use core::f64::consts::TAU;

use gyrocal_record::Record;
use gyrocal_statistics::{two_sided_p, z_of_two_sided_p};

use crate::noise::lattice;

/// Probability that the rows of a sound record are not taken for white: it is then diagnosed row by row.
const FALSE_REFUSAL: f64 = 1e-3;

/// Least share of the rows that stretches without gaps and missing values must hold.
const WHOLE: f64 = 0.5;

/// Length of an interval over the median one, less one, up to which rows are taken as equally spaced.
const SPACING: f64 = 0.01;

/// Smallest step of quantisation, in standard deviations of the noise, that the noise audit of rows names.
const LEAST_STEP: f64 = 0.5;

/// Coefficients of a quadratic.
const TERMS: usize = 3;

/// Share of the power at a frequency that a quadratic must leave for it to be tested.
const LEFT: f64 = 0.5;

/// What quadratics leave of equally spaced rows, stretch after stretch.
pub(super) struct Rows<'a> {
    record: &'a Record,
    /// Rows of a stretch.
    rows: usize,
    /// Residuals by axis.
    left: [Vec<f64>; 3],
    basis: [Vec<f64>; TERMS],
}

impl<'a> Rows<'a> {
    /// Stretches of so many rows at an interval, none of which reaches over a jump. `None` if they hold too little.
    pub(super) fn new(
        record: &'a Record,
        (interval_s, rows): (f64, usize),
        jumps: &[usize],
    ) -> Option<Self> {
        let basis = quadratics(rows);
        let mut left: [Vec<f64>; 3] = Default::default();
        let mut first = 0;
        while first + rows <= record.len() {
            let stretch = first..first + rows;
            let inside = jumps.partition_point(|row| *row <= first);
            if let Some(jump) = jumps.get(inside).filter(|row| **row < stretch.end) {
                first = *jump;
                continue;
            }
            let off = record.time_s[stretch.clone()]
                .windows(2)
                .position(|pair| ((pair[1] - pair[0]) / interval_s - 1.0).abs() > SPACING);
            if let Some(off) = off {
                first += off + 1;
                continue;
            }
            for (axis, left) in left.iter_mut().enumerate() {
                let values = record.accel_g[stretch.clone()].iter().map(|row| row[axis]);
                leave(values, &basis, left);
            }
            first += rows;
        }
        let enough = WHOLE * record.len() as f64;
        let is_enough = |left: &Vec<f64>| left.len() as f64 >= enough;
        left.iter().all(is_enough).then_some(Self {
            record,
            rows,
            left,
            basis,
        })
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
        // Largest value, steadiness and each frequency of each axis.
        let each = FALSE_REFUSAL / (3 * (2 + self.rows / 2)) as f64;
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
                && (1..=self.rows / 2).all(|wave| self.power(left, noise_g, wave).abs() < most)
                && is_continuous(axis)
        })
    }

    /// Probability of a residual as large as the largest among so many.
    fn largest_p(&self, left: &[f64], noise_g: f64) -> f64 {
        let taken = |row: usize| -> f64 { self.basis.iter().map(|own| own[row].powi(2)).sum() };
        let spread: Vec<f64> = (0..self.rows)
            .map(|row| (1.0 - taken(row)).sqrt())
            .collect();
        let scaled = left.iter().zip(spread.iter().cycle());
        let largest = scaled.fold(0.0_f64, |most, (value, spread)| {
            most.max(value.abs() / (spread * noise_g))
        });
        two_sided_p(largest) * left.len() as f64
    }

    /// How much more than by chance the variance changes from stretch to stretch, in standard deviations.
    fn steadiness(&self, left: &[f64], noise_g: f64) -> f64 {
        let freedom = (self.rows - TERMS) as f64;
        let stretches = left.chunks_exact(self.rows);
        let count = stretches.len() as f64;
        let squares = stretches.map(|stretch| {
            let square: f64 = stretch.iter().map(|value| value * value).sum();
            (square / (noise_g * noise_g) - freedom).powi(2) / (2.0 * freedom)
        });
        // Fourth moment of chi-square about its mean: 12 ν² + 48 ν.
        (squares.sum::<f64>() / count - 1.0) / ((2.0 + 12.0 / freedom) / count).sqrt()
    }

    /// Mean power of so many waves in a stretch less that of white noise, in standard deviations; zero where the
    /// quadratic takes most of it.
    fn power(&self, left: &[f64], noise_g: f64, waves: usize) -> f64 {
        let (rows, is_last) = (self.rows, 2 * waves == self.rows);
        let angle = |row: usize| TAU * ((waves * row) % rows) as f64 / rows as f64;
        let turns: Vec<(f64, f64)> = (0..rows).map(|row| angle(row).sin_cos()).collect();
        let along = |values: &[f64]| {
            let parts = values.iter().zip(&turns);
            parts.fold((0.0, 0.0), |(s, c), (value, (sin, cos))| {
                (s + value * sin, c + value * cos)
            })
        };
        let square = |values: &[f64]| {
            let (sine, cosine) = along(values);
            sine * sine + cosine * cosine
        };
        let expected = rows as f64 - self.basis.iter().map(|own| square(own)).sum::<f64>();
        if expected < LEFT * rows as f64 {
            return 0.0;
        }
        let stretches = left.chunks_exact(rows);
        let count = stretches.len() as f64;
        let mean = stretches.map(square).sum::<f64>() / (noise_g * noise_g * count);
        // The power is exponential; that of the highest frequency, without a sine, is the square of one normal value.
        let spread = if is_last { 2.0_f64.sqrt() } else { 1.0 };
        (mean / expected - 1.0) / (spread / count.sqrt())
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
