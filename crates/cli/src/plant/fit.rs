//! `gyrocal plant fit` and `gyrocal plant compare`, and `fit` of a package for one plant.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_instruments::ResultFile;
use gyrocal_pages::{of_comparison, of_fit};
use gyrocal_plant::description::Description;
use gyrocal_plant::{ColumnMap, LoadedPlant, NamedRecord, PlantError, compare, fit};
use gyrocal_record::printable_path;
use serde::Serialize;

use crate::outputs::{self, manifest, refuse_itself};
use crate::progress::Progress;
use crate::{Failure, Reply};

/// Records and outputs of a fit.
#[derive(Debug, Args)]
struct Files {
    /// Columns of the records for time, inputs and outputs (TOML).
    #[arg(long, value_name = "MAP.toml")]
    columns: PathBuf,
    /// A later record of the same plant, which has no part in the fit.
    #[arg(long, value_name = "LATER.csv")]
    later: Option<PathBuf>,
    /// Rows at the beginning of each record that errors do not count. Those of a later record tell its initial states.
    #[arg(long, value_name = "N", default_value_t = 0)]
    first_rows: usize,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// Fit this plant to a record.
#[derive(Debug, Args)]
pub(super) struct FitArguments {
    /// The record (CSV), with a header.
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    #[command(flatten)]
    files: Files,
}

/// Compare plants on one record: errors, likelihood, AIC and BIC of each, in one table.
///
/// Errors are open-loop ones. Those of a later record are held out; without one, those of four parts of the record,
/// each left out of the fit in its turn.
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// The plants, two or more, with the same inputs and outputs; then the record (CSV).
    #[arg(value_name = "PLANT.json PLANT.json RECORD.csv", required = true, num_args = 3..)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    files: Files,
}

impl Files {
    /// Refuses outputs that would overwrite inputs, which are returned with these.
    fn checked<'a>(&'a self, inputs: &[&'a Path]) -> Result<Vec<&'a Path>, Failure> {
        let mut inputs = inputs.to_vec();
        inputs.push(&self.columns);
        inputs.extend(self.later.as_deref());
        outputs::check(&inputs, self.json.as_deref(), None)?;
        Ok(inputs)
    }

    /// The record, and the later one.
    fn read(
        &self,
        description: &Description,
        record: &Path,
    ) -> Result<(NamedRecord, Option<NamedRecord>), PlantError> {
        let columns = ColumnMap::read(&self.columns)?;
        let named = |path: &Path| {
            Ok::<_, PlantError>(NamedRecord {
                name: printable_path(path),
                record: columns.record(description, path)?,
            })
        };
        let later = self.later.as_deref().map(named).transpose()?;
        Ok((named(record)?, later))
    }

    fn shown(&self, mut shown: Reply, file: &impl Serialize) -> Result<Reply, Failure> {
        shown.write_json(self.json.as_deref(), file)?;
        Ok(shown)
    }
}

/// Runs `fit`; `file` is that of the plant, if it is read from one.
pub(super) fn run(
    file: Option<&Path>,
    arguments: &FitArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    let FitArguments { record, files } = arguments;
    let own: Vec<&Path> = [Some(record.as_path()), file]
        .into_iter()
        .flatten()
        .collect();
    let inputs = files.checked(&own)?;
    refuse_itself(
        "--later",
        files.later.as_deref(),
        std::slice::from_ref(record),
    )?;
    let plant = plant()?;
    let (record, later) = files.read(plant.description(), record)?;
    let mut progress = Progress::waiting("fitting", record.record.len());
    let at = &mut |stage: &'static str, share| progress.stage(stage, share);
    let answer = fit(&plant, record, later, files.first_rows, at)?.answer;
    drop(progress);
    let manifest = manifest("", 0, &inputs)?;
    let shown = Reply::of_part(&of_fit(&answer, &manifest));
    files.shown(shown, &ResultFile::new(manifest, &answer))
}

/// Runs `compare`.
pub(super) fn run_compare(arguments: &CompareArguments) -> Result<Reply, Failure> {
    let CompareArguments { paths, files } = arguments;
    let own: Vec<&Path> = paths.iter().map(PathBuf::as_path).collect();
    let inputs = files.checked(&own)?;
    let Some((record, plants)) = paths.split_last() else {
        return Err(Failure::Usage("give plants and a record".to_owned()));
    };
    refuse_itself(
        "--later",
        files.later.as_deref(),
        std::slice::from_ref(record),
    )?;
    let plants = plants
        .iter()
        .map(|path| Ok((printable_path(path), LoadedPlant::read(path)?)));
    let plants: Vec<(String, LoadedPlant)> = plants.collect::<Result<_, PlantError>>()?;
    let mut progress = Progress::waiting("comparing", plants.len());
    let at = &mut |stage: &'static str, share| progress.stage(stage, share);
    let read = |description: &Description| files.read(description, record);
    let compared = compare(&plants, read, files.first_rows, at)?;
    drop(progress);
    let manifest = manifest("", 0, &inputs)?;
    let shown = Reply::of_part(&of_comparison(&compared, &manifest));
    files.shown(shown, &ResultFile::new(manifest, &compared))
}
