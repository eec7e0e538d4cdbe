//! `gyrocal watch`: a record replayed through the watch of a controller.

use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::{WatchCause, WatchOptions, WatchReplay, WatchResult, watch_record};
use gyrocal_document::{Screen, Standing, Table, Words};
use gyrocal_record::Bench;
use gyrocal_words::joined;

use crate::diagnose::NotDiagnosed;
use crate::layout::layout;
use crate::numbers::{not_negative, probability};
use crate::outputs::{self, manifest};
use crate::{Failure, Reply, records};

/// Replay a record through the watch that runs on a controller beside the filter.
///
/// The watch tests at every sample for changes of the drift, ramps, cross-axis terms, biases of
/// accelerometers and jumps of the attitude. False alarms are bounded for any stretch of time. At an
/// alarm it names the effects that cannot be told apart, with size, sigma and onset, and again after
/// twice the delay; then it goes on with new onsets.
#[derive(Debug, Args)]
pub(crate) struct WatchArguments {
    /// The record (CSV): time_s,accel_x_g,accel_y_g,accel_z_g.
    #[arg(value_name = "RECORD.csv")]
    record: PathBuf,
    /// The bench description (TOML), with the attitude of the first row.
    #[arg(long, value_name = "BENCH.toml")]
    bench: PathBuf,
    #[command(flatten)]
    map: records::Map,
    /// Probability of a false alarm in a year.
    #[arg(long, value_name = "P", default_value_t = WatchOptions::default().false_alarms_per_year, value_parser = probability)]
    false_alarm: f64,
    /// Random walk of the drift of each gyro that is no alarm, deg/h/sqrt(h).
    #[arg(long, value_name = "SIZE", default_value_t = WatchOptions::default().walk_deg_per_h_per_sqrt_h, value_parser = not_negative)]
    walk: f64,
    /// Compute in single precision, as a controller does.
    #[arg(long)]
    single: bool,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &WatchArguments) -> Result<Reply, Failure> {
    let inputs = [&*arguments.record, &*arguments.bench].into_iter();
    let inputs: Vec<&Path> = inputs.chain(arguments.map.path()).collect();
    outputs::check(&inputs, arguments.json.as_deref())?;
    let record = arguments.map.read(&arguments.record)?.into_sound()?;
    let bench = Bench::read(&arguments.bench)?;
    let options = WatchOptions {
        false_alarms_per_year: arguments.false_alarm,
        walk_deg_per_h_per_sqrt_h: arguments.walk,
        single: arguments.single,
    };
    let replay = watch_record(&record, &bench, &options)
        .map_err(|source| NotDiagnosed::new(&arguments.record, &bench, source))?;
    let mut answer = Reply::of(screen(&replay), text(&replay));
    let result = WatchResult::new(manifest(MODEL_HASH, 0, &inputs)?, replay);
    answer.write_json(arguments.json.as_deref(), &result)?;
    Ok(answer)
}

fn screen(replay: &WatchReplay) -> Screen {
    let watched = format!("{} rows, {} refused", replay.rows, replay.refused_rows);
    let mut screen = match replay.alarms.len() {
        0 => Screen::new(Standing::Good, "NO ALARM", watched),
        1 => Screen::new(Standing::Bad, "ALARM", watched),
        count => Screen::new(Standing::Bad, &format!("{count} ALARMS"), watched),
    };
    for alarm in &replay.alarms {
        let (row, time_s) = (alarm.row, alarm.time_s);
        let causes = joined(alarm.refined.iter().map(cause), "; or ");
        screen.fact("alarm", format!("row {row}, {time_s:.0} s: {causes}"));
        if !alarm.walks.is_empty() {
            let words = format!("{}, larger than declared", alarm.walks.join(", "));
            screen.fact("may also be", words);
        }
    }
    let rate = format!(
        "{} a year, beside a walk of {:.0e} deg/h/sqrt(h)",
        replay.false_alarms_per_year, replay.walk_deg_per_h_per_sqrt_h
    );
    screen.fact("false alarms", rate);
    screen
}

/// A cause with its size and onset.
fn cause(cause: &WatchCause) -> String {
    format!(
        "{} ({:.3e} ± {:.1e}) {} since {:.0} s",
        cause.id, cause.estimate, cause.sigma, cause.unit, cause.since_s
    )
}

fn text(replay: &WatchReplay) -> String {
    let mut text = vec![Words::Paragraph(match replay.alarms.len() {
        0 => "No alarm.".to_owned(),
        _ => format!("{} rows, {} refused.", replay.rows, replay.refused_rows),
    })];
    for alarm in &replay.alarms {
        let what = if alarm.jump { "a jump" } else { "an effect" };
        let title = format!("Alarm at row {} ({:.0} s): {what}", alarm.row, alarm.time_s);
        text.push(Words::Table(causes(&title, &alarm.at_alarm)));
        let title = format!("At row {}", alarm.refined_row);
        text.push(Words::Table(causes(&title, &alarm.refined)));
    }
    let [effects, jumps] = replay.evidence_at_end;
    text.push(Words::Paragraph(format!(
        "Evidence at the end over the threshold: {effects:.2e} for effects, {jumps:.2e} for jumps."
    )));
    layout(&text)
}

fn causes(title: &str, causes: &[WatchCause]) -> Table {
    let rows = causes.iter().map(|cause| {
        [
            cause.id.to_string(),
            format!("{:.3e}", cause.estimate),
            format!("{:.1e}", cause.sigma),
            cause.unit.to_string(),
            format!("{:.0}", cause.since_s),
            format!("{:.1}", cause.deviance),
        ]
    });
    let heads = "effect | > size | > sigma | unit | > since, s | > deviance";
    Table::of(title, heads, rows)
}
