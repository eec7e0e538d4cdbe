//! Reads the rows of a record.

use std::ops::Range;
use std::path::Path;

use crate::clock::{ClockFault, leave_out_repeated};
use crate::error::{Error, InputErrorKind};
use crate::fields::{Field, Line, Lines};
use crate::header::Header;
use crate::plausible::{Codes, check_norms, refuse_too_few};
use crate::record::Record;
use crate::source::{SourceText, quoted};

impl Record {
    /// Longest record, s: a hundred years. Longer ones are mistakes in the unit of time, and take long
    /// to integrate.
    pub const LONGEST_S: f64 = 3.16e9;

    /// Reads a record.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] for a fault in it.
    pub fn read(path: &Path) -> Result<Self, Error> {
        read_strictly(&SourceText::read(path)?)
    }

    /// Parses the text of a record; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        read_strictly(&SourceText::new(text, name)?)
    }
}

fn read_strictly(source: &SourceText) -> Result<Record, Error> {
    let (mut record, mut places, header) = parse(source, Form::Strict)?;
    leave_out_repeated(&mut record, &mut places);
    check_times(&record, source, &places)?;
    refuse_too_few(&record, source, places.last().unwrap_or(&header), 1)?;
    check_norms(&record, source, &places, Codes::Refused)?;
    Ok(record)
}

/// How much of the format a reader insists on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    /// Times rise, and every field holds a number.
    Strict,
    /// Times are any numbers, and an accelerometer's empty field is a missing value: the check of the
    /// set-up tells what is wrong with them.
    Lenient,
}

/// A record with the places of its rows, and that of its header.
pub(crate) type Placed = (Record, Vec<Range<usize>>, Range<usize>);

/// Reads all rows.
pub(crate) fn parse(source: &SourceText, form: Form) -> Result<Placed, Error> {
    let mut lines = Lines::of(source);
    let first = lines.next_line()?.unwrap_or_default();
    let header = Header::parse(source, &first)?;
    let mut record = Record {
        temperature_c: header.temperature.map(|_| Vec::new()),
        ..Record::default()
    };
    let mut places = Vec::new();
    while let Some(line) = lines.next_line()? {
        push_row(&mut record, source, &header, &line, form)?;
        places.push(line.span);
    }
    Ok((record, places, first.span))
}

fn push_row(
    record: &mut Record,
    source: &SourceText,
    header: &Header,
    line: &Line<'_>,
    form: Form,
) -> Result<(), Error> {
    let fields = &line.fields;
    let is_cut = || source.ends_within_line(&line.span);
    let ends_empty = || fields.last().is_some_and(|field| field.text.is_empty());
    if fields.len() != header.fields || (ends_empty() && is_cut()) {
        let (found, advice) = if fields.len() <= header.fields && is_cut() {
            ("a last line that is cut off, with", CUT_ADVICE)
        } else {
            (
                "",
                "a missing accelerometer value is written `nan`; decimal numbers have a point",
            )
        };
        return Err(source.error(
            InputErrorKind::FieldCount,
            line.span.clone(),
            format!("{found} {} fields", fields.len()).trim_start(),
            format!("{} fields, as the header has", header.fields),
            advice,
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
    let mut accel_g = [0.0; 3];
    for (component, field) in accel_g.iter_mut().zip(header.accel) {
        *component = if form == Form::Lenient && fields[field].text.trim().is_empty() {
            f64::NAN
        } else {
            number(field, "a finite number or `nan`")?
        };
    }
    if let (Some(column), Some(field)) = (&mut record.temperature_c, header.temperature) {
        column.push(finite(field)?);
    }
    record.time_s.push(time_s);
    record.accel_g.push(accel_g);
    Ok(())
}

/// Advice on a file that ends within a line.
const CUT_ADVICE: &str = "the file ends within this line, as if its writer or a copy was stopped: \
    copy the file again, or delete this line";

/// Refuses times that do not rise, and one that lies ages after the first.
fn check_times(record: &Record, source: &SourceText, places: &[Range<usize>]) -> Result<(), Error> {
    let error = |row: usize, found: String, expected: &str, advice: &str| {
        let place = places.get(row).cloned().unwrap_or(0..0);
        Err(source.error(InputErrorKind::Time, place, found, expected, advice))
    };
    if let Some(fault) = ClockFault::of(&record.time_s, source.name()) {
        return error(fault.row, fault.found, "times that rise", &fault.advice);
    }
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let is_late = |time_s: &f64| time_s - first_s > Record::LONGEST_S;
    match record.time_s.iter().position(is_late) {
        Some(row) => error(
            row,
            format!(
                "time {:?} s in a record that starts at {first_s:?} s",
                record.time_s[row]
            ),
            "a record of at most a hundred years",
            "time_s is in seconds: divide milliseconds by 1e3, nanoseconds by 1e9",
        ),
        None => Ok(()),
    }
}

fn not_a_number(source: &SourceText, field: &Field<'_>, expected: &str) -> Error {
    let found = quoted(field.text);
    let span = field.span.clone();
    let advice = if source.ends_within_line(&span) {
        CUT_ADVICE
    } else {
        ""
    };
    source.error(InputErrorKind::NotANumber, span, found, expected, advice)
}
