//! The rows of a record that are still believed.

use gyrocal_record::{Bench, Record};

use crate::finding::SetupFinding;
use crate::noise::{ColumnNoise, column_noise};
use crate::vector::{Vector, dot, unit};

/// Rows of a record, of which each test takes out what it explains.
pub(crate) struct Samples<'a> {
    pub(crate) bench: &'a Bench,
    pub(crate) time_s: &'a [f64],
    /// Specific force; `NaN` is missing, or taken out.
    pub(crate) accel_g: Vec<Vector>,
    /// Temperature of each row, if it was logged.
    pub(crate) temperature_c: Option<Vec<f64>>,
    /// Specific force at rest as the bench description says, in the record's unit.
    pub(crate) rest_g: f64,
    /// Noise of each column as the record shows it.
    pub(crate) noise: [ColumnNoise; 3],
    /// Square of the magnitude that most rows have.
    pub(crate) square_g2: f64,
    /// Number of rows in use: those before a jump.
    pub(crate) end: usize,
    /// An error that only a fit can confirm.
    pub(crate) unconfirmed: Option<SetupFinding>,
}

/// One row with all three components.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Complete {
    pub(crate) row: usize,
    pub(crate) time_s: f64,
    pub(crate) force_g: Vector,
    /// Its direction: the vertical, in platform axes.
    pub(crate) up: Vector,
}

impl<'a> Samples<'a> {
    /// All rows; times and samples are as many.
    pub(crate) fn new(record: &'a Record, bench: &'a Bench) -> Self {
        let rows = record.len().min(record.accel_g.len());
        let finite = |value: f64| if value.is_finite() { value } else { f64::NAN };
        let rest_g = bench.specific_force_at_rest();
        let mut samples = Self {
            bench,
            time_s: &record.time_s[..rows],
            accel_g: record.accel_g[..rows]
                .iter()
                .map(|row| row.map(finite))
                .collect(),
            temperature_c: record
                .temperature_c
                .as_ref()
                .map(|column| column[..rows.min(column.len())].to_vec()),
            rest_g: if rest_g > 0.0 && rest_g.is_finite() {
                rest_g
            } else {
                1.0
            },
            noise: [ColumnNoise::default(); 3],
            square_g2: 1.0,
            end: rows,
            unconfirmed: None,
        };
        samples.look_again();
        samples
    }

    /// Estimates noise and magnitude anew, after values were taken out.
    pub(crate) fn look_again(&mut self) {
        let declared_g = self.bench.accel_noise_g;
        self.noise = core::array::from_fn(|axis| {
            let column = self.accel_g.iter().map(|row| row[axis]);
            column_noise(self.time_s, &column.collect::<Vec<_>>(), declared_g)
        });
        self.square_g2 = self.common_square();
    }

    /// Leaves the values of some axes in some rows out.
    pub(crate) fn leave_out(&mut self, rows: impl IntoIterator<Item = usize>, axes: &[usize]) {
        for row in rows {
            for axis in axes {
                self.accel_g[row][*axis] = f64::NAN;
            }
        }
        self.look_again();
    }

    /// Rows in which at least one accelerometer has a value.
    pub(crate) fn measured_rows(&self) -> usize {
        let has_value = |row: &&Vector| row.iter().any(|component| !component.is_nan());
        self.accel_g.iter().filter(has_value).count()
    }

    /// Rows in use with all three components.
    pub(crate) fn complete(&self) -> Vec<Complete> {
        let rows = self.accel_g[..self.end].iter().zip(self.time_s).enumerate();
        rows.filter(|(_, (force_g, _))| force_g.iter().all(|value| !value.is_nan()))
            .filter(|(_, (force_g, _))| force_g.iter().any(|value| *value != 0.0))
            .map(|(row, (force_g, time_s))| Complete {
                row,
                time_s: *time_s,
                force_g: *force_g,
                up: unit(*force_g),
            })
            .collect()
    }

    /// Square of the magnitude of a row; `NaN` if a component is missing.
    pub(crate) fn square(&self, row: usize) -> f64 {
        dot(self.accel_g[row], self.accel_g[row])
    }

    /// Largest of the noises of the columns, steps of the converter included.
    pub(crate) fn sigma_g(&self) -> f64 {
        self.noise
            .iter()
            .map(ColumnNoise::width_g)
            .fold(0.0, f64::max)
    }

    /// By how much a squared magnitude may be off, noise and slow errors of sound accelerometers
    /// included, g².
    pub(crate) fn square_tolerance_g2(&self) -> f64 {
        /// Twenty sigmas of noise on a value of 1 g; a stuck or clipped value is off by more within
        /// a few minutes.
        const SIGMAS: f64 = 20.0;
        /// Sound accelerometers are off by less than a thousandth.
        const LEAST: f64 = 2e-3;
        (2.0 * SIGMAS * self.sigma_g() * self.rest_g).max(LEAST * self.square_g2)
    }

    /// The middle of the shortest interval that holds a fifth of the squared magnitudes: rows that
    /// are sound all have the same, whatever the rest have. That of the bench description if these
    /// are far from it.
    fn common_square(&self) -> f64 {
        /// Accelerometers and sites differ by less.
        const NEAR: f64 = 0.1;
        /// Rows that are enough for it; the cost of the sort does not grow beyond them.
        const ROWS: usize = 5000;
        let declared = self.rest_g * self.rest_g;
        let mut squares: Vec<f64> = (0..self.accel_g.len())
            .step_by(self.accel_g.len().div_ceil(ROWS).max(1))
            .map(|row| self.square(row))
            .filter(|square| !square.is_nan())
            .collect();
        squares.sort_by(f64::total_cmp);
        let held = squares.len() / 5;
        let middle = (0..squares.len().saturating_sub(held))
            .map(|first| (squares[first + held] - squares[first], first))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, first)| squares[first + held / 2]);
        middle
            .filter(|square| (square / declared - 1.0).abs() < 2.0 * NEAR)
            .unwrap_or(declared)
    }

    /// The record with what was taken out missing, cut where it jumps.
    pub(crate) fn to_record(&self) -> Record {
        Record {
            time_s: self.time_s[..self.end].to_vec(),
            accel_g: self.accel_g[..self.end].to_vec(),
            temperature_c: self
                .temperature_c
                .as_ref()
                .map(|column| column[..self.end.min(column.len())].to_vec()),
        }
    }
}
