//! Rows that come faster than anything moves, as means of blocks.
//!
//! Within a block of m rows the attitude is a quadratic of time to far less than the noise, so that the mean holds what
//! the rows tell of it. Lost is what they tell of the attitude's random walk inside of the block: of the information
//! less than a thousandth up to m = √(r/q) / 4, with the variances r of a value and q of the walk from row to row. All
//! of that holds of white noise, which the rows are asked for first: a record whose rows have outliers, steps,
//! quantisation, bursts or correlated noise stays as it is.

mod jumps;
mod white;

use std::borrow::Cow;

use gyrocal_calibration::{
    AveragedRecord, CalibrationError, GyroAxes, Run, average_between, average_record,
};
use gyrocal_record::{AveragedReport, Bench, Record};
use gyrocal_statistics::{median_interval_s, upper_median};

use jumps::jumps;
use white::Rows;

/// Fewest blocks: records of some times as many rows are quick as they are.
const FEWEST_BLOCKS: usize = 4_000;

/// Longest block, s: a minute is a sixtieth of the shortest time constant of the catalogue, and the platform turns by
/// 0.0044 rad in it, whose cube is below the noise.
const LONGEST_S: f64 = 60.0;

/// Fewest rows of a block: fewer save little, and a quadratic leaves nothing of three.
const FEWEST_ROWS: usize = 4;

/// Most rows of a block, before which blocks are averaged again: longer stretches are no quadratics.
const MOST_ROWS: f64 = 60.0;

/// Rows whose noise is tested together over those of a block: a tone whose period is up to two blocks does not count as
/// one of another period then. Of fewer than the least number a quadratic leaves too little.
const TESTED: usize = 4;
const FEWEST_TESTED: usize = 24;

/// Rows of a block over the root of the variances of a value and of the walk from row to row.
const SHARE_OF_ROOT: f64 = 0.25;

/// Rows of a mean that shows the walk of the gyros, over those of a block: its walk is sixteen times as large against
/// its noise.
const WIDER: usize = 4;

/// Weights of a difference of order five. Its variance in white noise over that of a value is the sum of their squares;
/// for means of a random walk, over that of the walk from one to the next, it is that of the fourth difference of
/// steps, which have variance 2/3 and covariance 1/6 with the next: 70 · 2/3 − 112 / 6.
const DIFFERENCE: [f64; 6] = [-1.0, 5.0, -10.0, 10.0, -5.0, 1.0];
const OF_WHITE: f64 = 252.0;
const OF_WALK: f64 = 28.0;

/// Standard deviation of the variance that the median of squares of such differences gives, over it, for one of them: of
/// a median √5.44, and of the correlation of neighbours √2.91.
const SCATTER: f64 = 3.98;

/// Standard deviations by which the walk must exceed nothing.
const CERTAIN: f64 = 2.0;

/// Median of the square of a normal value of unit variance.
const MEDIAN_OF_SQUARE: f64 = 0.454_936;

/// Most jumps of a record that is averaged: one with more is in motion.
const MOST_JUMPS: usize = 20;

/// A record of means of blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocks {
    /// The means, at the mean times of their rows.
    pub record: Record,
    /// The bench description with the noise of a mean.
    pub bench: Bench,
    /// The blocks, as results tell them.
    pub report: AveragedReport,
    /// Noise of a row over the declared one, as the rows show it.
    pub(crate) accel_ratio: [f64; 3],
}

impl Blocks {
    /// Blocks of a record if they lose nothing that matters. `None` of a strapdown unit, of a short or slow record, and
    /// of one whose rows are not white. Rows that come very fast are averaged by turns.
    #[must_use]
    pub fn of(run: &Run<'_>, axes: Option<&GyroAxes>) -> Option<Self> {
        if axes.is_some() {
            return None;
        }
        let mut found = Self::once(run)?;
        while let Some(next) = Self::once(&found.run()) {
            let report = AveragedReport {
                left_out: found.report.left_out + next.report.left_out,
                noise_ratio: found.report.noise_ratio * next.report.noise_ratio,
                ..next.report
            };
            found = Self {
                report,
                accel_ratio: found.accel_ratio,
                ..next
            };
        }
        Some(found)
    }

