//! `gyrocal allan`: Allan deviations with confidence intervals of columns of a log.

mod screen;

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use comfy_table::Cell;
use gyrocal_instruments::{
    AllanColumn, AllanReport, AllanSettings, Description, InstrumentError, Log, ResultFile,
    allan_columns, allan_log,
};
use gyrocal_pages::{AllanAnswer, of_allan};
use gyrocal_record::{Outputs, SourceText};
use gyrocal_statistics::allan::{AllanEstimator, NoiseFit};
use gyrocal_statistics::format;

use crate::measured::unusable;
use crate::numbers::{positive, probability};
use crate::outputs::{self, manifest};
use crate::page::Views;
use crate::tables::{right, table};
use crate::{Failure, Reply};

/// Allan deviation of columns of a log, and the parts of their noise.
///
/// Each column is a rate sampled at equal intervals. Confidence intervals of the deviations are those of
/// NIST SP 1065, with the degrees of freedom of the dominant noise type at each averaging time. The
/// coefficients are fitted with the covariances of the deviations over averaging times, with 95 %
/// intervals and a test of fit.
#[derive(Debug, Args)]
pub(crate) struct AllanArguments {
    /// The log (CSV) with a header row, or as its description says.
    log: PathBuf,
    /// Description of the log (TOML): its three gyros on its clock, in deg/h; docs/measured-data.md has
    /// every key.
    #[arg(long, value_name = "LOG.toml", conflicts_with_all = ["columns", "rate_hz", "scale", "unit"])]
    log_description: Option<PathBuf>,
    /// The columns.
    #[arg(
        long,
        value_name = "NAMES",
        value_delimiter = ',',
        required_unless_present = "log_description"
    )]
    columns: Vec<String>,
    /// Samples per second.
    #[arg(
        long,
        value_name = "HZ",
        value_parser = positive,
        required_unless_present = "log_description"
    )]
    rate_hz: Option<f64>,
    /// Factor of the values, for example 206264.8 for deg/h from rad/s.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    scale: f64,
    /// Unit of the scaled values, for the output.
    #[arg(long, value_name = "UNIT", default_value = "units of the column")]
    unit: String,
    /// Confidence level of the intervals.
    #[arg(long, value_name = "P", default_value_t = 0.683, value_parser = probability)]
    confidence: f64,
    /// Estimator of the printed deviations; the coefficients are always fitted to the overlapping ones.
    #[arg(long, value_name = "ESTIMATOR", default_value = "overlapping")]
    estimator: Estimator,
    /// Write the result for programs (JSON), with the fitted curve and its parts for a plot.
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    #[command(flatten)]
    views: Views,
}

/// Value of `--estimator`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Estimator {
    /// Overlapping Allan deviation.
    Overlapping,
    /// Total deviation: more degrees of freedom at the longest averaging times.
    Total,
    /// Overlapping Hadamard deviation: a ramp of the rate does not enter it.
    Hadamard,
}

impl Estimator {
    fn of_library(self) -> AllanEstimator {
        match self {
            Self::Overlapping => AllanEstimator::Overlapping,
            Self::Total => AllanEstimator::Total,
            Self::Hadamard => AllanEstimator::Hadamard,
        }
    }
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &AllanArguments) -> Result<Reply, Failure> {
    let mut inputs = vec![&*arguments.log];
    inputs.extend(arguments.log_description.as_deref());
    let json = arguments.json.as_deref();
    outputs::check(&inputs, json, arguments.views.figures())?;
    arguments.views.check(&inputs, &[("--json", json)])?;
    let analysed = analysed(arguments).map_err(|error| unusable(&arguments.log, error))?;
    let first = screen::first(&analysed);
    let mut answer = Reply::of(first.clone(), summary(arguments, &analysed));
    let mut outputs = Outputs::new();
    if arguments.views.are_asked() {
        let shown = AllanAnswer {
            manifest: &manifest("", 0, &inputs)?,
            columns: &analysed.columns,
            unit: &analysed.unit,
            estimator: arguments.estimator.of_library().description(),
            confidence: arguments.confidence,
        };
        let part = of_allan(&shown, first);
        arguments
            .views
            .stage(&arguments.log, part, &mut outputs, &mut answer)?;
    }
    if let Some(path) = &arguments.json {
        let result = AllanReport {
            unit: analysed.unit,
            confidence: arguments.confidence,
            estimator: arguments.estimator.of_library().description(),
            columns: analysed.columns,
        };
        let result = ResultFile::new(manifest("", 0, &inputs)?, result);
        outputs.stage_json(path, &result)?;
    }
    outputs.commit()?;
    if let Some(path) = &arguments.json {
        answer.wrote(path, "the result for programs");
    }
    Ok(answer)
}

