//! Averages of a fast record over intervals, each used as one sample.
//!
//! A mean over an interval is not the value at one time: with m₁ and m₂ the mean distance and
//! squared distance of its values from the time of the row, it exceeds that value by
//! m₁ a' + m₂ a''/2, up to the fourth derivative. Values that fill an interval T give T² a''/24,
//! of a platform that turns with the Earth 8e-7 g at a minute. The derivatives come from a
//! polynomial through the means themselves over a window that is so much wider than an interval
//! that they bring no noise with them.

use core::ops::Range;

use gyrocal_record::{AveragedReport, Bench, Record};
use gyrocal_statistics::{mean, median_interval_s};
use nalgebra::{SMatrix, SVector};

use crate::check::check_lengths;
use crate::error::CalibrationError;

/// Longest averaging interval, s. Over longer ones neither the fourth derivative that the
/// correction neglects nor the attitude random walk within an interval is small.
const LONGEST_INTERVAL_S: f64 = 600.0;

/// Half the window of the polynomial in intervals: the second derivative then adds about 1e-4 of
/// the noise of a mean.
const WINDOW_INTERVALS: f64 = 30.0;

/// Half the window at most: in an hour the platform turns by 0.26 rad, and what a polynomial of
/// degree 4 leaves out of a'' is 0.26⁴ / 100 of it.
const LONGEST_WINDOW_S: f64 = 3600.0;

/// Coefficients of the polynomial.
const TERMS: usize = 5;

/// Fewest means from which derivatives are estimated; with fewer nothing is corrected.
const FEWEST_MEANS: usize = 2 * TERMS - 1;

/// Least share of the median number of values that a mean needs to be used.
const ENOUGH: f64 = 0.5;

/// Tolerance of the interval boundaries for sampling times, as a share of an interval.
const ON_BOUNDARY: f64 = 1e-6;

/// A record of averages.
#[derive(Clone, Debug, PartialEq)]
pub struct AveragedRecord {
    /// The means at the mean times of their values. A row without values stands at the time of
    /// the first row that was averaged, to which the initial attitude belongs.
    pub record: Record,
    /// Number of values in each mean.
    pub values: Vec<[usize; 3]>,
    /// Number of means.
    pub means: usize,
    /// Noise of a mean over that of one value: the root of the mean of one over the number of
    /// values.
    pub noise_ratio: f64,
    /// Number of components of means left out because they had fewer than half of the median
    /// number of values of that axis.
    pub left_out: usize,
}

impl AveragedRecord {
    /// The bench description with the noise of a mean.
    #[must_use]
    pub fn bench(&self, bench: &Bench) -> Bench {
        Bench {
            accel_noise_g: bench.accel_noise_g * self.noise_ratio,
            ..bench.clone()
        }
    }

    /// The averaging over these intervals as results tell it; `bench` declares the noise of a mean.
    #[must_use]
    pub fn report(&self, bench: &Bench, interval_s: f64) -> AveragedReport {
        AveragedReport {
            interval_s,
            means: self.means,
            left_out: self.left_out,
            noise_ratio: self.noise_ratio,
            walk_share: attitude_walk_share(bench, interval_s),
        }
    }
}

/// Share of the variance of a mean that comes from the attitude random walk within the interval,
/// q T / 12 at most, which the noise of the samples does not include. `bench_of_means` declares
/// the noise of one mean.
#[must_use]
pub fn attitude_walk_share(bench_of_means: &Bench, interval_s: f64) -> f64 {
    // Held over a minute; in rad²/s.
    let rate = bench_of_means.gyro_noise_deg_per_h.to_radians() / 3600.0;
    let walk = rate * rate * 60.0 * interval_s / 12.0;
    walk / (walk + bench_of_means.accel_noise_g.powi(2))
}

/// Averages a record over intervals; the first one starts at the first row.
///
/// A missing component is left out of its mean; an interval without rows has no mean, so gaps
/// stay gaps.
///
/// # Errors
/// [`CalibrationError::AveragingInterval`] if the interval is shorter than two median steps of the
/// record or longer than ten minutes; [`CalibrationError::UnequalLengths`].
pub fn average_record(
    record: &Record,
    interval_s: f64,
) -> Result<AveragedRecord, CalibrationError> {
    average_between(record, interval_s, &[])
}

