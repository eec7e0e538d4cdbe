//! A record as the batch engine reads it.

use gyrocal::estimation::batch::Series;
use gyrocal::{Chart, ChartInputs};
use gyrocal_record::{Bench, Record};

/// A record with the bench it was taken on: one turn-on of the platform.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The samples.
    pub record: &'a Record,
    /// What is known of the bench.
    pub bench: &'a Bench,
}

/// The rows of a record with the noise that is believed of them.
#[derive(Debug)]
pub(crate) struct Rows<'a> {
    record: &'a Record,
    /// How many rows, from the first, are looked at.
    rows: usize,
    /// Variance of an output whose weight is 1.
    variance_g2: [f64; 3],
    /// Weight of each row's outputs, if some are not trusted.
    pub(crate) weights: Option<Vec<[f64; 3]>>,
}

impl<'a> Rows<'a> {
    pub(crate) fn new(record: &'a Record, rows: usize, noise_g: [f64; 3]) -> Self {
        Self {
            record,
            rows,
            variance_g2: noise_g.map(|sigma| sigma * sigma),
            weights: None,
        }
    }

    /// Standard deviation of an output whose weight is 1.
    pub(crate) fn declared_noise_g(&self) -> [f64; 3] {
        self.variance_g2.map(f64::sqrt)
    }
}

impl<I: ChartInputs<f64>> Series<Chart<f64, I>, 3> for Rows<'_> {
    fn rows(&self) -> usize {
        self.rows
    }

    fn time_s(&self, row: usize) -> f64 {
        self.record.time_s[row]
    }

    fn measured(&self, row: usize) -> [f64; 3] {
        self.record.accel_g[row]
    }

    fn noise_variance(&self, row: usize) -> [f64; 3] {
        match &self.weights {
            None => self.variance_g2,
            Some(weights) => {
                core::array::from_fn(|axis| self.variance_g2[axis] / weights[row][axis])
            }
        }
    }
}
