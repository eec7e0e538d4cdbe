//! `gyrocal rates`: gyro outputs at rest or on a turntable, in the rate domain.

mod screen;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use comfy_table::Cell;
use gyrocal_instruments::rates::{GyroRates, RateReport, RateSettings, evaluate_rates};
use gyrocal_instruments::{Description, Log, ResultFile};
use gyrocal_record::{Outputs, printable_path};
use gyrocal_statistics::format;

use crate::measured::unusable;
use crate::numbers::{angle_sigma_deg, probability};
use crate::outputs::{self, manifest};
use crate::tables::table;
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
    outputs::check(&inputs, arguments.json.as_deref(), None)?;
    let (report, notes) = work(arguments)?;
    let mut text = String::new();
    for note in &notes {
        let _ = writeln!(text, "{note}\n");
    }
    of_logs(&mut text, arguments, &report);
    for gyro in &report.gyros {
        of_gyro(&mut text, gyro, report.logs.len() > 1);
    }
    let mut answer = Reply::of(screen::first(arguments, &report), text);
    let mut outputs = Outputs::new();
    if let Some(path) = &arguments.json {
        outputs.stage_json(path, &ResultFile::new(manifest("", 0, &inputs)?, &report))?;
        answer.wrote(path, "the result for programs");
    }
    outputs.commit()?;
    Ok(answer)
}

/// The evaluation, and what there is to tell of the clocks.
fn work(arguments: &RatesArguments) -> Result<(RateReport, Vec<String>), Failure> {
    let first = &arguments.logs[0];
    let description = Description::read(&arguments.log_description)
        .map_err(|error| unusable(first, error.into()))?;
    let mut logs = Vec::with_capacity(arguments.logs.len());
    for path in &arguments.logs {
        logs.push(Log::read(path, &description).map_err(|error| unusable(path, error))?);
    }
    let mut notes: Vec<String> = logs.iter().filter_map(|log| log.clock.note()).collect();
    notes.dedup();
    let settings = RateSettings {
        false_alarm_probability: arguments.false_alarm,
        level_sigma_deg: arguments.level_sigma_deg,
    };
    let report =
        evaluate_rates(&logs, &description, &settings).map_err(|error| unusable(first, error))?;
    Ok((report, notes))
}

fn of_logs(text: &mut String, arguments: &RatesArguments, report: &RateReport) {
    let mut table = table(["log", "of", "mean of the log, deg/h", "95 %"]);
    for (path, log) in arguments.logs.iter().zip(&report.logs) {
        let name = printable_path(path);
        for (gyro, law) in report.gyros.iter().enumerate() {
            let half_width = log.bias_half_width_deg_per_h[gyro];
            table.add_row([
                Cell::new(&name),
                Cell::new(format!("{}, less Earth rate", law.gyro)),
                Cell::new(format!("{:.4}", log.bias_deg_per_h[gyro])),
                Cell::new(format!("± {half_width:.4}")),
            ]);
        }
        let [rate, sigma] = log.vertical_deg_per_h;
        table.add_row([
            Cell::new(&name),
            Cell::new("vertical, Earth rate and bias"),
            Cell::new(format!("{rate:.4}")),
            Cell::new(format!("± {:.4}", gyrocal_statistics::NORMAL_97_5 * sigma)),
        ]);
    }
    let _ = writeln!(
        text,
        "Means; the heading is unknown, and Earth rate is {:.4} deg/h up and {:.4} deg/h north:\n\n{}\n",
        report.earth_vertical_deg_per_h,
        report.earth_horizontal_deg_per_h,
        table.trim_fmt()
    );
}

fn of_gyro(text: &mut String, gyro: &GyroRates, several: bool) {
    let mut table = table(["coefficient", "estimate"]);
    for coefficient in &gyro.coefficients {
        let estimate = format::estimate(coefficient.estimate, coefficient.sigma).join(" ± ");
        table.add_row([
            Cell::new(&coefficient.name),
            Cell::new(format!("{estimate} {}", coefficient.unit)),
        ]);
    }
    let _ = writeln!(text, "{}\n", table.trim_fmt());
    if !gyro.undetermined.is_empty() {
        let _ = writeln!(
            text,
            "{}: not determined in addition: {}.",
            gyro.gyro,
            gyro.undetermined.join(", ")
        );
    }
    for effect in &gyro.effects {
        let at = effect.step.map_or_else(String::new, |(time_s, log)| {
            format!(" at {time_s:.0} s of log {}", log + 1)
        });
        let alternatives = match &effect.alternatives[..] {
            [] => "no alternative".to_owned(),
            names => format!("alternatives: {}", names.join(", ")),
        };
        let p = format::p_value(effect.p_value);
        let _ = writeln!(text, "Found: {}{at} ({p}); {alternatives}.", effect.name);
    }
    let noise = &gyro.noise;
    let between = if several {
        format!(", bias from log to log {:.3e} deg/h", noise.between_logs)
    } else {
        String::new()
    };
    let _ = writeln!(
        text,
        "Noise: random walk {:.3e} deg/h sqrt(s), bias instability {:.3e} deg/h, rate random walk \
         {:.3e} deg/h/sqrt(s){between}.\n",
        noise.random_walk, noise.bias_instability, noise.rate_random_walk
    );
}
