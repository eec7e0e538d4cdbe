//! Files whose columns have types: Parquet, MATLAB, MCAP. They are known by their first bytes.

use std::io::Read;
use std::path::Path;

use gyrocal_record::{Record, open_content};

use crate::cell::{Cell, TakeCells, unfit};
use crate::date_time::seconds_of;
use crate::description::Description;
use crate::error::InstrumentError;
use crate::file_format::{FileFormat, Only};
use crate::matlab_file;
use crate::platform_row::{PlatformRow, Row};

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
        let platform_row = PlatformRow::new(description)?;
        let only = description.file.only.as_ref();
        let mut number = 0;
        self.for_each(path, platform_row.names(), only, &mut |cells| {
            let row = platform_row.of(cells, number).map_err(|fault| {
                let name = platform_row.names()[fault.column];
                let cell = cells[fault.column];
                unfit(
                    &format!("{cell} in the column `{name}` of row {}", number + 1),
                    fault.expected,
                    &fault.advice,
                )
            })?;
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

    /// The columns `names`, all numbers finite. Of dates and times, in the column `dated`, the seconds; of time
    /// stamps their number in units of `unit_s`.
    pub(crate) fn columns(
        self,
        path: &Path,
        format: &FileFormat,
        names: &[&str],
        dated: Option<usize>,
        unit_s: f64,
    ) -> Result<Vec<Vec<f64>>, InstrumentError> {
        let mut values = vec![Vec::new(); names.len()];
        self.for_each(path, names, format.only.as_ref(), &mut |cells| {
            for (at, (column, cell)) in values.iter_mut().zip(cells).enumerate() {
                let number = match cell {
                    Cell::Text(text) if dated == Some(at) => seconds_of(text),
                    Cell::Text(text) => format.decimal.number(text),
                    Cell::Number(value) => Some(*value),
                    Cell::Seconds(seconds) => Some(seconds / unit_s),
                    Cell::Missing => None,
                };
                let Some(number) = number.filter(|value| value.is_finite()) else {
                    let row = column.len() + 1;
                    return Err(unfit(
                        &format!("{cell} in the column `{}` of row {row}", names[at]),
                        "a finite number",
                        "cut the log before the first sample that is missing",
                    ));
                };
                column.push(number);
            }
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
            "build it with `cargo install gyrocal-cli --features {feature}`, or write the log as CSV"
        ),
    )
}
