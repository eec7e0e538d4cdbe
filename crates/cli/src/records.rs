//! Records as they stand in their files, and tables of results.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_calibration::shared_rows;
use gyrocal_instruments::{Description, read_any};
use gyrocal_record::{Record, RecordFile, printable_path};
use gyrocal_words::counted;
use miette::miette;

use crate::measured::unusable;
use crate::{Failure, terminal};

/// The map of records in other formats.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct Map {
    /// Map of records with other columns, units or separators (TOML); docs/formats.md has every key.
    #[arg(long, value_name = "MAP.toml")]
    columns: Option<PathBuf>,
}

impl Map {
    /// Its file, if there is one.
    pub(crate) fn path(&self) -> Option<&Path> {
        self.columns.as_deref()
    }

    /// Reads a record; warns of a last line that seems cut off.
    pub(crate) fn read(&self, path: &Path) -> Result<RecordFile, Failure> {
        let description = self.path().map(Description::read).transpose()?;
        let file = read_any(path, description.as_ref()).map_err(|error| unusable(path, error))?;
        if let Some(note) = file.cut_note() {
            terminal::warn(&note);
        }
        Ok(file)
    }
}

/// Refuses a number of bench files that is neither one nor that of the records.
pub(crate) fn check_benches(benches: usize, records: usize) -> Result<(), Failure> {
    if benches == 1 || benches == records {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{benches} bench files for {}: give --bench once for all records, or once for each in their order",
        counted(records, "record")
    )))
}

/// Refuses records of which two have rows in common: each row counts once.
pub(crate) fn refuse_shared_rows(records: &[(&Path, &Record)]) -> Result<(), Failure> {
    for (index, (path, record)) in records.iter().enumerate() {
        for (earlier_path, earlier) in &records[..index] {
            let Some(shared) = shared_rows(earlier, record) else {
                continue;
            };
            return Err(Failure::Work(miette!(
                help = "leave one of them out, or cut the rows that both have from one",
                "{}: found {} consecutive rows that {} has too, from row {} of the data (t = {} s) on, \
                 expected rows of its own: they would count twice",
                printable_path(path),
                shared.rows,
                printable_path(earlier_path),
                shared.first + 1,
                record.time_s[shared.first],
            )));
        }
    }
    Ok(())
}
