//! Reads the rows of a record and checks that they are plausible.

use std::ops::Range;
use std::path::Path;

use crate::error::{Error, InputErrorKind};
use crate::fields::{Field, Line, Lines};
use crate::header::Header;
use crate::record::Record;
use crate::source::{SourceText, quoted};

/// Limits of the median norm of specific force in a record, g.
const MEDIAN_NORM: std::ops::RangeInclusive<f64> = 0.9..=1.1;
/// Limits of the norm in one row, g; wide, as outliers are left to the diagnosis.
const ROW_NORM: std::ops::RangeInclusive<f64> = 0.5..=1.5;

/// Longest record, s: a hundred years. Longer ones are mistakes in the unit of time, and take long
/// to integrate.
const LONGEST_S: f64 = 3.16e9;

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

impl Record {
    /// Reads a record.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Ok(read_with_places(&SourceText::read(path)?, 1, Codes::Refused)?.0)
    }

    /// Reads a record of a platform that something is to be estimated from: with at least some
    /// number of rows, as many as a filter has states, not too far apart, and not all the same.
    /// Numbers that stand for missing values, the same in three rows or more, are read as they
    /// stand: the check of the set-up leaves them out.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it.
    pub fn read_at_least(path: &Path, rows: usize) -> Result<Self, Error> {
        let source = SourceText::read(path)?;
        let (record, places) = read_with_places(&source, rows, Codes::Read)?;
        check_intervals(&record, &source, &places)?;
        check_stuck(&record, &source, &places)?;
        Ok(record)
    }

    /// Parses the text of a record; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Ok(read_with_places(&SourceText::new(text, name)?, 1, Codes::Refused)?.0)
    }
}

fn read_with_places(
    source: &SourceText,
    least: usize,
    codes: Codes,
) -> Result<(Record, Vec<Range<usize>>), Error> {
    let mut lines = Lines::of(source);
    let first = lines.next_line()?.unwrap_or_default();
    let header = Header::parse(source, &first)?;
    let mut record = Record {
        temperature_c: header.temperature.map(|_| Vec::new()),
        ..Record::default()
    };
    let mut places = Vec::new();
    while let Some(line) = lines.next_line()? {
        push_row(&mut record, source, &header, &line)?;
        places.push(line.span);
    }
    let last = places.last().unwrap_or(&first.span);
    refuse_too_few(&record, source, last, least)?;
    check_norms(&record, source, &places, codes)?;
    Ok((record, places))
}

/// Refuses a record with too few rows; those in which all accelerometers are `nan` do not count.
fn refuse_too_few(
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
        format!("{} {which}", counted(found)),
        format!("at least {}", counted(least)),
        "a record takes as many rows as there are states to estimate, and a day or more to \
         determine them",
    ))
}

fn counted(rows: usize) -> String {
    let ending = if rows == 1 { "" } else { "s" };
    format!("{rows} row{ending}")
}

fn push_row(
    record: &mut Record,
    source: &SourceText,
    header: &Header,
    line: &Line<'_>,
) -> Result<(), Error> {
    let fields = &line.fields;
    if fields.len() != header.fields {
        return Err(source.error(
            InputErrorKind::FieldCount,
            line.span.clone(),
            format!("{} fields", fields.len()),
            format!("{} fields, as the header has", header.fields),
            "a missing accelerometer value is written `nan`; decimal numbers have a point",
        ));
    }
    let number = |field: usize, expected: &str| {
        let number = fields[field].text.parse::<f64>().ok();
        number
            .filter(|number| !number.is_infinite())
            .ok_or_else(|| not_a_number(source, &fields[field], expected))
    };
    let finite = |field: usize| {
        let number = number(field, "a finite number")?;
        if number.is_nan() {
            return Err(not_a_number(source, &fields[field], "a finite number"));
        }
        Ok(number)
    };
    let time_s = finite(header.time)?;
    if let Some(last) = record.time_s.last().filter(|last| time_s <= **last) {
        return Err(source.error(
            InputErrorKind::Time,
            fields[header.time].span.clone(),
            format!("time {time_s} s after {last} s"),
            format!("a time greater than {last} s"),
            "sort the rows by time and keep one of those that repeat",
        ));
    }
    let first_s = record.time_s.first().copied().unwrap_or(time_s);
    if time_s - first_s > LONGEST_S {
        return Err(source.error(
            InputErrorKind::Time,
            fields[header.time].span.clone(),
            format!("time {time_s:?} s in a record that starts at {first_s:?} s"),
            "a record of at most a hundred years",
            "time_s is in seconds: divide milliseconds by 1e3, nanoseconds by 1e9",
        ));
    }
    let mut accel_g = [0.0; 3];
    for (component, field) in accel_g.iter_mut().zip(header.accel) {
        *component = number(field, "a finite number or `nan`")?;
    }
    if let (Some(column), Some(field)) = (&mut record.temperature_c, header.temperature) {
        column.push(finite(field)?);
    }
    record.time_s.push(time_s);
    record.accel_g.push(accel_g);
    Ok(())
}

fn not_a_number(source: &SourceText, field: &Field<'_>, expected: &str) -> Error {
    let found = quoted(field.text);
    let span = field.span.clone();
    source.error(InputErrorKind::NotANumber, span, found, expected, "")
}

fn check_intervals(
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

fn check_stuck(record: &Record, source: &SourceText, places: &[Range<usize>]) -> Result<(), Error> {
    let stuck = (0..3).all(|axis| is_stuck(record, axis));
    if record.len() < STUCK_ROWS || !stuck {
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

/// Whether nearly all values of an axis are one, or there are none.
fn is_stuck(record: &Record, axis: usize) -> bool {
    let column = record.accel_g.iter().map(|row| row[axis]);
    let mut values: Vec<f64> = column.filter(|value| !value.is_nan()).collect();
    values.sort_by(f64::total_cmp);
    let equal = values.chunk_by(|a, b| a == b).map(<[f64]>::len);
    equal.max().unwrap_or(0) as f64 >= STUCK_SHARE * values.len() as f64
}

/// What is done with numbers that stand for missing values.
#[derive(Clone, Copy)]
enum Codes {
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

fn check_norms(
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
