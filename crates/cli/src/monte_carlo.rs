//! `gyrocal monte-carlo`: consistency and accuracy of the calibration over many simulated records.

pub(crate) mod progress;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_calibration::Options;
use gyrocal_evaluation::{
    CalibrationSummary, CalibrationTrial, Campaign, Fingerprint, MonteCarloReport, Outcome, program,
};
use gyrocal_pages::of_monte_carlo;
use gyrocal_record::SCHEMA_VERSION;
use gyrocal_truth::{Population, Scenario};
use miette::miette;

use crate::outputs::manifest;
use crate::page::Views;
use crate::{Failure, Reply};
use progress::SeedProgress;

/// Evaluate the calibration by Monte Carlo simulation.
///
/// Simulates the scenario with each seed, calibrates each record, and prints bias, RMSE over sigma,
/// NEES and NIS with their bands, and the coverage of 95 % intervals. The result depends on the
/// scenario and the seeds alone. With --results, an interrupted run can be resumed.
#[derive(Debug, Args)]
pub(crate) struct MonteCarloArguments {
    /// The scenario (TOML); examples/data/three_days.scenario.toml is one. Its seed is replaced.
    scenario: PathBuf,
    /// Range of seeds from A to B - 1: 0..2000 are two thousand.
    #[arg(long, value_name = "A..B", value_parser = seeds)]
    seeds: Range<u64>,
    /// Store each finished run in this file and resume from the runs in it (JSON lines); a file of
    /// another build of the program is refused.
    #[arg(long, value_name = "FILE.jsonl")]
    results: Option<PathBuf>,
    /// Use this many threads instead of one for each core.
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    #[command(flatten)]
    views: Views,
    /// Draw latitude (up to 80 deg), coefficients, initial attitude and duration (one to fourteen
    /// days) at random; the rest is that of the scenario. Its seed is that of the population, and
    /// --seeds are numbers of scenarios in it.
    #[arg(long)]
    population: bool,
    /// Evaluate the streaming filter, which a controller embeds.
    #[arg(long)]
    streaming: bool,
}

/// Largest number of seeds: results are held in memory.
const MAX_SEEDS: u64 = 10_000_000;

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &MonteCarloArguments) -> Result<Reply, Failure> {
    let views = &arguments.views;
    let results = arguments.results.as_deref();
    views.refuse_overlap(&[&arguments.scenario], &[("--results", results)])?;
    // Checked before hours of work: the folders must exist.
    views.check(&[&arguments.scenario], &[])?;
    let scenario = Scenario::read(&arguments.scenario)?;
    let seed = scenario.seed;
    let outcome = outcome(arguments, scenario)?;
    tracing::info!(resumed = outcome.resumed(), "all seeds done");
    let summary = CalibrationSummary::of(&outcome);
    if let (0, Some(failure)) = (summary.runs, summary.failures.first()) {
        let (seed, message) = (failure.seed, &failure.message);
        return Err(Failure::of(
            &arguments.scenario,
            format_args!("no run gave a calibration; seed {seed}: {message}"),
        ));
    }
    let report = MonteCarloReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, seed, &[&arguments.scenario])?,
        seeds: [arguments.seeds.start, arguments.seeds.end],
        population: arguments.population,
        summary,
    };
    let part = of_monte_carlo(&report);
    let mut answer = Reply::of_part(&part);
    if let Some(path) = &arguments.results {
        answer.wrote(path, "results of all runs");
    }
    views.stage(&arguments.scenario, part, &mut answer)?;
    answer.write_json(views.json(), &report)?;
    Ok(answer)
}

fn outcome(
    arguments: &MonteCarloArguments,
    scenario: Scenario,
) -> Result<Outcome<CalibrationTrial>, Failure> {
    let options = if arguments.streaming {
        Options::streaming()
    } else {
        Options::default()
    };
    let fingerprint = Fingerprint::new("gyrocal monte-carlo")
        .with("model", MODEL_HASH)
        .with("program", program())
        .with("options", format!("{options:#?}"))
        .with("population", arguments.population);
    let population = Population {
        common: scenario.clone(),
        ..Population::new(scenario.seed)
    };
    // The seed of the file is replaced, unless it is that of the population.
    let file = Scenario {
        seed: 0,
        ..scenario
    };
    let fingerprint = if arguments.population {
        fingerprint.with("scenario", format!("{population:#?}"))
    } else {
        fingerprint.with("scenario", format!("{file:#?}"))
    };
    let mut campaign = Campaign::new(arguments.seeds.clone(), fingerprint);
    if let Some(path) = &arguments.results {
        campaign = campaign.results(path);
    }
    if let Some(threads) = arguments.threads {
        campaign = campaign.threads(threads);
    }
    let mut progress = SeedProgress::new();
    let job = |seed| {
        let scenario = if arguments.population {
            population.scenario(seed)
        } else {
            Scenario {
                seed,
                ..file.clone()
            }
        };
        CalibrationTrial::of(&scenario, &options)
    };
    campaign
        .run(job, |state| progress.reach(state))
        .map_err(|error| Failure::Work(miette!("{error}")))
}

fn seeds(text: &str) -> Result<Range<u64>, String> {
    let range = text.split_once("..").and_then(|(from, to)| {
        let seeds = from.parse::<u64>().ok()?..to.parse::<u64>().ok()?;
        // Seeds fit a TOML integer, so that each run can be simulated by itself.
        (!seeds.is_empty() && i64::try_from(seeds.end).is_ok()).then_some(seeds)
    });
    match range {
        None => Err("expected two whole numbers A..B with A less than B".to_owned()),
        Some(seeds) if seeds.end - seeds.start > MAX_SEEDS => {
            Err(format!("expected at most {MAX_SEEDS} seeds"))
        }
        Some(seeds) => Ok(seeds),
    }
}

#[cfg(test)]
mod tests {
    use super::seeds;

    #[test]
    fn seeds_are_two_numbers_in_order() {
        assert_eq!(seeds("3..8"), Ok(3..8));
        for wrong in [
            "", "8", "3..", "..8", "3...8", "3..=8", "8..8", "8..3", "-1..8", "a..b",
        ] {
            assert!(seeds(wrong).is_err(), "{wrong}");
        }
        assert!(seeds("0..10000000").is_ok());
        assert!(seeds("0..10000001").is_err());
        assert!(seeds("9223372036854775806..9223372036854775807").is_ok());
        assert!(seeds("9223372036854775807..9223372036854775808").is_err());
    }
}
