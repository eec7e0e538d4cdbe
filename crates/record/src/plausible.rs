//! Whether the values of a record are those of a platform.

use std::ops::Range;

use crate::error::{Error, InputErrorKind};
use crate::record::Record;
use crate::source::SourceText;
use crate::words::counted;

/// Limits of the median norm of specific force in a record, g.
const MEDIAN_NORM: std::ops::RangeInclusive<f64> = 0.9..=1.1;
/// Limits of the norm in one row, g; wide, as outliers are left to the diagnosis.
const ROW_NORM: std::ops::RangeInclusive<f64> = 0.5..=1.5;

/// Longest median interval, s: a quarter of the day in which gravity rotates once in the platform.
const LONGEST_INTERVAL_S: f64 = 21_600.0;

/// Longest gap, s: little is known of the attitude after a month without a reading, and its
/// prediction takes long.
const LONGEST_GAP_S: f64 = 30.0 * 86_400.0;

/// Number of rows from which on readings that do not change are a fault, and not rounded noise.
const STUCK_ROWS: usize = 100;

/// Share of equal readings of each axis from which on they are not those of a platform, as gravity
/// passes through the steps of the coarsest converter. The share of equal successive readings is no
/// criterion, since it grows with the sampling rate.
const STUCK_SHARE: f64 = 0.9;

/// Refuses a record with too few rows; those in which all accelerometers are `nan` do not count.
pub(crate) fn refuse_too_few(
    record: &Record,
    source: &SourceText,
    last: &Range<usize>,
    least: usize,
) -> Result<(), Error> {
    let found = record.measured_rows();
    if found >= least {
        return Ok(());
    }
    let which = if found == record.len() {
        "after the header"
    } else {
        "with a value of an accelerometer"
    };
    Err(source.error(
        InputErrorKind::TooFewRows,
        last.clone(),
        format!("{} {which}", counted(found, "row")),
        format!("at least {}", counted(least, "row")),
        "a record takes as many rows as there are states to estimate, and a day or more to \
         determine them",
    ))
}

pub(crate) fn check_intervals(
    record: &Record,
    source: &SourceText,
    places: &[Range<usize>],
) -> Result<(), Error> {
    let intervals_s: Vec<f64> = record.time_s.windows(2).map(|w| w[1] - w[0]).collect();
    let mut sorted = intervals_s.clone();
    sorted.sort_by(f64::total_cmp);
    let median_s = sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    let (allowed_s, found, expected, advice) = if median_s > LONGEST_INTERVAL_S {
        (
            LONGEST_INTERVAL_S,
            "rows that are mostly farther apart than a quarter of a day",
            "rows of one platform that gravity sweeps round once a day",
            "time_s is in seconds: divide milliseconds by 1e3, nanoseconds by 1e9",
        )
    } else {
        (
            LONGEST_GAP_S,
            "more than a month without a reading",
            "a record without such a gap",
            "cut it there and give `gyrocal calibrate` both parts, each with its bench file",
        )
    };
    let Some(at) = intervals_s
        .iter()
        .position(|interval| *interval > allowed_s)
    else {
        return Ok(());
    };
    Err(source.error(
        InputErrorKind::Time,
        places.get(at + 1).cloned().unwrap_or(0..0),
        format!("{found}, the first after row {}", at + 1),
        expected,
        advice,
    ))
}

pub(crate) fn check_stuck(
    record: &Record,
    source: &SourceText,
    places: &[Range<usize>],
) -> Result<(), Error> {
    if most_equal(&record.accel_g).is_none() {
        return Ok(());
    }
    Err(source.error(
        InputErrorKind::Stuck,
        places.first().cloned().unwrap_or(0..0),
        "readings that hardly ever change",
        "readings of a platform against which gravity turns",
        "look for accelerometers, or a logger, that hang",
    ))
}

/// How many readings of each accelerometer are the same; `None` unless nearly all are, in many rows.
#[must_use]
pub fn most_equal(accel_g: &[[f64; 3]]) -> Option<[usize; 3]> {
    let counts: [(usize, usize); 3] = core::array::from_fn(|axis| {
        let column = accel_g.iter().map(|row| row[axis]);
        let mut values: Vec<f64> = column.filter(|value| !value.is_nan()).collect();
        values.sort_by(f64::total_cmp);
        let equal = values.chunk_by(|a, b| a == b).map(<[f64]>::len);
        (equal.max().unwrap_or(0), values.len())
    });
    let is_stuck = |(equal, all): &(usize, usize)| *equal as f64 >= STUCK_SHARE * *all as f64;
    let stuck = accel_g.len() >= STUCK_ROWS && counts.iter().all(is_stuck);
    stuck.then_some(counts.map(|(equal, _)| equal))
}

