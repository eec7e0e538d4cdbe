//! Sensors that stand still: padding at the end of a log, gyros that repeat a value.

use core::ops::Range;

use gyrocal::generated::catalogue::RATES;
use gyrocal_record::InputErrorKind;

use super::Log;
use crate::columns::FileColumns;
use crate::description::Gyro;
use crate::error::{InstrumentError, Unfit};

/// Fewest repeats in a row that are told, and fewest samples beside them.
const FEWEST: usize = 10;
const LEAST: usize = 50;

/// Probability that noise repeats itself as often anywhere in a log, below which it is none.
const CHANCE: f64 = 1e-9;

/// Share of repeats about a stretch, above which steps are too coarse to tell it.
const COARSE: f64 = 0.6;

/// Refuses rows at the end that repeat one another, and gyros that repeat a value while those about it scatter; of a log
/// that turns rows of zeros at its end alone, as the unit may rest for as long in one step of coarse sensors, which
/// [`refuse_still_at_stops`] tells once the stops are known.
///
/// # Errors
///
/// [`InstrumentError::File`] at the first of these rows.
pub(super) fn refuse_stuck(
    file: &FileColumns,
    gyro: &Gyro,
    sensors: usize,
    turns: bool,
) -> Result<(), InstrumentError> {
    let columns = &file.values[..sensors];
    let rows = columns[0].len();
    let repeats = |column: &Vec<f64>, row: usize| column[row] == column[row - 1];
    let whole: Vec<bool> = (1..rows)
        .map(|row| columns.iter().all(|column| repeats(column, row)))
        .collect();
    let is_padding = |run: &Range<usize>| {
        let is_zero = || columns.iter().all(|column| column[run.start] == 0.0);
        let mut gyros = columns.iter().take(3);
        let mut is_still = || !turns && gyros.any(|column| Changes::of(column).scatter_about(run));
        run.end == whole.len() && (is_zero() || is_still())
    };
    if let Some(padding) = stretch(&whole, is_padding) {
        let mut gyros = columns.iter().take(3);
        let is_zero = gyros.all(|column| column[padding.start] == 0.0);
        // The row that the others repeat is a reading, unless its gyros are zero.
        let first = padding.start + usize::from(!is_zero);
        let count = rows - first;
        return Err(file.error_at(
            first,
            InputErrorKind::Stuck,
            Unfit::Stuck,
            [
                &format!("{count} rows to the end of the log that all have the same values"),
                "values that scatter as those before",
                "it is padding, or the logger had stopped: delete the rows from this line on",
            ],
        ));
    }
    if turns {
        return Ok(());
    }
    for (column, name) in gyro.columns.iter().enumerate() {
        refuse_still(file, column, name, gyro.zero_counts != 0.0)?;
    }
    Ok(())
}

/// Refuses a column, by its number, that repeats a value while those about it scatter. An end of its range is left to
/// the check of saturation; zero is none unless counts are from zero on, `is_unsigned`.
///
/// # Errors
///
/// [`InstrumentError::File`] at the first of these rows.
pub(crate) fn refuse_still(
    file: &FileColumns,
    column: usize,
    name: &str,
    is_unsigned: bool,
) -> Result<(), InstrumentError> {
    let values = &file.values[column];
    let changes = Changes::of(values);
    let equal: Vec<bool> = changes.sizes.iter().map(|size| *size == 0.0).collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let is_within = |run: &Range<usize>| {
        let value = values[run.start];
        let is_end = !(low < value && value < high) && (value != 0.0 || is_unsigned);
        !is_end && changes.scatter_about(run)
    };
    let Some(still) = stretch(&equal, is_within) else {
        return Ok(());
    };
    let (count, value) = (still.len() + 1, values[still.start]);
    Err(file.error_at(
        still.start,
        InputErrorKind::Stuck,
        Unfit::Stuck,
        [
            &format!("`{name}` at {value} in {count} samples from here on"),
            "values that scatter as those about them",
            &format!(
                "the sensor stood still, or rows are padding: keep the part of the log in front of this line, or that \
                 behind these {count} rows"
            ),
        ],
    ))
}

