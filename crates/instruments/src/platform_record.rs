//! Records of a stable platform from files of any format that a description describes.

use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, Record, RecordFile, SourceText, shell_quoted};
use gyrocal_statistics::median_interval_s;

use crate::clock::fill;
use crate::description::temperature::TemperatureUnit;
use crate::description::{Description, Jitter, Temperature};
use crate::error::InstrumentError;
use crate::file_format::FileFormat;
use crate::log_lines::{LogLine, log_lines};
use crate::platform_row::{PlatformRow, Row};
use crate::selection::Selection;
use crate::typed_file::TypedFile;

/// Intervals longer than this many median ones are gaps, which are not interpolated.
const GAP: f64 = 1.5;

/// The column of the temperature in a record.
const TEMPERATURE: &str = "temperature_c";

/// Reads the record of a stable platform from a file of a described format: time, three accelerometers and
/// the temperature, if there is one. Values are as they stand, as of [`RecordFile::read`]; a check of the
/// set-up follows.
///
/// # Errors
///
/// [`InstrumentError::File`] at its place, with the line that the description lacks where that is plain.
pub fn read_record(path: &Path, description: &Description) -> Result<RecordFile, InstrumentError> {
    if let Some(typed) = TypedFile::of(path)? {
        let record = finished(typed.record(path, description)?, description);
        return Ok(RecordFile::of_record(record, &path.display().to_string()));
    }
    parse_record(description.file.read(path)?, description)
}

/// Reads the record of a stable platform as [`RecordFile::read`] does, or by a description. Without one a file
/// of Parquet or MATLAB has the columns of a record, and the error of another header names the command that
/// proposes a description.
///
/// # Errors
///
/// As of [`read_record`].
pub fn read_any(
    path: &Path,
    description: Option<&Description>,
) -> Result<RecordFile, InstrumentError> {
    if let Some(description) = description {
        return read_record(path, description);
    }
    if let Some(typed) = TypedFile::of(path)? {
        let mut description = Description::of_records()?;
        description.temperature = Some(Temperature {
            column: TEMPERATURE.to_owned(),
            unit: TemperatureUnit::default(),
        });
        if !typed.has(path, PlatformRow::new(&description)?.names()) {
            description.temperature = None;
        }
        return read_record(path, &description);
    }
    let read = SourceText::read(path).and_then(RecordFile::of);
    read.map_err(|error| match error {
        Error::Input(mut input) if matches!(input.kind, InputErrorKind::Header | InputErrorKind::NotUtf8) => {
            // A name that is nearly right is told first.
            let near = Some(&input.advice).filter(|advice| advice.starts_with("did you mean"));
            let near = near.map_or_else(String::new, |near| format!("{near}; if it is a file of another program, "));
            let path = shell_quoted(&path.display().to_string());
            input.advice = format!(
                "{near}`gyrocal import csv {path} --propose MAP.toml` writes a map of its columns and units; give it with \
                 `--columns MAP.toml`"
            );
            Error::Input(input).into()
        }
        other => other.into(),
    })
}

/// Parses the text of a record.
///
/// # Errors
///
/// As of [`read_record`].
pub fn parse_record(
    source: SourceText,
    description: &Description,
) -> Result<RecordFile, InstrumentError> {
    let mut reader = RowReader::new(description)?;
    let mut record = Record::default();
    let mut places = Vec::new();
    reader.read(&source, |row, line| {
        row.push_to(&mut record);
        places.push(line.span);
        Ok(())
    })?;
    let header = match &reader.selection {
        Some(selection) if record.is_empty() => {
            return Err(selection.no_rows(&source, reader.format()).into());
        }
        Some(selection) => selection.header.clone(),
        None => 0..0,
    };
    let note = reader
        .selection
        .and_then(|selection| selection.repeated_note(source.name()));
    let name = source.name().to_owned();
    let file = match description.time.jitter {
        Jitter::Resample => {
            let read = RecordFile::of_rows(record, source, places, header);
            let even = RecordFile::of_record(finished(read.record().clone(), description), &name);
            read.notes()
                .into_iter()
                .fold(even, |even, note| even.with_note(Some(note)))
        }
        _ => RecordFile::of_rows(finished(record, description), source, places, header),
    };
    Ok(file.with_note(note))
}