/// Analysed columns with their unit, and what there is to tell of the clock.
struct Analysed {
    columns: Vec<AllanColumn>,
    unit: String,
    clock: Option<String>,
}

fn analysed(arguments: &AllanArguments) -> Result<Analysed, InstrumentError> {
    let settings = |rate_hz: f64, scale: f64| AllanSettings {
        rate_hz,
        scale,
        confidence: arguments.confidence,
        estimator: arguments.estimator.of_library(),
    };
    let Some(path) = &arguments.log_description else {
        let names: Vec<&str> = arguments.columns.iter().map(String::as_str).collect();
        let source = SourceText::read(&arguments.log)?;
        // Required without a description.
        let settings = settings(arguments.rate_hz.unwrap_or(1.0), arguments.scale);
        return Ok(Analysed {
            columns: allan_columns(&source, &names, &settings)?,
            unit: arguments.unit.clone(),
            clock: None,
        });
    };
    let log = Log::read(&arguments.log, &Description::read(path)?)?;
    let (scale, unit) = match log.gyro_in_counts {
        true => (1.0, "counts"),
        false => (3600.0 * 1.0_f64.to_degrees(), "deg/h"),
    };
    let settings = settings(1.0 / log.interval_s, scale);
    Ok(Analysed {
        columns: allan_log(&log, ["gyro_x", "gyro_y", "gyro_z"], &settings)?,
        unit: unit.to_owned(),
        clock: log.clock.note(),
    })
}

fn summary(arguments: &AllanArguments, analysed: &Analysed) -> String {
    let mut text = String::new();
    if let Some(note) = &analysed.clock {
        let _ = writeln!(text, "{note}\n");
    }
    for column in &analysed.columns {
        let mut table = table(["tau [s]", "deviation", "low", "high", "freedom", "noise"]);
        for point in &column.points {
            table.add_row([
                right(format!("{:.4}", point.tau_s)),
                right(format!("{:.4e}", point.deviation)),
                right(format!("{:.4e}", point.low)),
                right(format!("{:.4e}", point.high)),
                right(format!("{:.1}", point.degrees_of_freedom)),
                Cell::new(point.noise),
            ]);
        }
        let _ = writeln!(
            text,
            "{}: {} [{}], confidence {}\n\n{}\n\n{}",
            column.name,
            arguments.estimator.of_library().description(),
            analysed.unit,
            arguments.confidence,
            table.trim_fmt(),
            parts(column.noise.as_ref(), &analysed.unit),
        );
    }
    text
}

/// The coefficients with their intervals, and the test of fit.
fn parts(noise: Option<&NoiseFit>, unit: &str) -> String {
    let Some(noise) = noise else {
        return "Parts of the noise: too few averaging times for a fit.\n".to_owned();
    };
    let mut table = table(["part", "coefficient", "95 % interval", "unit"]);
    for coefficient in &noise.coefficients {
        let part = coefficient.part;
        let (estimate, interval) = match (coefficient.estimate, coefficient.interval) {
            (Some(estimate), Some([low, high])) if low > 0.0 => (
                format!("{estimate:.3e}"),
                format!("{low:.3e} to {high:.3e}"),
            ),
            (Some(_), Some([_, high])) => ("not visible".to_owned(), format!("below {high:.3e}")),
            _ => ("not determined".to_owned(), String::new()),
        };
        table.add_row([
            Cell::new(part.description()),
            right(estimate),
            right(interval),
            Cell::new(format!("{unit}{}", part.unit_suffix())),
        ]);
    }
    let [from_s, to_s] = noise.range_s;
    let mut text = format!(
        "{}\n\nFitted from {from_s:.4} to {to_s:.4} s; test of fit: {}. The flat part of a bias \
         instability B is 0.664 B.\n",
        table.trim_fmt(),
        format::p_value(noise.p_value),
    );
    if noise.correlated_samples {
        text.push_str(
            "The samples are correlated for a short time, as by a filter or dither: shorter averaging \
             times are left\nout, and quantisation is not distinguishable from the filter.\n",
        );
    } else if !noise.is_described() {
        text.push_str(
            "The noise is no sum of these parts at any range of averaging times: no coefficient is \
             determined. Look for\nvibration, jumps, or a change of temperature.\n",
        );
    }
    text
}
