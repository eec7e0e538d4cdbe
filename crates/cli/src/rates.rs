//! `gyrocal rates`: gyro outputs at rest or on a turntable, in the rate domain.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal_instruments::rates::{RateReport, RateSettings, evaluate_rates};
use gyrocal_instruments::{Log, ResultFile};
use gyrocal_pages::of_rates;

use crate::measured::{logs, unusable};
use crate::numbers::{angle_sigma_deg, probability};
use crate::outputs::{self, manifest};
use crate::{Failure, Reply};

/// Biases, scales and effects of gyros from logs at rest or on a turntable, in rates.
///
/// Each log has one attitude to gravity; several logs of one unit are evaluated together. The outputs of
/// the gyros are fitted to Earth rate, the rate of the table, specific force, temperature and time, with
/// the noise that the logs show: random walk, quantisation, bias instability and rate random walk. Biases
/// may be of any size. Reports what each log tells by its means, and what the logs do not determine.
#[derive(Debug, Args)]
pub(crate) struct RatesArguments {
    /// The log (CSV) with a header row; several logs of one unit, each in one attitude.
    #[arg(required = true, value_name = "LOG")]
    logs: Vec<PathBuf>,
    /// Description of its columns (TOML), with a table `[table]` for a turntable and `[temperature]`;
    /// docs/measured-data.md has every key.
    #[arg(long, value_name = "LOG.toml")]
    log_description: PathBuf,
    /// Family-wise false-alarm probability of an effect of a gyro.
    #[arg(long, value_name = "P", default_value_t = RateSettings::default().false_alarm_probability,
          value_parser = probability)]
    false_alarm: f64,
    /// Standard deviation of the level, set by the errors of the accelerometers.
    #[arg(long, value_name = "DEG", default_value_t = RateSettings::default().level_sigma_deg,
          value_parser = angle_sigma_deg)]
    level_sigma_deg: f64,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &RatesArguments) -> Result<Reply, Failure> {
    let mut inputs: Vec<&Path> = arguments.logs.iter().map(|log| &**log).collect();
    inputs.push(&arguments.log_description);
    let json = arguments.json.as_deref();
    outputs::check(&inputs, json)?;
    let (report, mut notes) = work(arguments)?;
    let manifest = manifest("", 0, &inputs)?;
    let assumption = report.assumption();
    notes.extend(assumption.iter().map(|words| format!("Assumed: {words}.")));
    let mut part = of_rates(&manifest, &report, &notes);
    if let Some(words) = assumption {
        part.first.fact("assumed", words);
    }
    let mut answer = Reply::of_part(&part);
    answer.write_json(json, &ResultFile::new(manifest, &report))?;
    Ok(answer)
}

/// The evaluation, and what there is to tell of the clocks.
fn work(arguments: &RatesArguments) -> Result<(RateReport, Vec<String>), Failure> {
    let paths = &arguments.logs;
    let (description, logs, notes) = logs(paths, &arguments.log_description, Log::read, |log| log)?;
    let settings = RateSettings {
        false_alarm_probability: arguments.false_alarm,
        level_sigma_deg: arguments.level_sigma_deg,
    };
    let report = evaluate_rates(&logs, &description, &settings)
        .map_err(|error| unusable(&paths[0], error))?;
    Ok((report, notes))
}
