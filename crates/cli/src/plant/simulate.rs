//! `gyrocal plant simulate`, and `simulate` of a package for one plant.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_answer::{PlantFit, read_fit};
use gyrocal_document::{Screen, Standing};
use gyrocal_plant::{ColumnMap, LoadedPlant, PlantError, simulate};
use gyrocal_record::printable_path;
use gyrocal_statistics::format::short;
use gyrocal_words::counted;

use super::warn_of_gaps;
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

/// The fit in a file, and whether it is known to be of the program of this plant. One of another program of the same name
/// is refused; [`simulate`] refuses one of another name.
fn fit_of(plant: &LoadedPlant, path: &Path) -> Result<(PlantFit, bool), Failure> {
    let (fit, found) = read_fit(path)?;
    let (name, expected) = (&plant.description().name, plant.hash());
    if fit.plant == *name && !found.is_empty() && found != expected {
        return Err(Failure::from(PlantError::Input {
            origin: printable_path(path),
            problem: format!(
                "it is a fit of another program of the name {name}: found the hash {found}, expected {expected}"
            ),
            advice: "fit this program with `plant fit --json`, or give the one that was fitted"
                .to_owned(),
        }));
    }
    Ok((fit, !found.is_empty()))
}

/// Runs the command; `file` is that of the plant, if it is read from one.
pub(super) fn run(
    file: Option<&Path>,
    arguments: &SimulateArguments,
    plant: impl FnOnce() -> Result<LoadedPlant, PlantError>,
) -> Result<Reply, Failure> {
    let (inputs, output) = (arguments.inputs.as_path(), Some(&*arguments.output));
    let all = [
        Some(inputs),
        Some(&arguments.columns),
        arguments.fit.as_deref(),
        file,
    ];
    let all: Vec<&Path> = all.into_iter().flatten().collect();
    refuse_overlap(&all, &[("--output", output)])?;
    refuse_unwritable(&[output], None)?;
    let plant = plant()?;
    let columns = ColumnMap::read(&arguments.columns)?;
    let run = columns.named_run(plant.description(), inputs)?;
    warn_of_gaps(&columns, plant.description(), &run);
    let fit = arguments
        .fit
        .as_deref()
        .map(|path| fit_of(&plant, path))
        .transpose()?;
    let _progress = Progress::waiting("simulating", run.record.len());
    let simulated = simulate(&plant, run, fit.as_ref().map(|(fit, _)| fit))?;
    let rows = counted(simulated.time_s.len(), "row");
    let what = format!("{} over {rows}.", plant.description().name);
    let mut screen = Screen::new(Standing::Neutral, "SIMULATED", what);
    for one in &simulated.outputs {
        let most = short(one.largest_sigma(), 3);
        screen.fact(
            &one.id,
            format!("standard deviation at most {most} {}", one.unit),
        );
    }
    if !simulated.held.is_empty() {
        let held = simulated.held.join(", ");
        let why = "held in the fit, whose record does not determine it; the standard deviations leave it out";
        screen.fact("not known", format!("{held}: {why}"));
    }
    if fit.is_some_and(|(_, is_checked)| !is_checked) {
        let words = "the file of the fit has no hash of the program, as older ones: that it is of this plant \
                     is known by its name alone";
        screen.fact("not checked", words);
    }
    let mut shown = Reply::of(screen, String::new());
    let what = "states and outputs with standard deviations";
    shown.write(output, what, |path| Ok(simulated.table().content(path)?))?;
    Ok(shown)
}
