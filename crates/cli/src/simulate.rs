//! `gyrocal simulate`: a record and its bench description from a scenario.

use std::ops::ControlFlow;
use std::path::PathBuf;

use clap::Args;
use gyrocal_document::{Screen, Standing};
use gyrocal_record::{printable_path, shell_quoted};
use gyrocal_truth::{Hidden, Scenario, Simulation, TruthReport, simulate_watched};

use crate::outputs::{manifest, refuse_overlap};
use crate::progress::Progress;
use crate::{Failure, Reply};

/// Simulate a record from a scenario with known coefficients, bench and sampling.
///
/// Tables [[hidden]] of the scenario are hidden effects: the record has them, and the bench
/// description does not declare them; docs/formats.md lists them.
///
/// The simulator is independent of the model of `calibrate`. The same scenario and seed give the
/// same record, bit for bit.
#[derive(Debug, Args)]
pub(crate) struct SimulateArguments {
    /// The scenario (TOML), for example examples/data/three_days.scenario.toml.
    scenario: PathBuf,
    /// Write the record (CSV).
    #[arg(long, value_name = "RECORD.csv")]
    out: PathBuf,
    /// Write the bench description (TOML), which `calibrate` and `diagnose` need with the record.
    #[arg(long, value_name = "BENCH.toml")]
    bench_out: Option<PathBuf>,
    /// Seed; default: that of the scenario.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(..=SEED_MAX))]
    seed: Option<u64>,
    /// Write the true coefficients, attitudes and hidden effects (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// The largest integer of TOML, so that a seed fits into a scenario file.
const SEED_MAX: u64 = i64::MAX as u64;

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &SimulateArguments) -> Result<Reply, Failure> {
    refuse_overlap(
        &[&arguments.scenario],
        &[
            ("--out", Some(&arguments.out)),
            ("--bench-out", arguments.bench_out.as_deref()),
            ("--json", arguments.json.as_deref()),
        ],
    )?;
    let mut scenario = Scenario::read(&arguments.scenario)?;
    if let Some(seed) = arguments.seed {
        scenario.seed = seed;
    }
    tracing::debug!(?scenario, "read");
    let mut progress = Progress::new("simulating", scenario.grid_rows());
    let simulation = simulate_watched(&scenario, &[], |rows| {
        progress.reach(rows);
        ControlFlow::Continue(())
    })
    .map_err(|error| Failure::of(&arguments.scenario, error))?;
    drop(progress);
    tracing::info!(rows = simulation.record.len(), "simulated");
    let mut answer = Reply::of(summary(arguments, &scenario, &simulation), String::new());
    let record = simulation.record.to_csv(&arguments.out)?;
    answer.outputs.stage(&arguments.out, record.as_bytes())?;
    let bench = arguments.bench_out.as_deref();
    answer.write(bench, "bench description", |path| {
        Ok(simulation.bench.to_toml(path)?)
    })?;
    if let Some(path) = &arguments.json {
        let manifest = manifest("", scenario.seed, &[&arguments.scenario])?;
        let truth = TruthReport::new(&simulation, manifest);
        answer.outputs.stage_json(path, &truth)?;
        answer.wrote(path, "the truth");
    }
    Ok(answer)
}

fn summary(arguments: &SimulateArguments, scenario: &Scenario, simulation: &Simulation) -> Screen {
    let what = format!(
        "{}: {} rows over {:.2} days, seed {}",
        printable_path(&arguments.out),
        simulation.record.len(),
        simulation.record.duration_s() / 86_400.0,
        scenario.seed
    );
    let mut screen = Screen::new(Standing::Neutral, "SIMULATED", what);
    let ids: Vec<&str> = simulation.truth.hidden.iter().map(Hidden::id).collect();
    screen.fact("hidden effects", ids.join(", "));
    if let Some(bench) = &arguments.bench_out {
        let files = format!(
            "{} --bench {}",
            shell_quoted(&arguments.out.to_string_lossy()),
            shell_quoted(&bench.to_string_lossy())
        );
        if ids.is_empty() {
            screen.then(format!("gyrocal calibrate {files}"), "its coefficients");
        } else {
            screen.then(format!("gyrocal diagnose {files}"), "finds what is hidden");
        }
    }
    screen
}