/// The same where no mean reaches over the beginning of one of some rows, which are in ascending order: of a record that
/// jumps there.
///
/// # Errors
/// As [`average_record`].
pub fn average_between(
    record: &Record,
    interval_s: f64,
    jumps: &[usize],
) -> Result<AveragedRecord, CalibrationError> {
    check_lengths(record)?;
    let least_s = 2.0 * median_step_s(record);
    // Written so that NaN is refused.
    if !(interval_s >= least_s * (1.0 - ON_BOUNDARY) && interval_s <= LONGEST_INTERVAL_S) {
        return Err(CalibrationError::AveragingInterval {
            found_s: interval_s,
            least_s,
            most_s: LONGEST_INTERVAL_S,
        });
    }
    let groups = groups(record, interval_s, jumps);
    let mut means: Vec<Mean> = groups
        .iter()
        .filter_map(|rows| Mean::of(record, rows))
        .collect();
    let left_out = leave_out_thin(&mut means);
    let corrected = correct(&means, interval_s);
    Ok(assemble(record, &means, corrected, left_out))
}

/// The median interval between rows; zero of fewer than two.
fn median_step_s(record: &Record) -> f64 {
    let interval_s = median_interval_s(&record.time_s);
    if interval_s.is_finite() {
        interval_s
    } else {
        0.0
    }
}

/// Rows of each interval that has any, and of its parts between jumps.
fn groups(record: &Record, interval_s: f64, jumps: &[usize]) -> Vec<Range<usize>> {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let interval = |row: usize| ((record.time_s[row] - first_s) / interval_s + ON_BOUNDARY).floor();
    let mut groups = Vec::new();
    let mut start = 0;
    for row in 1..=record.len() {
        let jumps = jumps.binary_search(&row).is_ok();
        if row == record.len() || jumps || interval(row) > interval(start) {
            groups.push(start..row);
            start = row;
        }
    }
    groups
}

/// The mean over one interval.
struct Mean {
    time_s: f64,
    value: [f64; 3],
    count: [usize; 3],
    /// Mean distance and squared distance of each component's values from `time_s`.
    moments: [[f64; 2]; 3],
    temperature_c: Option<f64>,
}

impl Mean {
    /// `None` if no row has a value.
    fn of(record: &Record, rows: &Range<usize>) -> Option<Self> {
        let measured: Vec<usize> = rows
            .clone()
            .filter(|row| record.accel_g[*row].iter().any(|value| !value.is_nan()))
            .collect();
        let first = *measured.first()?;
        // Sums of differences: times may be large against an interval.
        let since = |row: usize| record.time_s[row] - record.time_s[first];
        let middle = mean(measured.iter().map(|row| since(*row)));
        let mut this = Self {
            time_s: record.time_s[first] + middle,
            value: [f64::NAN; 3],
            count: [0; 3],
            moments: [[0.0; 2]; 3],
            temperature_c: record
                .temperature_c
                .as_ref()
                .map(|column| mean(measured.iter().map(|row| column[*row]))),
        };
        for axis in 0..3 {
            let there: Vec<usize> = measured
                .iter()
                .copied()
                .filter(|row| !record.accel_g[*row][axis].is_nan())
                .collect();
            this.count[axis] = there.len();
            let distance = |row: &usize| since(*row) - middle;
            this.value[axis] = mean(there.iter().map(|row| record.accel_g[*row][axis]));
            this.moments[axis] = [
                mean(there.iter().map(distance)),
                mean(there.iter().map(|row| distance(row).powi(2))),
            ];
        }
        Some(this)
    }
}

/// Marks means of too few values as missing; returns their number.
fn leave_out_thin(means: &mut [Mean]) -> usize {
    let mut left_out = 0;
    for axis in 0..3 {
        let mut counts: Vec<usize> = means
            .iter()
            .map(|mean| mean.count[axis])
            .filter(|count| *count > 0)
            .collect();
        counts.sort_unstable();
        let median = counts.get(counts.len() / 2).copied().unwrap_or(0) as f64;
        for mean in &mut *means {
            if mean.count[axis] > 0 && (mean.count[axis] as f64) < ENOUGH * median {
                (mean.count[axis], mean.value[axis]) = (0, f64::NAN);
                left_out += 1;
            }
        }
    }
    left_out
}

