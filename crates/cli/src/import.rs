//! `gyrocal import`: records from the files of other programs and instruments. `import strapdown` makes the
//! record and bench description of an analytic platform from the log of a strapdown unit at rest.

mod screen;
mod table;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, Subcommand};
use gyrocal_instruments::strapdown::{ImportReport, ImportSettings, Imported, axes_csv, import};
use gyrocal_instruments::{Description, InstrumentError, Log, ResultFile};
use gyrocal_record::{AXES, printable_path};

use crate::measured::unusable;
use crate::numbers::{angle_deg, angle_sigma_deg, positive};
use crate::outputs::{manifest, refuse_overlap};
use crate::{Failure, Reply};

/// Make a record from a log of another kind of instrument.
#[derive(Debug, Args)]
pub(crate) struct ImportArguments {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Debug, Subcommand)]
enum Kind {
    Csv(table::TableArguments),
    Strapdown(StrapdownArguments),
}

/// A strapdown unit on a static base, as an analytic space-stable platform.
///
/// Integrates the increments of the gyros with a coning correction and resolves the outputs of the
/// accelerometers along the axes that the gyros hold in inertial space. Reports disturbed rows, the
/// rate of gravity in the platform compared with Earth rate, and what one attitude determines.
#[derive(Debug, Args)]
struct StrapdownArguments {
    /// The log (CSV) with a header row.
    log: PathBuf,
    /// Description of its columns (TOML); docs/measured-data.md has every key.
    #[arg(long, value_name = "LOG.toml")]
    log_description: PathBuf,
    /// Write the record (CSV).
    #[arg(long, value_name = "RECORD.csv")]
    out: PathBuf,
    /// Write the bench description (TOML), which `calibrate` and `diagnose` need with the record.
    #[arg(long, value_name = "BENCH.toml")]
    bench_out: Option<PathBuf>,
    /// Write the attitude of the gyros in the analytic platform at each row (CSV), the input of
    /// `calibrate --gyro-axes`.
    #[arg(long, value_name = "AXES.csv")]
    axes_out: Option<PathBuf>,
    /// Interval over which specific force is averaged into one row.
    #[arg(long, value_name = "S", default_value_t = ImportSettings::default().averaging_s, value_parser = positive)]
    averaging_s: f64,
    /// Threshold of disturbed rows: standard deviation over that of the median row.
    #[arg(long, value_name = "FACTOR", default_value_t = ImportSettings::default().quiet_factor, value_parser = positive)]
    quiet_factor: f64,
    /// Keep the values of disturbed rows instead of writing `nan`.
    #[arg(long)]
    keep_disturbed: bool,
    /// Heading of body y, clockwise from north, if known by other means.
    #[arg(
        long,
        value_name = "DEG",
        requires = "heading_sigma_deg",
        allow_negative_numbers = true,
        value_parser = angle_deg
    )]
    heading_deg: Option<f64>,
    /// Standard deviation of that heading.
    #[arg(long, value_name = "DEG", requires = "heading_deg", value_parser = angle_sigma_deg)]
    heading_sigma_deg: Option<f64>,
    /// Prior standard deviation of the constant error of a gyro.
    #[arg(long, value_name = "DEG_PER_H", default_value_t = ImportSettings::default().bias_sigma_deg_per_h, value_parser = positive)]
    bias_sigma_deg_per_h: f64,
    /// Standard deviation of the level, set by the errors of the accelerometers.
    #[arg(long, value_name = "DEG", default_value_t = ImportSettings::default().level_sigma_deg, value_parser = angle_sigma_deg)]
    level_sigma_deg: f64,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &ImportArguments) -> Result<Reply, Failure> {
    match &arguments.kind {
        Kind::Csv(arguments) => table::run(arguments),
        Kind::Strapdown(arguments) => strapdown(arguments),
    }
}

fn strapdown(arguments: &StrapdownArguments) -> Result<Reply, Failure> {
    let inputs = [&*arguments.log, &*arguments.log_description];
    refuse_overlap(
        &inputs,
        &[
            ("--out", Some(&arguments.out)),
            ("--bench-out", arguments.bench_out.as_deref()),
            ("--axes-out", arguments.axes_out.as_deref()),
            ("--json", arguments.json.as_deref()),
        ],
    )?;
    let (imported, clock) = work(arguments).map_err(|error| unusable(&arguments.log, error))?;
    let note = clock.map_or_else(String::new, |note| format!("{note}\n\n"));
    let report = &imported.report;
    let mut answer = Reply::of(
        screen::first(arguments, report),
        note + &summary(arguments, report),
    );
    answer.write(Some(&arguments.out), "the record", |path| {
        Ok(imported.record.to_csv(path)?)
    })?;
    let bench = arguments.bench_out.as_deref();
    answer.write(bench, "the bench description", |path| {
        Ok(imported.bench.to_toml(path)?)
    })?;
    let axes = arguments.axes_out.as_deref();
    answer.write(axes, "the axes of the gyros", |_| {
        Ok(axes_csv(&imported.record, &imported.platform_q_body))
    })?;
    let result = ResultFile::new(manifest("", 0, &inputs)?, report);
    answer.write_json(arguments.json.as_deref(), &result)?;
    Ok(answer)
}

