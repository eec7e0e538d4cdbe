//! Selected columns of the file of a log, by name.

use core::ops::Range;
use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText};

use crate::binary_file::read_binary;
use crate::cell::{Cell, Wanted};
use crate::error::{InstrumentError, Unfit};
use crate::file_format::{Binary, FileFormat, Only};
use crate::log_lines::log_lines;
use crate::remedy;
use crate::row_time::RowTime;
use crate::selection::Selection;
use crate::typed_file::TypedFile;

/// Columns of a text file.
#[derive(Debug, Clone, PartialEq)]
pub struct Columns {
    /// The values of each column, all finite.
    pub values: Vec<Vec<f64>>,
    /// Place of each row in the text of the file.
    pub places: Vec<Range<usize>>,
}

/// Reads the columns `names`, in that order, from text with a header row, separated by commas.
///
/// # Errors
///
/// As [`read_described`].
pub fn read_columns(source: &SourceText, names: &[&str]) -> Result<Columns, Error> {
    read_described(source, &FileFormat::default(), names)
}

/// Reads the columns `names`, in that order, from text of a format. A preamble in front of the header is
/// passed over.
///
/// # Errors
///
/// [`Error::Input`], at its place, for a column that is absent or double, a row with more or
/// fewer fields than the header, a field that is not a finite number, or a file without rows.
pub fn read_described(
    source: &SourceText,
    format: &FileFormat,
    names: &[&str],
) -> Result<Columns, Error> {
    let all = Wanted {
        names,
        sparse: 0..0,
    };
    read_timed(source, format, &all, None)
}

/// As [`read_described`], and behind the columns the time of each row \[s\] if it has columns.
pub(crate) fn read_timed(
    source: &SourceText,
    format: &FileFormat,
    wanted: &Wanted<'_>,
    mut time: Option<RowTime<'_>>,
) -> Result<Columns, Error> {
    let names = wanted.names;
    let mut lines = log_lines(source, format).peekable();
    let mut all = names.to_vec();
    all.extend(time.iter().flat_map(RowTime::names));
    let mut selection = Selection::find(source, format, &all, &mut lines)?;
    let indices = selection.indices.clone();
    let (sensors, times) = indices.split_at(names.len());
    let mut values = vec![Vec::new(); all.len().min(names.len() + 1)];
    let mut places: Vec<Range<usize>> = Vec::new();
    for line in lines {
        if !selection.takes(source, format, &line)? {
            continue;
        }
        for (at, (column, &index)) in values.iter_mut().zip(sensors).enumerate() {
            let field = &line.fields[index];
            let number = match wanted.sparse.contains(&at) {
                true => number_or_none(source, format, field, places.len()),
                false => number(source, format, field),
            };
            column.push(
                number.map_err(|error| selection.or_second_header(source, format, &line, error))?,
            );
        }
        if let (Some(column), Some(time)) = (values.get_mut(names.len()), &mut time) {
            let cells = line.cells(times);
            let time_s = time.of(&cells, places.len());
            column.push(time_s.map_err(|fault| {
                let error = line.error(source, times, fault);
                selection.or_second_header(source, format, &line, error)
            })?);
        }
        places.push(line.span);
    }
    if places.is_empty() {
        return Err(selection.no_rows(source, format));
    }
    Ok(Columns { values, places })
}

/// Columns of a file, with the text that errors can point into; binary files have none.
#[derive(Debug)]
pub(crate) struct FileColumns {
    pub(crate) values: Vec<Vec<f64>>,
    pub(crate) text: Option<(SourceText, Vec<Range<usize>>)>,
}

impl FileColumns {
    /// An error of a row: at its place in a text, by its number in a binary file. The words say what was
    /// found, what was expected and what to do.
    pub(crate) fn error_at(
        &self,
        row: usize,
        kind: InputErrorKind,
        unfit: Unfit,
        [found, expected, advice]: [&str; 3],
    ) -> InstrumentError {
        match &self.text {
            Some((source, places)) => source
                .error(kind, places[row].clone(), found, expected, advice)
                .into(),
            None => InstrumentError::unfit(
                unfit,
                format!("{found} in record {}", row + 1),
                expected,
                advice,
            ),
        }
    }

    /// Reads columns of a file of any format, and behind them the time of each row \[s\] if it has columns.
    pub(crate) fn read(
        path: &Path,
        format: &FileFormat,
        wanted: &Wanted<'_>,
        time: RowTime<'_>,
    ) -> Result<Self, InstrumentError> {
        let values = match (&format.binary, TypedFile::of(path)?) {
            (Some(binary), _) => {
                read_binary_timed(path, (binary, format.only.as_ref()), wanted.names, time)?
            }
            (None, Some(typed)) => typed.columns(path, format, wanted, time)?,
            (None, None) => return Self::of_text(format.read(path)?, format, wanted, time),
        };
        Ok(Self { values, text: None })
    }

    pub(crate) fn of_text(
        source: SourceText,
        format: &FileFormat,
        wanted: &Wanted<'_>,
        time: RowTime<'_>,
    ) -> Result<Self, InstrumentError> {
        let Columns { values, places } = read_timed(&source, format, wanted, Some(time))?;
        Ok(Self {
            values,
            text: Some((source, places)),
        })
    }
}

/// The columns `names` of binary records, and behind them the times.
fn read_binary_timed(
    path: &Path,
    (binary, only): (&Binary, Option<&Only>),
    names: &[&str],
    mut time: RowTime<'_>,
) -> Result<Vec<Vec<f64>>, InstrumentError> {
    let of_time: Vec<&str> = time.names().collect();
    let mut values = read_binary(path, binary, only, &[names, &of_time].concat())?;
    let stamps = values.split_off(names.len());
    let Some(first) = stamps.first() else {
        return Ok(values);
    };
    let time_s = (0..first.len()).map(|row| {
        let cells: Vec<Cell<'_>> = stamps.iter().map(|one| Cell::Number(one[row])).collect();
        let time_s = time.of(&cells, row);
        time_s.map_err(|fault| fault.in_row(&of_time, &cells, row))
    });
    let time_s = time_s.collect::<Result<Vec<f64>, InstrumentError>>()?;
    values.push(time_s);
    Ok(values)
}

/// The number of a slower sensor in a row, counted from 0; `NaN` if it is missing.
fn number_or_none(
    source: &SourceText,
    format: &FileFormat,
    field: &(Range<usize>, &str),
    row: usize,
) -> Result<f64, Error> {
    let (span, text) = field;
    if format.is_missing(text) {
        return Ok(f64::NAN);
    }
    let number = format.decimal.number(text);
    number.filter(|value| !value.is_infinite()).ok_or_else(|| {
        source.error(
            InputErrorKind::NotANumber,
            span.clone(),
            format!("`{}`", &source.text()[span.clone()]),
            "a finite number, or an empty field for a missing one",
            remedy::of_value(format, text, row).unwrap_or_default(),
        )
    })
}

fn number(
    source: &SourceText,
    format: &FileFormat,
    (span, text): &(Range<usize>, &str),
) -> Result<f64, Error> {
    let number = format.decimal.number(text);
    number.filter(|value| value.is_finite()).ok_or_else(|| {
        source.error(
            InputErrorKind::NotANumber,
            span.clone(),
            format!("`{}`", &source.text()[span.clone()]),
            "a finite number",
            remedy::of_number(format, text).unwrap_or_else(|| {
                "cut the log before the first sample that is missing".to_owned()
            }),
        )
    })
}
