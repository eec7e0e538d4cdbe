//! Records as they stand in their files, and tables of results.

use std::path::{Path, PathBuf};

use clap::{ArgAction, Args};
use gyrocal_calibration::{Options, shared_rows};
use gyrocal_diagnosis::{Gate, RecordToDiagnose};
use gyrocal_instruments::{Description, read_any};
use gyrocal_record::{Bench, InputRole, Record, RecordFile, printable_path};
use gyrocal_setup::PlatformKind;
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

/// Records of one platform with their bench files, map of columns and axes of their instruments.
#[derive(Clone, Debug, Args)]
pub(crate) struct Given {
    /// The record (CSV): time_s,accel_x_g,accel_y_g,accel_z_g and maybe temperature_c; or several of one
    /// platform.
    #[arg(value_name = "RECORD.csv", required = true)]
    pub(crate) records: Vec<PathBuf>,
    /// The bench description (TOML), one for all records or one for each, in their order;
    /// examples/data/three_days.bench.toml is one.
    #[arg(long = "bench", value_name = "BENCH.toml", required = true, action = ArgAction::Append)]
    pub(crate) benches: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) map: Map,
    /// Axes of the instruments in the platform at each row (CSV), one file for each record: for platforms
    /// that `import strapdown` computed. Coefficients and effects are then those of gyros and
    /// accelerometers that are fixed to a body, in their own axes.
    #[arg(long, value_name = "AXES.csv", action = ArgAction::Append)]
    pub(crate) gyro_axes: Vec<PathBuf>,
}

impl Given {
    /// The first record.
    pub(crate) fn first(&self) -> &Path {
        &self.records[0]
    }

    /// Kind of the platform.
    pub(crate) fn kind(&self) -> PlatformKind {
        match self.gyro_axes.is_empty() {
            true => PlatformKind::Stabilised,
            false => PlatformKind::Computed,
        }
    }

    /// Refuses other numbers of bench files and axes than those of the records.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        let (benches, records) = (self.benches.len(), self.records.len());
        if benches != 1 && benches != records {
            return Err(Failure::Usage(format!(
                "{benches} bench files for {}: give --bench once for all records, or once for each in their order",
                counted(records, "record")
            )));
        }
        match self.gyro_axes.len() {
            0 => Ok(()),
            axes if axes == records => Ok(()),
            axes => Err(Failure::Usage(format!(
                "{axes} of --gyro-axes for {records} of records: give one for each record, in their order"
            ))),
        }
    }

    /// Each record with its bench file.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (&PathBuf, &PathBuf)> {
        self.records.iter().zip(self.benches.iter().cycle())
    }

    /// The same one after the other, then `between`, axes, `further` files and map.
    pub(crate) fn inputs<'a>(
        &'a self,
        between: impl IntoIterator<Item = (InputRole, &'a Path)>,
        further: impl IntoIterator<Item = (InputRole, &'a Path)>,
    ) -> Vec<(InputRole, &'a Path)> {
        let pairs = self.pairs().flat_map(|(record, bench)| {
            [(InputRole::Record, &**record), (InputRole::Bench, &**bench)]
        });
        let axes = with_role(InputRole::GyroAxes, &self.gyro_axes);
        let all = pairs.chain(between).chain(axes).chain(further);
        all.chain(self.map.input()).collect()
    }

    /// Reads each record with its bench file; refuses benches that contradict each other.
    pub(crate) fn read(&self) -> Result<(Vec<RecordFile>, Vec<Bench>), Failure> {
        let paths = || self.pairs().map(|(_, path)| &**path);
        let benches = paths().map(Bench::read);
        let benches: Vec<Bench> = benches.collect::<Result<_, _>>()?;
        refuse_differing(&paths().zip(&benches).collect::<Vec<_>>())?;
        let files = self.records.iter().map(|path| self.map.read(path));
        Ok((files.collect::<Result<_, _>>()?, benches))
    }

    /// Each record with its axes, its set-up checked; refuses two that share rows.
    pub(crate) fn checked<'a>(
        &self,
        files: &'a [RecordFile],
        benches: &'a [Bench],
        options: &Options,
    ) -> Result<Vec<RecordToDiagnose<'a>>, Failure> {
        let records = || files.iter().map(RecordFile::record);
        let paths = self.records.iter().map(PathBuf::as_path);
        refuse_shared_rows(&paths.zip(records()).collect::<Vec<_>>())?;
        let kind = self.kind();
        let mut axes = gyro_axes::read(&self.gyro_axes, records())?.into_iter();
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

/// Refuses benches with different priors, as the coefficients are shared, and with different
/// uncertainties of one site.
fn refuse_differing(benches: &[(&Path, &Bench)]) -> Result<(), Failure> {
    let differ = |path: &Path, what: &str, other: &Path, advice: &str| {
        Err(Failure::Work(miette!(
            help = advice,
            "{}: found {what} other than in {}, expected the same",
            printable_path(path),
            printable_path(other),
        )))
    };
    for (index, (path, bench)) in benches.iter().enumerate() {
        for (other, earlier) in &benches[..index] {
            if bench.prior != earlier.prior {
                let advice = "the coefficients are those of one platform: give [prior] the same \
                              values in each bench file";
                return differ(path, "a [prior]", other, advice);
            }
            let site = |bench: &Bench| (bench.latitude_deg, bench.gravity);
            if site(bench) == site(earlier) && bench.uncertainty != earlier.uncertainty {
                let advice = "both give the same latitude and gravity: give them the same sigmas";
                let what = "uncertainties of the same site";
                return differ(path, what, other, advice);
            }
        }
    }
    Ok(())
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