/// Rows of the text of a record, which may come in blocks of whole lines.
#[derive(Debug)]
pub(crate) struct RowReader<'a> {
    description: &'a Description,
    row: PlatformRow<'a>,
    selection: Option<Selection>,
    later: FileFormat,
    rows: usize,
}

impl<'a> RowReader<'a> {
    pub(crate) fn new(description: &'a Description) -> Result<Self, InstrumentError> {
        Ok(Self {
            description,
            row: PlatformRow::new(description)?,
            selection: None,
            later: FileFormat {
                skip_lines: 0,
                ..description.file.clone()
            },
            rows: 0,
        })
    }

    fn format(&self) -> &'a FileFormat {
        &self.description.file
    }

    /// Hands each row of the next block to `take`.
    pub(crate) fn read(
        &mut self,
        source: &SourceText,
        mut take: impl FnMut(Row, LogLine<'_>) -> Result<(), InstrumentError>,
    ) -> Result<(), InstrumentError> {
        let format = self.format();
        let first = self.selection.is_none();
        let later = self.later.clone();
        let mut lines = log_lines(source, if first { format } else { &later }).peekable();
        let mut selection = match self.selection.take() {
            Some(selection) => selection,
            None => Selection::find(source, format, self.row.names(), &mut lines)?,
        };
        for line in lines {
            if !selection.takes(source, format, &line)? {
                continue;
            }
            let row = self.row.of(&line.cells(&selection.indices), self.rows);
            let row = row.map_err(|fault| {
                let error = line.error(source, &selection.indices, fault);
                selection.or_second_header(source, format, &line, error)
            })?;
            self.rows += 1;
            take(row, line)?;
        }
        self.selection = Some(selection);
        Ok(())
    }
}

/// The record with temperatures between those logged, and at equal intervals if that is described.
pub(crate) fn finished(mut record: Record, description: &Description) -> Record {
    if let Some(column) = &mut record.temperature_c {
        fill(&record.time_s, column);
        if column.iter().any(|value| value.is_nan()) {
            record.temperature_c = None;
        }
    }
    match description.time.jitter {
        Jitter::Resample => resampled(&record),
        _ => record,
    }
}

/// The record interpolated at equal intervals; within gaps components are missing.
fn resampled(record: &Record) -> Record {
    let interval_s = median_interval_s(&record.time_s);
    let rises = record.time_s.windows(2).all(|pair| pair[0] < pair[1]);
    if !(rises && interval_s > 0.0) {
        // A check of the set-up tells what is wrong with the times.
        return record.clone();
    }
    let first_s = record.time_s[0];
    let count = (record.duration_s() / interval_s + 1e-9) as usize + 1;
    let mut even = Record::default();
    let mut at = 0;
    for sample in 0..count {
        let time_s = first_s + sample as f64 * interval_s;
        while at + 2 < record.len() && record.time_s[at + 1] < time_s {
            at += 1;
        }
        let length_s = record.time_s[at + 1] - record.time_s[at];
        let share = (time_s - record.time_s[at]) / length_s;
        let between = |from: f64, to: f64| match share {
            0.0 => from,
            1.0 => to,
            _ => from + share * (to - from),
        };
        let is_gap = length_s > GAP * interval_s && share > 0.0 && share < 1.0;
        let accel = |axis: usize| match is_gap {
            true => f64::NAN,
            false => between(record.accel_g[at][axis], record.accel_g[at + 1][axis]),
        };
        let row = Row {
            time_s,
            accel_g: [accel(0), accel(1), accel(2)],
            temperature_c: record
                .temperature_c
                .as_ref()
                .map(|column| between(column[at], column[at + 1])),
        };
        row.push_to(&mut even);
    }
    even
}