    fn once(run: &Run<'_>) -> Option<Self> {
        let Run { record, bench } = *run;
        let interval_s = median_interval_s(&record.time_s);
        if record.accel_g.len() != record.len() || interval_s.is_nan() || interval_s <= 0.0 {
            return None;
        }
        let longest = (LONGEST_S / interval_s).min((record.len() / FEWEST_BLOCKS) as f64);
        let longest = longest.min(MOST_ROWS);
        let length = |noise_g: f64, walk: f64| {
            let rows = (SHARE_OF_ROOT * noise_g / walk.sqrt()).min(longest) as usize;
            (rows >= FEWEST_ROWS).then_some(rows)
        };
        let declared = walk_variance(bench, interval_s);
        let first = length(bench.accel_noise_g, declared)?;
        // The rows may have less noise than declared, and the gyros more.
        let noise_g = Rows::new(record, (interval_s, first), &[])?.noise_g();
        let shown = shown_walk_variance(record, interval_s, WIDER * first, noise_g)?;
        let least_g = noise_g.into_iter().fold(bench.accel_noise_g, f64::min);
        let rows = length(least_g, declared.max(shown))?;
        let jumps = jumps(record, (interval_s, rows), noise_g);
        let tested = FEWEST_TESTED.max(TESTED * rows);
        let is_steady = jumps.len() <= MOST_JUMPS;
        if !is_steady || !Rows::new(record, (interval_s, tested), &jumps)?.are_white() {
            return None;
        }
        let block_s = rows as f64 * interval_s;
        let means = average_between(record, block_s, &jumps).ok()?;
        Some(Self {
            accel_ratio: noise_g.map(|noise_g| noise_g / bench.accel_noise_g),
            ..Self::new(bench, means, block_s)
        })
    }

    /// Blocks of this length, whatever they lose.
    ///
    /// # Errors
    /// Those of [`average_record`].
    pub fn every(run: &Run<'_>, interval_s: f64) -> Result<Self, CalibrationError> {
        let means = average_record(run.record, interval_s)?;
        Ok(Self::new(run.bench, means, interval_s))
    }

    fn new(bench: &Bench, means: AveragedRecord, interval_s: f64) -> Self {
        let bench = means.bench(bench);
        Self {
            report: means.report(&bench, interval_s),
            bench,
            record: means.record,
            accel_ratio: [1.0; 3],
        }
    }

    /// A record with its bench description, as blocks if they lose nothing that matters, with what results tell of them.
    #[must_use]
    pub fn or_rows<'a>(
        record: Cow<'a, Record>,
        bench: &'a Bench,
        axes: Option<&GyroAxes>,
    ) -> (Cow<'a, Record>, Cow<'a, Bench>, Option<AveragedReport>) {
        let run = Run {
            record: &record,
            bench,
        };
        match Self::of(&run, axes) {
            Some(blocks) => (
                Cow::Owned(blocks.record),
                Cow::Owned(blocks.bench),
                Some(blocks.report),
            ),
            None => (record, Cow::Borrowed(bench), None),
        }
    }

    /// The means with their bench description.
    #[must_use]
    pub fn run(&self) -> Run<'_> {
        Run {
            record: &self.record,
            bench: &self.bench,
        }
    }
}

/// Variance of the random walk of the attitude from row to row, as the bench description declares it, rad².
fn walk_variance(bench: &Bench, interval_s: f64) -> f64 {
    // The noise is declared as held over a minute.
    let rate = bench.gyro_noise_deg_per_h.to_radians() / 3600.0;
    rate * rate * 60.0 * interval_s
}

/// The same as the rows show it at least: by what differences of order five of means hold beyond the noise of the rows, which
/// the turn with the Earth and slow drifts do not reach. Two of three axes see a turn about a level axis. Medians pass
/// over jumps. `None` of too few means.
fn shown_walk_variance(
    record: &Record,
    interval_s: f64,
    rows: usize,
    noise_g: [f64; 3],
) -> Option<f64> {
    let means = average_record(record, rows as f64 * interval_s).ok()?;
    let squares = means.record.accel_g.windows(DIFFERENCE.len()).map(|rows| {
        let difference = |axis: usize| -> f64 {
            let terms = rows.iter().zip(DIFFERENCE);
            terms.map(|(row, weight)| weight * row[axis]).sum()
        };
        [0, 1, 2].map(|axis| difference(axis).powi(2))
    });
    let squares: Vec<[f64; 3]> = squares.collect();
    let (mut walk, mut scatter) = (0.0, 0.0_f64);
    for (axis, noise_g) in noise_g.into_iter().enumerate() {
        let mut own: Vec<f64> = squares.iter().map(|square| square[axis]).collect();
        own.retain(|square| !square.is_nan());
        let variance = upper_median(&mut own)? / MEDIAN_OF_SQUARE;
        let of_noise = OF_WHITE * noise_g * noise_g / rows as f64;
        walk += variance - of_noise;
        scatter += (SCATTER * of_noise).powi(2) / own.len() as f64;
    }
    let least = (walk - CERTAIN * scatter.sqrt()).max(0.0);
    Some(least / (2.0 * OF_WALK * rows as f64))
}
