//! `gyrocal plant simulate`, and `simulate` of a package for one plant.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_answer::PlantFit;
use gyrocal_document::{Screen, Standing};
use gyrocal_plant::{ColumnMap, LoadedPlant, NamedRecord, PlantError, Simulation, simulate};
use gyrocal_record::{SourceText, printable_path};
use gyrocal_statistics::format::short;
use gyrocal_words::counted;
use miette::miette;

use crate::outputs::{refuse_overlap, refuse_unwritable};
use crate::progress::Progress;
use crate::{Failure, Reply};

/// Simulate a run of this plant, with standard deviations from those of its parameters and initial states.
///
/// Without a fit they are the declared ones; a parameter without a declared standard deviation counts as exact.
#[derive(Debug, Args)]
pub(super) struct SimulateArguments {
    /// The run (CSV with time and inputs); columns of outputs are not read.
    #[arg(value_name = "INPUTS.csv")]
    inputs: PathBuf,
    /// Columns of the run for time and inputs (TOML).
    #[arg(long, value_name = "MAP.toml")]
    columns: PathBuf,
    /// Estimates with their covariance: what `plant fit --json` wrote.
    #[arg(long, value_name = "FIT.json")]
    fit: Option<PathBuf>,
    /// Write states and outputs, each with its standard deviation, row by row (CSV, or Parquet by its name).
    #[arg(long, value_name = "OUT.csv")]
    output: PathBuf,
}

/// Runs the command; `file` is that of the plant, if it is read from one.
pub(super) fn run(
    file: Option<&Path>,
    arguments: &SimulateArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    let SimulateArguments {
        inputs,
        columns,
        fit,
        output,
    } = arguments;
    let all = [Some(inputs.as_path()), Some(columns), fit.as_deref(), file];
    let all: Vec<&Path> = all.into_iter().flatten().collect();
    refuse_overlap(&all, &[("--output", Some(output))])?;
    refuse_unwritable(&[Some(output)], None)?;
    let plant = plant()?;
    let run = NamedRecord {
        name: printable_path(inputs),
        record: ColumnMap::read(columns)?.run(plant.description(), inputs)?,
    };
    let fit = fit.as_deref().map(read).transpose()?;
    let progress = Progress::waiting("simulating", run.record.len());
    let simulated = simulate(&plant, run, fit.as_ref())?;
    drop(progress);
    let mut shown = Reply::of(screen(&plant, &simulated), String::new());
    shown.write(
        Some(output),
        "states and outputs with standard deviations",
        |path| Ok(simulated.table().content(path)?),
    )?;
    Ok(shown)
}

fn read(path: &Path) -> Result<PlantFit, Failure> {
    let text = SourceText::read(path)?;
    serde_json::from_str(text.text()).map_err(|error| {
        let path = printable_path(path);
        Failure::Work(miette!(
            "{path}: no fit of a plant ({error}); give what `plant fit --json` wrote"
        ))
    })
}

fn screen(plant: &LoadedPlant, simulated: &Simulation) -> Screen {
    let rows = counted(simulated.time_s.len(), "row");
    let what = format!("{} over {rows}.", plant.description().name);
    let mut screen = Screen::new(Standing::Neutral, "SIMULATED", what);
    for one in &simulated.outputs {
        let [low, high] = [f64::min, f64::max].map(|end| {
            let all = one.values.iter().copied();
            short(all.reduce(end).unwrap_or_default(), 4)
        });
        let most = one.sigmas.iter().copied().fold(0.0, f64::max);
        let (unit, most) = (&one.unit, short(most, 3));
        let words = format!(
            "from {low} to {high} {unit}, with a standard deviation of at most {most} {unit}"
        );
        screen.fact(&one.id, words.replace('-', "−"));
    }
    screen
}