/// The values at the times of the rows: means less their first and second-order terms.
fn correct(means: &[Mean], interval_s: f64) -> Vec<[f64; 3]> {
    let half_s = (WINDOW_INTERVALS * interval_s).min(LONGEST_WINDOW_S);
    let (Some(first), Some(last)) = (means.first(), means.last()) else {
        return Vec::new();
    };
    // A window at an end of the record reaches further in.
    let (earliest_s, latest_s) = (first.time_s + half_s, last.time_s - half_s);
    let (mut from, mut to) = (0, 0);
    means
        .iter()
        .map(|row| {
            let middle_s = row.time_s.min(latest_s).max(earliest_s);
            while means[from].time_s < middle_s - half_s {
                from += 1;
            }
            while to < means.len() && means[to].time_s <= middle_s + half_s {
                to += 1;
            }
            core::array::from_fn(|axis| {
                let [first, second] = derivatives(&means[from..to], axis, row.time_s, half_s);
                let [m1, m2] = row.moments[axis];
                row.value[axis] - m1 * first - 0.5 * m2 * second
            })
        })
        .collect()
}

/// First and second derivative of a component at a time, from a least-squares polynomial through
/// its means; zero if there are too few of them or the normal equations are singular.
fn derivatives(means: &[Mean], axis: usize, time_s: f64, half_s: f64) -> [f64; 2] {
    let mut normal = SMatrix::<f64, TERMS, TERMS>::zeros();
    let mut right = SVector::<f64, TERMS>::zeros();
    let mut count = 0;
    for mean in means.iter().filter(|mean| mean.count[axis] > 0) {
        let place = (mean.time_s + mean.moments[axis][0] - time_s) / half_s;
        let powers = SVector::<f64, TERMS>::from_fn(|power, _| place.powi(power as i32));
        let weight = mean.count[axis] as f64;
        normal += weight * powers * powers.transpose();
        right += weight * mean.value[axis] * powers;
        count += 1;
    }
    if count < FEWEST_MEANS {
        return [0.0; 2];
    }
    normal.cholesky().map_or([0.0; 2], |cholesky| {
        let terms = cholesky.solve(&right);
        [terms[1] / half_s, 2.0 * terms[2] / half_s.powi(2)]
    })
}

fn assemble(
    record: &Record,
    means: &[Mean],
    corrected: Vec<[f64; 3]>,
    left_out: usize,
) -> AveragedRecord {
    let mut time_s: Vec<f64> = means.iter().map(|mean| mean.time_s).collect();
    let mut values: Vec<[usize; 3]> = means.iter().map(|mean| mean.count).collect();
    let mut accel_g = corrected;
    let mut temperature_c: Option<Vec<f64>> = means.iter().map(|mean| mean.temperature_c).collect();
    let means_with_value = accel_g
        .iter()
        .filter(|row: &&[f64; 3]| row.iter().any(|value| !value.is_nan()))
        .count();
    let inverse = mean(
        values
            .as_flattened()
            .iter()
            .filter(|count| **count > 0)
            .map(|count| 1.0 / *count as f64),
    );
    if let (Some(start_s), Some(first_s)) = (record.time_s.first(), time_s.first())
        && start_s < first_s
    {
        time_s.insert(0, *start_s);
        values.insert(0, [0; 3]);
        accel_g.insert(0, [f64::NAN; 3]);
        let at_start = record
            .temperature_c
            .as_ref()
            .and_then(|column| column.first());
        if let (Some(column), Some(first)) = (&mut temperature_c, at_start) {
            column.insert(0, *first);
        }
    }
    AveragedRecord {
        record: Record {
            time_s,
            accel_g,
            temperature_c: record.temperature_c.as_ref().and(temperature_c),
        },
        values,
        means: means_with_value,
        // A record without values has no noise either.
        noise_ratio: if inverse.is_nan() {
            1.0
        } else {
            inverse.sqrt()
        },
        left_out,
    }
}
