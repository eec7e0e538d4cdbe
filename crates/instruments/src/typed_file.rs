//! Files whose columns have types: Parquet, MATLAB, MCAP. They are known by their first bytes.

use std::io::Read;
use std::path::Path;

use gyrocal_record::{Record, open_content};

use crate::cell::{Cell, TakeCells, Wanted, unfit};
use crate::description::Description;
use crate::error::InstrumentError;
use crate::file_format::{FileFormat, Only};
use crate::matlab_file;
use crate::platform_row::{PlatformRow, Row};
use crate::row_time::RowTime;

/// First bytes of a file of Parquet and of MCAP.
const PARQUET: &[u8] = b"PAR1";
const MCAP: &[u8] = b"\x89MCAP0\r\n";

/// Kind of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TypedFile {
    Parquet,
    Matlab,
    Mcap,
}

impl TypedFile {
    /// The kind of a file; `None` of text and of binary records.
    pub(crate) fn of(path: &Path) -> Result<Option<Self>, InstrumentError> {
        let mut first = Vec::new();
        let opened = open_content(path)?;
        // What cannot be decompressed is told by the reader of text.
        let _ = opened
            .take(matlab_file::HEADER as u64)
            .read_to_end(&mut first);
        if first.starts_with(PARQUET) {
            return Ok(Some(Self::Parquet));
        }
        if first.starts_with(MCAP) {
            return Ok(Some(Self::Mcap));
        }
        Ok(matlab_file::is_one(&first).then_some(Self::Matlab))
    }

    /// Hands each row of the record of a stable platform to `take`.
    pub(crate) fn for_each_row(
        self,
        path: &Path,
        description: &Description,
        mut take: impl FnMut(Row) -> Result<(), InstrumentError>,
    ) -> Result<(), InstrumentError> {
        let mut platform_row = PlatformRow::new(description)?;
        let names = platform_row.names().to_vec();
        let only = description.file.only.as_ref();
        let mut number = 0;
        self.for_each(path, &names, only, &mut |cells| {
            let row = platform_row
                .of(cells, number)
                .map_err(|fault| fault.in_row(&names, cells, number))?;
            number += 1;
            take(row)
        })
    }

    /// The record of a stable platform, as its values stand.
    pub(crate) fn record(
        self,
        path: &Path,
        description: &Description,
    ) -> Result<Record, InstrumentError> {
        let mut record = Record::default();
        self.for_each_row(path, description, |row| {
            row.push_to(&mut record);
            Ok(())
        })?;
        match record.is_empty() {
            true => Err(no_rows()),
            false => Ok(record),
        }
    }

    /// Some columns, all numbers finite but those that may be missing, and behind them the time of each row \[s\] if it
    /// has columns.
    pub(crate) fn columns(
        self,
        path: &Path,
        format: &FileFormat,
        wanted: &Wanted<'_>,
        mut time: RowTime<'_>,
    ) -> Result<Vec<Vec<f64>>, InstrumentError> {
        let names = wanted.names;
        let mut all = names.to_vec();
        all.extend(time.names());
        let mut values = vec![Vec::new(); all.len().min(names.len() + 1)];
        let mut row = 0;
        self.for_each(path, &all, format.only.as_ref(), &mut |cells| {
            let (cells, times) = cells.split_at(names.len());
            for (at, (column, cell)) in values.iter_mut().zip(cells).enumerate() {
                let is_sparse = wanted.sparse.contains(&at);
                let number = match cell {
                    Cell::Text(text) if is_sparse && format.is_missing(text) => Some(f64::NAN),
                    Cell::Text(text) => format.decimal.number(text),
                    Cell::Number(value) => Some(*value),
                    Cell::Seconds(seconds) => Some(*seconds),
                    Cell::Missing => is_sparse.then_some(f64::NAN),
                };
                let is_one = |value: &f64| value.is_finite() || is_sparse && value.is_nan();
                let Some(number) = number.filter(is_one) else {
                    return Err(unfit(
                        &format!("{cell} in the column `{}` of row {}", names[at], row + 1),
                        "a finite number",
                        "cut the log before the first sample that is missing",
                    ));
                };
                column.push(number);
            }
            if let Some(column) = values.get_mut(names.len()) {
                let time_s = time.of(times, row);
                column.push(time_s.map_err(|fault| fault.in_row(&all[names.len()..], times, row))?);
            }
            row += 1;
            Ok(())
        })?;
        match values.first().is_none_or(Vec::is_empty) {
            true => Err(no_rows()),
            false => Ok(values),
        }
    }

    /// Whether it has these columns together, and a row.
    pub(crate) fn has(self, path: &Path, names: &[&str]) -> bool {
        let mut seen = false;
        // What is wrong with the file is told when it is read.
        let _ = self.read(path, names, &mut |_| {
            seen = true;
            Err(no_rows())
        });
        seen
    }

    /// Hands the cells of the columns `names` of each row to `take`, of one sensor if `only` names it.
    fn for_each(
        self,
        path: &Path,
        names: &[&str],
        only: Option<&Only>,
        take: &mut TakeCells<'_>,
    ) -> Result<(), InstrumentError> {
        let Some(only) = only else {
            return self.read(path, names, take);
        };
        let mut with_sensor = names.to_vec();
        with_sensor.push(&only.column);
        self.read(path, &with_sensor, &mut |cells| match cells.split_last() {
            Some((sensor, cells)) if sensor.is(&only.equals) => take(cells),
            _ => Ok(()),
        })
    }

    fn read(
        self,
        path: &Path,
        names: &[&str],
        take: &mut TakeCells<'_>,
    ) -> Result<(), InstrumentError> {
        match self {
            #[cfg(feature = "parquet")]
            Self::Parquet => crate::parquet_file::read(path, names, take),
            #[cfg(not(feature = "parquet"))]
            Self::Parquet => Err(not_built_in("Parquet", "parquet")),
            Self::Matlab => matlab_file::read(path, names, take),
            #[cfg(feature = "mcap")]
            Self::Mcap => crate::mcap_file::read(path, names, take),
            #[cfg(not(feature = "mcap"))]
            Self::Mcap => Err(not_built_in("MCAP", "mcap")),
        }
    }
}

fn no_rows() -> InstrumentError {
    unfit(
        "no rows",
        "samples",
        "check the program that wrote it, and `only` of the map",
    )
}

#[cfg(not(all(feature = "parquet", feature = "mcap")))]
fn not_built_in(what: &str, feature: &str) -> InstrumentError {
    unfit(
        &format!("a file of {what}"),
        &format!("text, as this program was built without {what}"),
        &format!(
            "in a clone of its repository `cargo install --locked --path crates/cli --features {feature}` builds it with \
             {what}; or write the log as CSV"
        ),
    )
}
