//! `gyrocal watch`: a record replayed through the watch of a controller.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::{
    WatchAlarm, WatchCause, WatchOptions, WatchReplay, WatchResult, watch_record,
};
use gyrocal_document::{Screen, Standing};
use gyrocal_record::{Bench, write_json};

use crate::diagnose::NotDiagnosed;
use crate::numbers::{not_negative, probability};
use crate::outputs::{self, manifest};
use crate::tables::{right, table};
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
    outputs::check(&inputs, arguments.json.as_deref(), None)?;
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
    if let Some(path) = &arguments.json {
        let manifest = manifest(MODEL_HASH, 0, &inputs)?;
        write_json(path, &WatchResult::new(manifest, replay))?;
        answer.wrote(path, "the result for programs");
    }
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
        let causes: Vec<String> = alarm.refined.iter().map(cause).collect();
        let words = format!(
            "row {}, {:.0} s: {}",
            alarm.row,
            alarm.time_s,
            causes.join("; or ")
        );
        screen.fact("alarm", words);
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
    let mut text = format!(
        "{} rows, {} refused. False alarms: {} a year. Declared walk of the gyros: {:.0e} \
         deg/h/sqrt(h).\n",
        replay.rows,
        replay.refused_rows,
        replay.false_alarms_per_year,
        replay.walk_deg_per_h_per_sqrt_h,
    );
    if replay.alarms.is_empty() {
        text.push_str("No alarm.\n");
    }
    for alarm in &replay.alarms {
        text.push_str(&told(alarm));
    }
    let [effects, jumps] = replay.evidence_at_end;
    let _ = writeln!(
        text,
        "\nEvidence at the end over the threshold: {effects:.2e} for effects, {jumps:.2e} for jumps."
    );
    text
}

fn told(alarm: &WatchAlarm) -> String {
    let what = if alarm.jump { "a jump" } else { "an effect" };
    format!(
        "\nAlarm at row {} ({:.0} s): {what}.\n\n{}\n\nAt row {}:\n\n{}\n",
        alarm.row,
        alarm.time_s,
        causes(&alarm.at_alarm),
        alarm.refined_row,
        causes(&alarm.refined),
    )
}

fn causes(causes: &[WatchCause]) -> String {
    let mut table = table(["effect", "size", "sigma", "unit", "since [s]", "deviance"]);
    for cause in causes {
        table.add_row([
            comfy_table::Cell::new(&cause.id),
            right(format!("{:.3e}", cause.estimate)),
            right(format!("{:.1e}", cause.sigma)),
            comfy_table::Cell::new(cause.unit),
            right(format!("{:.0}", cause.since_s)),
            right(format!("{:.1}", cause.deviance)),
        ]);
    }
    table.trim_fmt()
}
