//! Records as they stand in their files, and tables of results.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_calibration::{Options, shared_rows};
use gyrocal_diagnosis::{Gate, RecordToDiagnose};
use gyrocal_instruments::{Description, read_any};
use gyrocal_record::{Bench, InputRole, Record, RecordFile, printable_path};
use gyrocal_words::counted;
use miette::miette;

use crate::measured::unusable;
use crate::{Failure, gyro_axes, terminal};

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

    /// The same as an input of a command.
    pub(crate) fn input(&self) -> Option<(InputRole, &Path)> {
        self.path().map(|path| (InputRole::Columns, path))
    }

    /// The map, if there is one.
    pub(crate) fn description(&self) -> Result<Option<Description>, Failure> {
        Ok(self.path().map(Description::read).transpose()?)
    }

    /// Reads a record; warns of rows that were left out and of a last line that seems cut off.
    pub(crate) fn read(&self, path: &Path) -> Result<RecordFile, Failure> {
        let description = self.description()?;
        let file = read_any(path, description.as_ref()).map_err(|error| unusable(path, error))?;
        file.notes().iter().for_each(|note| terminal::warn(note));
        Ok(file)
    }
}

/// Files with their role.
pub(crate) fn with_role<'a>(
    role: InputRole,
    paths: impl IntoIterator<Item = &'a PathBuf>,
) -> impl Iterator<Item = (InputRole, &'a Path)> {
    let paths = paths.into_iter();
    paths.map(move |path| (role, path.as_path()))
}

/// Records of one platform with their bench files, one for all records or one for each, axes of their
/// instruments and map of columns.
#[derive(Clone, Copy)]
pub(crate) struct Given<'a> {
    pub(crate) records: &'a [PathBuf],
    pub(crate) benches: &'a [PathBuf],
    pub(crate) axes: &'a [PathBuf],
    pub(crate) map: &'a Map,
}

impl<'a> Given<'a> {
    /// Refuses other numbers of bench files and axes than those of the records.
    pub(crate) fn check(self) -> Result<(), Failure> {
        check_benches(self.benches.len(), self.records.len())?;
        gyro_axes::check(self.axes, self.records.len())
    }

    /// Each record with its bench file.
    pub(crate) fn pairs(self) -> impl Iterator<Item = (&'a PathBuf, &'a PathBuf)> {
        self.records.iter().zip(self.benches.iter().cycle())
    }

    /// The same one after the other.
    pub(crate) fn inputs(self) -> Vec<(InputRole, &'a Path)> {
        let pairs = self.pairs();
        pairs
            .flat_map(|(record, bench)| {
                [(InputRole::Record, &**record), (InputRole::Bench, &**bench)]
            })
            .collect()
    }

    /// Reads each record with its bench file.
    pub(crate) fn read(self) -> Result<(Vec<RecordFile>, Vec<Bench>), Failure> {
        let benches = self.pairs().map(|(_, bench)| Bench::read(bench));
        let benches = benches.collect::<Result<_, _>>()?;
        let files = self.records.iter().map(|path| self.map.read(path));
        Ok((files.collect::<Result<_, _>>()?, benches))
    }

    /// Each record with its axes, its set-up checked; refuses two that share rows.
    pub(crate) fn checked<'b>(
        self,
        files: &'b [RecordFile],
        benches: &'b [Bench],
        options: &Options,
    ) -> Result<Vec<RecordToDiagnose<'b>>, Failure> {
        let records = || files.iter().map(RecordFile::record);
        let paths = self.records.iter().map(PathBuf::as_path);
        refuse_shared_rows(&paths.zip(records()).collect::<Vec<_>>())?;
        let kind = gyro_axes::kind(self.axes);
        let mut axes = gyro_axes::read(self.axes, records())?.into_iter();
        let all = self.records.iter().zip(files).zip(benches);
        let checked = all.map(|((path, file), bench)| {
            let gate = Gate::of_file(kind, file, bench, options)?;
            Ok(RecordToDiagnose {
                name: printable_path(path),
                gate: gate.with_gyro_axes(axes.next()),
                bench,
            })
        });
        checked.collect()
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