/// What is done with numbers that stand for missing values.
#[derive(Clone, Copy)]
pub(crate) enum Codes {
    /// They are refused as nonsense.
    Refused,
    /// They are read.
    Read,
}

/// Rows of implausible norm with a component, zero or implausible by itself, that has the same value
/// in three such rows or more; rising.
fn coded_rows(record: &Record, norms: &[(usize, f64)]) -> Vec<usize> {
    const LEAST_ROWS: usize = 3;
    let odd = || norms.iter().filter(|(_, norm)| !ROW_NORM.contains(norm));
    let mut rows = Vec::new();
    for axis in 0..3 {
        let value = |row: usize| record.accel_g[row][axis];
        let coded = odd().map(|(row, _)| *row);
        let mut coded: Vec<usize> = coded
            .filter(|row| value(*row) == 0.0 || value(*row).abs() > *ROW_NORM.end())
            .collect();
        coded.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
        let equal = coded.chunk_by(|a, b| value(*a) == value(*b));
        rows.extend(equal.filter(|equal| equal.len() >= LEAST_ROWS).flatten());
    }
    rows.sort_unstable();
    rows
}

pub(crate) fn check_norms(
    record: &Record,
    source: &SourceText,
    places: &[Range<usize>],
    codes: Codes,
) -> Result<(), Error> {
    let norms: Vec<(usize, f64)> = record
        .accel_g
        .iter()
        .map(|a| (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]).sqrt())
        .enumerate()
        .filter(|(_, norm)| !norm.is_nan())
        .collect();
    if norms.is_empty() {
        return Ok(());
    }
    let mut sorted: Vec<f64> = norms.iter().map(|(_, norm)| *norm).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    let (allowed, found, advice) = if MEDIAN_NORM.contains(&median) {
        let found = "a norm of specific force of";
        let advice = "remove the row, or write `nan` for what was not measured";
        (ROW_NORM, found, advice)
    } else {
        let found = "a record in which the median norm of specific force is";
        (MEDIAN_NORM, found, suspicion(median))
    };
    let is_code = match codes {
        Codes::Read if MEDIAN_NORM.contains(&median) => coded_rows(record, &norms),
        _ => Vec::new(),
    };
    let wrong = |(row, norm): &&(usize, f64)| {
        !allowed.contains(norm) && is_code.binary_search(row).is_err()
    };
    let Some((row, norm)) = norms.iter().find(wrong) else {
        return Ok(());
    };
    let shown = if MEDIAN_NORM.contains(&median) {
        *norm
    } else {
        median
    };
    Err(source.error(
        InputErrorKind::Norm,
        places.get(*row).cloned().unwrap_or(0..0),
        format!(
            "{found} {} g (row {} after the header)",
            significant(shown),
            row + 1
        ),
        format!(
            "a norm near 1 g, from {} to {}",
            allowed.start(),
            allowed.end()
        ),
        advice,
    ))
}

/// Four significant digits, for people.
fn significant(value: f64) -> String {
    if (1e-3..1e7).contains(&value) {
        let digits = 3 - (value.log10().floor() as i32).clamp(-3, 3);
        format!("{value:.*}", usize::try_from(digits).unwrap_or(0))
    } else {
        format!("{value:.3e}")
    }
}

/// Probable unit of a record with this norm at rest, with advice.
fn suspicion(norm: f64) -> &'static str {
    let near = |expected: f64| (0.9..=1.1).contains(&(norm / expected));
    if near(9.806_65) {
        "the columns seem to be in m/s^2: divide them by local gravity"
    } else if (975.0..=985.0).contains(&norm) {
        // Narrow, because milli-g is near.
        "the columns seem to be in Gal (cm/s^2): divide them by local gravity in Gal"
    } else if near(1e3) {
        "the columns seem to be in mg: divide them by 1000"
    } else if near(1e6) {
        "the columns seem to be in micro-g: divide them by 1e6"
    } else if near(32.174) {
        "the columns seem to be in ft/s^2: divide them by local gravity"
    } else if norm < 0.1 {
        "gravity seems to have been removed: a platform at rest reads 1 g along the vertical"
    } else {
        "check the scale of the accelerometers and that all three columns are there"
    }
}