fn work(arguments: &StrapdownArguments) -> Result<(Imported, Option<String>), InstrumentError> {
    let description = Description::read(&arguments.log_description)?;
    let log = Log::read(&arguments.log, &description)?;
    let settings = ImportSettings {
        averaging_s: arguments.averaging_s,
        quiet_factor: arguments.quiet_factor,
        keep_disturbed: arguments.keep_disturbed,
        heading_deg: arguments
            .heading_deg
            .zip(arguments.heading_sigma_deg)
            .map(<[f64; 2]>::from),
        bias_sigma_deg_per_h: arguments.bias_sigma_deg_per_h,
        level_sigma_deg: arguments.level_sigma_deg,
    };
    Ok((import(&log, &description, &settings)?, log.clock.note()))
}

fn summary(arguments: &StrapdownArguments, report: &ImportReport) -> String {
    let disturbed = disturbed_s(report);
    let mut text = format!(
        "{}: {} samples over {:.1} s averaged to {} rows of {} s\n\n",
        printable_path(&arguments.log),
        report.samples,
        report.duration_s,
        report.rows,
        arguments.averaging_s
    );
    let _ = writeln!(
        text,
        "Standard deviation of the samples of the median row: {:.1} deg/h and {:.2e} g. Disturbed \
         rows (more than\n{} times that): {disturbed:.0} s, {}:",
        report.gyro_scatter_deg_per_h,
        report.accel_scatter_g,
        arguments.quiet_factor,
        of_disturbed(arguments),
    );
    let windows: Vec<String> = report
        .disturbed_s
        .iter()
        .map(|[from_s, to_s]| format!("{:.0} to {:.0}", from_s.round() + 0.0, to_s.round() + 0.0))
        .collect();
    for line in windows.chunks(8) {
        let _ = writeln!(text, "  {}", line.join(", "));
    }
    let _ = writeln!(
        text,
        "Mean magnitude of specific force: {:.6} in the unit of the log; it is the unit of the record, \
         since the common\nscale of the accelerometers and gravity are not distinguishable.",
        report.norm_g
    );
    rates(&mut text, report);
    let _ = writeln!(
        text,
        "\nNoise: {:.2e} g per row (correlation of successive rows {:.2}), gyros at most {:.4} deg/h \
         held over one minute.",
        report.accel_noise_g, report.accel_noise_correlation, report.gyro_noise_deg_per_h
    );
    determined(&mut text, report);
    text
}

/// What is done with disturbed rows.
fn of_disturbed(arguments: &StrapdownArguments) -> &'static str {
    match arguments.keep_disturbed {
        true => "kept",
        false => "written as missing",
    }
}

/// Length of the disturbed windows together.
fn disturbed_s(report: &ImportReport) -> f64 {
    let windows = report.disturbed_s.iter();
    windows.map(|[from_s, to_s]| to_s - from_s).sum()
}

/// What to check where a rate is far from Earth rate.
const TO_CHECK: &str = "check latitude, units and axes in the log description, and the gyros";

/// Threshold of a difference from Earth rate beyond noise, in standard deviations.
const FAR_SIGMAS: f64 = 6.0;

/// Rates that can be held against Earth rate: name, rate with its standard deviation, and what is expected.
fn compared(report: &ImportReport) -> [(&'static str, [f64; 2], f64); 2] {
    let (horizontal, vertical) = (
        report.expected_horizontal_rate_deg_per_h,
        report.expected_vertical_rate_deg_per_h,
    );
    [
        ("horizontal", report.horizontal_rate_deg_per_h, horizontal),
        ("vertical", report.vertical_rate_deg_per_h, vertical),
    ]
}

fn is_far([rate, sigma]: [f64; 2], expected: f64) -> bool {
    (rate - expected).abs() > FAR_SIGMAS * sigma
}

fn rates(text: &mut String, report: &ImportReport) {
    text.push_str("\nRate of gravity in the analytic platform [deg/h]:\n");
    let vertical = report.expected_vertical_rate_deg_per_h;
    let mut lines = compared(report).to_vec();
    if let Some(projection) = report.vertical_projection_deg_per_h {
        lines.push(("vertical, mean of the gyros", projection, vertical));
        lines.push((
            "vertical, both",
            report.vertical_combined_deg_per_h,
            vertical,
        ));
    }
    for (name, [rate, sigma], expected) in lines {
        let _ = writeln!(
            text,
            "  {name:<10} {rate:.4} ± {sigma:.4}, Earth {expected:.4}, difference {:.4}",
            rate - expected
        );
        if is_far([rate, sigma], expected) {
            let _ = writeln!(text, "  {:<10} far off: {TO_CHECK}", "");
        }
    }
    let _ = writeln!(
        text,
        "Heading of body y from the gyros: {:.3} deg from north",
        report.heading_deg
    );
}

fn determined(text: &mut String, report: &ImportReport) {
    let c = &report.body_c_enu;
    let combination = |column: usize| {
        let parts = AXES.iter().zip(c);
        let parts: Vec<String> = parts
            .map(|(axis, row)| format!("{:+.4} e_{axis}", row[column]))
            .collect();
        parts.join(" ")
    };
    let east_per_heading = report.horizontal_rate_deg_per_h[0].to_radians();
    let _ = writeln!(
        text,
        "\nOne attitude determines three combinations of the gyro errors e_x, e_y, e_z, each of which \
         is the sum of bias\nand all terms in specific force:\n  north  {}\n  up     {}\n  east   \
         {}\nNorth and up are the differences above. East is not distinguishable from the heading: \
         one degree of heading\nis {east_per_heading:.4} deg/h. Bias, g_i and g_ii of a gyro are not \
         distinguishable.",
        combination(1),
        combination(2),
        combination(0),
    );
}