/// Refuses gyros that repeat a value at the stops of a log while those of the stops about it scatter.
///
/// # Errors
///
/// [`Unfit::Stuck`] with the first of these samples.
pub(crate) fn refuse_still_at_stops(
    log: &Log,
    stops: &[Range<usize>],
) -> Result<(), InstrumentError> {
    // Pairs of successive samples within the stops, by the first of both.
    let pairs = stops
        .iter()
        .flat_map(|stop| stop.start..stop.end.max(1) - 1);
    let pairs: Vec<usize> = pairs.collect();
    for (gyro, rate) in RATES.iter().enumerate().take(3) {
        let value = |sample: usize| log.gyro[sample][gyro];
        let sizes = pairs.iter().map(|at| (value(at + 1) - value(*at)).abs());
        let changes = Changes::of_sizes(sizes.collect());
        let equal: Vec<bool> = changes.sizes.iter().map(|size| *size == 0.0).collect();
        let Some(still) = stretch(&equal, |run| changes.scatter_about(run)) else {
            continue;
        };
        let first = pairs[still.start];
        let stop = stops.iter().position(|stop| stop.contains(&first));
        return Err(InstrumentError::unfit(
            Unfit::Stuck,
            format!(
                "{} with the same output in {} samples from sample {} at {} s on, at stop {} of its log",
                rate.id,
                still.len() + 1,
                first + 1,
                log.time_s[first],
                stop.map_or(0, |stop| stop + 1)
            ),
            "values that scatter as at the other stops",
            "the sensor stood still, or rows are padding: give the stops without these samples with --stop, or cut the log \
             there",
        ));
    }
    Ok(())
}

/// The first stretch of repeats that chance does not give: row `k + 1` repeats row `k` for each of its numbers `k`.
fn stretch(equal: &[bool], is_asked: impl Fn(&Range<usize>) -> bool) -> Option<Range<usize>> {
    let mut from = 0;
    let mut runs = Vec::new();
    for run in equal.chunk_by(|one, next| one == next) {
        if run[0] && run.len() >= FEWEST {
            runs.push(from..from + run.len());
        }
        from += run.len();
    }
    let is_no_chance = |run: &Range<usize>| {
        let Some(share) = share_about(equal, run).filter(|share| *share < COARSE) else {
            return false;
        };
        // A share of a few samples is uncertain.
        let likely = 0.05 + 1.2 * share;
        equal.len() as f64 * likely.powi(run.len() as i32) < CHANCE
    };
    runs.into_iter()
        .find(|run| is_no_chance(run) && is_asked(run))
}

/// What is beside a stretch, several times as long as it.
fn sides<'a, T>(all: &'a [T], run: &Range<usize>) -> [&'a [T]; 2] {
    let width = (4 * run.len()).max(4 * LEAST);
    [
        &all[run.start.saturating_sub(width)..run.start],
        &all[run.end..(run.end + width).min(all.len())],
    ]
}

/// Changes from value to value.
struct Changes {
    /// Their sizes.
    sizes: Vec<f64>,
    /// The smallest but zero: the step of the values.
    step: f64,
}

impl Changes {
    fn of(values: &[f64]) -> Self {
        let sizes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        Self::of_sizes(sizes.collect())
    }

    fn of_sizes(sizes: Vec<f64>) -> Self {
        let steps = sizes.iter().copied().filter(|size| *size > 0.0);
        let step = steps.fold(f64::INFINITY, f64::min);
        Self { sizes, step }
    }

    /// Whether values beside a stretch scatter over several steps: those of a coarse sensor that is shaken now and then
    /// do not tell that it stood still between.
    fn scatter_about(&self, run: &Range<usize>) -> bool {
        const STEPS: f64 = 4.0;
        sides(&self.sizes, run).iter().any(|side| {
            let square = side.iter().map(|size| size * size).sum::<f64>() / side.len() as f64;
            square.sqrt() >= STEPS * self.step
        })
    }
}

/// Share of repeats on that side of a stretch where there are more; `None` if there is not enough beside it.
fn share_about(equal: &[bool], run: &Range<usize>) -> Option<f64> {
    let sides = sides(equal, run);
    let shares = sides
        .iter()
        .filter(|side| side.len() >= LEAST)
        .map(|side| side.iter().filter(|equal| **equal).count() as f64 / side.len() as f64);
    shares.reduce(f64::max)
}
