//! `gyrocal plant fit` and `gyrocal plant compare`, and `fit` of a package for one plant.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_instruments::ResultFile;
use gyrocal_pages::{Part, of_comparison, of_fit};
use gyrocal_plant::description::Description;
use gyrocal_plant::{ColumnMap, LoadedPlant, NamedRecord, PlantError, RecordText, compare, fit};
use gyrocal_record::{Manifest, printable_path};
use serde::Serialize;

use crate::outputs::{self, manifest, refuse_itself};
use crate::progress::Progress;
use crate::{Failure, Reply, terminal};

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
    #[arg(value_names = ["PLANT.json", "PLANT.json", "RECORD.csv"], required = true, num_args = 3..)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    files: Files,
}

impl Files {
    /// The files that are read, the record first.
    fn checked<'a>(
        &'a self,
        record: &'a PathBuf,
        plants: impl Iterator<Item = &'a Path>,
    ) -> Result<Vec<&'a Path>, Failure> {
        let later = self.later.as_deref();
        let inputs = [record.as_path(), &self.columns].into_iter();
        let inputs: Vec<&Path> = inputs.chain(later).chain(plants).collect();
        outputs::check(&inputs, self.json.as_deref())?;
        refuse_itself("--later", later, std::slice::from_ref(record))?;
        Ok(inputs)
    }

    /// The content of the record, and of the later one.
    fn read(&self, record: &Path) -> Result<Content, PlantError> {
        Ok(Content {
            columns: ColumnMap::read(&self.columns)?,
            record: RecordText::read(record)?,
            later: self.later.as_deref().map(RecordText::read).transpose()?,
        })
    }

    /// Does the work, and shows and writes its answer.
    fn answered<T: Serialize>(
        &self,
        (model_hash, inputs): (&str, &[&Path]),
        work: impl FnOnce(&mut dyn FnMut(&'static str, f64)) -> Result<T, PlantError>,
        page: impl FnOnce(&T, &Manifest) -> Part,
    ) -> Result<Reply, Failure> {
        let mut progress = Progress::waiting("fitting", 0);
        let answer = work(&mut |stage, share| progress.stage(stage, share))?;
        drop(progress);
        let manifest = manifest(model_hash, 0, inputs)?;
        let mut shown = Reply::of_part(&page(&answer, &manifest));
        shown.write_json(self.json.as_deref(), &ResultFile::new(manifest, &answer))?;
        Ok(shown)
    }
}

/// What is read once for any number of plants.
struct Content {
    columns: ColumnMap,
    record: RecordText,
    later: Option<RecordText>,
}

impl Content {
    /// The record, and the later one, for a plant.
    fn records(
        &self,
        description: &Description,
    ) -> Result<(NamedRecord, Option<NamedRecord>), PlantError> {
        let named = |text| self.columns.record_of(description, text);
        let record = named(&self.record)?;
        let later = self.later.as_ref().map(named).transpose()?;
        Ok((record, later))
    }

    /// Warns of inputs that the records do not tell for a while; of what only some plants make of a gap with their names.
    /// A plant that the records do not fit is refused where it is fitted.
    fn warn_of_gaps(&self, plants: &[(String, &Description)]) {
        let mut told: Vec<(String, Vec<&str>)> = Vec::new();
        for (name, description) in plants {
            let records = self.records(description).into_iter();
            let records = records.flat_map(|(record, later)| [record].into_iter().chain(later));
            for note in records.flat_map(|one| self.columns.bridged(description, &one)) {
                match told.iter_mut().find(|(other, _)| *other == note) {
                    Some((_, names)) => names.push(name),
                    None => told.push((note, vec![name])),
                }
            }
        }
        for (note, names) in told {
            match names.len() == plants.len() {
                true => terminal::warn(&note),
                false => terminal::warn(&format!("{}: {note}", names.join(", "))),
            }
        }
    }
}

/// Runs `fit`; `file` is that of the plant, if it is read from one.
pub(super) fn run(
    file: Option<&Path>,
    FitArguments { record, files }: &FitArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    let inputs = files.checked(record, file.into_iter())?;
    let plant = plant()?;
    let content = files.read(record)?;
    content.warn_of_gaps(&[(String::new(), plant.description())]);
    let (record, later) = content.records(plant.description())?;
    let work = |at: &mut dyn FnMut(&'static str, f64)| {
        fit(&plant, record, later, files.first_rows, at).map(|fit| fit.answer)
    };
    files.answered((plant.hash(), &inputs), work, of_fit)
}

/// Runs `compare`.
pub(super) fn run_compare(
    CompareArguments { paths, files }: &CompareArguments,
) -> Result<Reply, Failure> {
    let Some((record, plants)) = paths.split_last() else {
        return Err(Failure::Usage("give plants and a record".to_owned()));
    };
    let inputs = files.checked(record, plants.iter().map(PathBuf::as_path))?;
    let plants = plants.iter();
    let plants = plants.map(|path| Ok((printable_path(path), LoadedPlant::read(path)?)));
    let plants: Vec<(String, LoadedPlant)> = plants.collect::<Result<_, PlantError>>()?;
    let content = files.read(record)?;
    let described = plants
        .iter()
        .map(|(name, plant)| (name.clone(), plant.description()));
    content.warn_of_gaps(&described.collect::<Vec<_>>());
    let read = |description: &Description| content.records(description);
    let work = |at: &mut dyn FnMut(&'static str, f64)| compare(&plants, read, files.first_rows, at);
    files.answered(("", &inputs), work, of_comparison)
}
