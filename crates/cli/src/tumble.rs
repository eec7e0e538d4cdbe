//! `gyrocal tumble`: multi-position test of gyros from a log with static stops in many attitudes.

use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_instruments::multi_position::{
    MultiPositionSettings, PreparedTest, TumbleResult, multi_position_test, prepare_logs,
};
use gyrocal_instruments::{
    Description, InstrumentError, Log, ResultFile, StopSettings, find_stops, given_stops,
};
use gyrocal_pages::{TumbleAnswer, of_tumble};

use crate::measured::{interval, logs, unusable};
use crate::numbers::{positive, probability};
use crate::outputs::{self, manifest};
use crate::page::Views;
use crate::{Failure, Reply};

/// Multi-position test: fit the drift law to static stops and find missing terms.
///
/// Stops are detected in the log or given. Gyro outputs are fitted to specific force, and terms of
/// the catalogue are added while they are significant beside the noise that may be between stops.
/// Reports the alternatives of each term, and the gain of the extended law on held-out stops.
#[derive(Debug, Args)]
pub(crate) struct TumbleArguments {
    /// The log (CSV) with a header row; several logs of one unit are one or more positions each.
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Description of its columns (TOML); docs/measured-data.md has every key.
    #[arg(long, value_name = "LOG.toml")]
    log_description: PathBuf,
    /// A stop of the log, instead of those detected; may be repeated.
    #[arg(long, value_name = "FROM_S:TO_S", value_parser = interval)]
    stop: Vec<[f64; 2]>,
    /// Shortest stop.
    #[arg(long, value_name = "S", default_value_t = StopSettings::default().shortest_s,
          value_parser = positive, conflicts_with = "stop")]
    shortest_stop_s: f64,
    /// Judge stops by the quietest windows of the log: largest variance over theirs. Default: in
    /// physical units the tremor of a hand (2 deg/s, 0.03 g), in raw counts a factor of 6.
    #[arg(long, value_name = "FACTOR", value_parser = positive, conflicts_with = "stop")]
    quiet_factor: Option<f64>,
    /// Family-wise false-alarm probability.
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = probability)]
    false_alarm: f64,
    /// Successive stops that are held out together to measure the gain; more where that would be
    /// more than twelve times.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..))]
    left_out: u32,
    #[command(flatten)]
    views: Views,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &TumbleArguments) -> Result<Reply, Failure> {
    let mut inputs: Vec<&Path> = arguments.logs.iter().map(|log| &**log).collect();
    inputs.push(&arguments.log_description);
    let views = &arguments.views;
    views.check(&inputs, &[])?;
    if arguments.logs.len() > 1 && !arguments.stop.is_empty() {
        return Err(Failure::Usage(
            "--stop gives stops of one log; with several logs the stops of each are detected"
                .to_owned(),
        ));
    }
    let (prepared, result, clocks) = work(arguments)?;
    tracing::info!(?result, "tested");
    let manifest = manifest(MODEL_HASH, 0, &inputs)?;
    let mut part = of_tumble(&TumbleAnswer {
        manifest: &manifest,
        prepared: &prepared,
        result: &result,
        false_alarm: arguments.false_alarm,
        left_out: arguments.left_out,
        clocks: &clocks,
    });
    if !views.are_asked() {
        let command = format!("{} --figures figures", outputs::command_line());
        part.first.then(command, "pictures");
    }
    let result = ResultFile::new(manifest, result);
    views.answered(&arguments.logs[0], part, &result)
}

/// The test, and what there is to tell of the clocks.
fn work(arguments: &TumbleArguments) -> Result<(PreparedTest, TumbleResult, Vec<String>), Failure> {
    let paths = &arguments.logs;
    let read =
        |path: &Path, description: &Description| log_with_stops(arguments, path, description);
    let (description, logs, notes) = logs(paths, &arguments.log_description, read, |(log, _)| log)?;
    let (prepared, result) =
        tested(arguments, &logs, &description).map_err(|error| unusable(&paths[0], error))?;
    Ok((prepared, result, notes))
}

fn log_with_stops(
    arguments: &TumbleArguments,
    path: &Path,
    description: &Description,
) -> Result<(Log, Vec<Range<usize>>), InstrumentError> {
    let log = Log::read_for_stops(path, description)?;
    let stops = match &arguments.stop[..] {
        [] => find_stops(&log, &stop_settings(arguments))?,
        given => given_stops(&log, given)?,
    };
    Ok((log, stops))
}

fn stop_settings(arguments: &TumbleArguments) -> StopSettings {
    let default = StopSettings {
        shortest_s: arguments.shortest_stop_s,
        ..StopSettings::default()
    };
    match arguments.quiet_factor {
        None => default,
        Some(factor) => StopSettings {
            accel_factor: factor,
            gyro_factor: default.gyro_factor * factor / default.accel_factor,
            hand_held: None,
            ..default
        },
    }
}

fn tested(
    arguments: &TumbleArguments,
    logs: &[(Log, Vec<Range<usize>>)],
    description: &Description,
) -> Result<(PreparedTest, TumbleResult), InstrumentError> {
    let prepared = prepare_logs(logs, description)?;
    let settings = MultiPositionSettings {
        false_alarm_probability: arguments.false_alarm,
        left_out: arguments.left_out as usize,
    };
    let report = multi_position_test(&prepared.positions, &settings)?;
    let result = TumbleResult::of(&prepared, report);
    Ok((prepared, result))
}
