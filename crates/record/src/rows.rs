//! The rows of a record, and whether they can be what they say.

use std::ops::Range;

use crate::error::{Error, InputErrorKind};
use crate::header::{Header, split_fields};
use crate::record::Record;
use crate::source::{SourceText, quoted};

/// The median norm of a record in units of gravity.
const MEDIAN_NORM: std::ops::RangeInclusive<f64> = 0.9..=1.1;
/// The norm of one row: outliers are the diagnosis' business, nonsense is not.
const ROW_NORM: std::ops::RangeInclusive<f64> = 0.5..=1.5;

/// Reads header and rows.
pub(crate) fn read_rows(source: &SourceText, least: usize) -> Result<Record, Error> {
    let mut lines = lines(source.text());
    let first = lines.next().unwrap_or(0..0);
    let header = Header::parse(source, first.clone())?;
    let mut record = Record {
        temperature_c: header.temperature.map(|_| Vec::new()),
        ..Record::default()
    };
    let mut places = Vec::new();
    let mut fields = Vec::with_capacity(header.fields);
    for line in lines {
        fields.clear();
        fields.extend(split_fields(source.text(), line.clone()));
        push_row(&mut record, source, &header, &line, &fields)?;
        places.push(line);
    }
    if record.len() < least {
        return Err(source.error(
            InputErrorKind::TooFewRows,
            places.last().cloned().unwrap_or(first),
            format!("{} after the header", counted(record.len())),
            format!("at least {}", counted(least)),
            "a record takes as many rows as there are states to estimate, and a day or more \
             to determine them",
        ));
    }
    check_norms(&record, source, &places)?;
    Ok(record)
}

fn counted(rows: usize) -> String {
    let ending = if rows == 1 { "" } else { "s" };
    format!("{rows} row{ending}")
}

/// The places of the lines that have something in them, without their line ends.
fn lines(text: &str) -> impl Iterator<Item = Range<usize>> {
    let mut start = 0;
    text.split_inclusive('\n').filter_map(move |line| {
        let content = line.trim_end();
        let place = start..start + content.len();
        start += line.len();
        (!content.trim_start().is_empty()).then_some(place)
    })
}

fn push_row(
    record: &mut Record,
    source: &SourceText,
    header: &Header,
    line: &Range<usize>,
    fields: &[(Range<usize>, &str)],
) -> Result<(), Error> {
    if fields.len() != header.fields {
        return Err(source.error(
            InputErrorKind::FieldCount,
            line.clone(),
            format!("{} fields", fields.len()),
            format!("{} fields, as the header has", header.fields),
            "a missing accelerometer value is written `nan`; decimal numbers have a point",
        ));
    }
    let number = |field: usize, expected: &str| {
        let (span, text) = &fields[field];
        text.parse::<f64>()
            .ok()
            .filter(|number| !number.is_infinite())
            .ok_or_else(|| not_a_number(source, span.clone(), text, expected))
    };
    let finite = |field: usize| {
        let number = number(field, "a finite number")?;
        if number.is_nan() {
            let (span, text) = &fields[field];
            return Err(not_a_number(source, span.clone(), text, "a finite number"));
        }
        Ok(number)
    };
    let time_s = finite(header.time)?;
    if let Some(last) = record.time_s.last().filter(|last| time_s <= **last) {
        return Err(source.error(
            InputErrorKind::Time,
            fields[header.time].0.clone(),
            format!("time {time_s} s after {last} s"),
            format!("a time greater than {last} s"),
            "sort the rows by time and keep one of those that repeat",
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

fn not_a_number(source: &SourceText, span: Range<usize>, text: &str, expected: &str) -> Error {
    let found = quoted(text);
    source.error(InputErrorKind::NotANumber, span, found, expected, "")
}

fn check_norms(record: &Record, source: &SourceText, places: &[Range<usize>]) -> Result<(), Error> {
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
    let Some((row, norm)) = norms.iter().find(|(_, norm)| !allowed.contains(norm)) else {
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

/// What unit a record is in whose norm at rest is this.
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
