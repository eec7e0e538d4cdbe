//! `gyrocal allan`: Allan deviations with confidence intervals of columns of a log.

use std::path::PathBuf;

use clap::Args;
use gyrocal_instruments::{
    AllanReport, AllanSettings, Description, InstrumentError, Log, ResultFile, allan_file,
    allan_log,
};
use gyrocal_pages::of_allan;
use gyrocal_statistics::allan::AllanEstimator;

use crate::measured::unusable;
use crate::numbers::{Choice, one_of, positive, probability};
use crate::outputs::manifest;
use crate::page::Views;
use crate::{Failure, Reply};

/// Allan deviation of columns of a log, and the parts of their noise.
///
/// Each column is a rate sampled at equal intervals. Confidence intervals of the deviations are those of
/// NIST SP 1065, with the degrees of freedom of the dominant noise type at each averaging time. The
/// coefficients are fitted to the samples by the likelihood of their cosine transform, beside tones and a
/// filter, with 95 % intervals and a test of fit. The result for programs has the fitted curve and its parts for a
/// plot.
#[derive(Debug, Args)]
pub(crate) struct AllanArguments {
    /// The log: CSV with a header row, MATLAB, Parquet or MCAP, or as its description says.
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
    /// Estimator of the printed deviations; the coefficients are fitted to the samples.
    #[arg(
        long,
        value_name = "ESTIMATOR",
        default_value = "overlapping",
        value_parser = one_of(ESTIMATORS)
    )]
    estimator: AllanEstimator,
    #[command(flatten)]
    views: Views,
}

/// Values of `--estimator`.
const ESTIMATORS: &[Choice<AllanEstimator>] = &[
    (
        "overlapping",
        "Overlapping Allan deviation",
        AllanEstimator::Overlapping,
    ),
    (
        "total",
        "Total deviation: more degrees of freedom at the longest averaging times",
        AllanEstimator::Total,
    ),
    (
        "hadamard",
        "Overlapping Hadamard deviation: a ramp of the rate does not enter it",
        AllanEstimator::Hadamard,
    ),
];

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &AllanArguments) -> Result<Reply, Failure> {
    let mut inputs = vec![&*arguments.log];
    inputs.extend(arguments.log_description.as_deref());
    arguments.views.check(&inputs, &[])?;
    let (report, clock) = analysed(arguments).map_err(|error| unusable(&arguments.log, error))?;
    let manifest = manifest("", 0, &inputs)?;
    let part = of_allan(&manifest, &report, clock.as_deref());
    let result = ResultFile::new(manifest, report);
    arguments.views.answered(&arguments.log, part, &result)
}

/// Analysed columns, and what there is to tell of the clock.
fn analysed(arguments: &AllanArguments) -> Result<(AllanReport, Option<String>), InstrumentError> {
    let report = |unit: &str, columns| AllanReport {
        unit: unit.to_owned(),
        confidence: arguments.confidence,
        estimator: arguments.estimator.description(),
        columns,
    };
    let settings = |rate_hz: f64, scale: f64| AllanSettings {
        rate_hz,
        scale,
        confidence: arguments.confidence,
        estimator: arguments.estimator,
    };
    let Some(path) = &arguments.log_description else {
        let names: Vec<&str> = arguments.columns.iter().map(String::as_str).collect();
        // Required without a description.
        let settings = settings(arguments.rate_hz.unwrap_or(1.0), arguments.scale);
        let columns = allan_file(&arguments.log, &names, &settings)?;
        return Ok((report(&arguments.unit, columns), None));
    };
    let log = Log::read(&arguments.log, &Description::read(path)?)?;
    let (scale, unit) = match log.gyro_in_counts {
        true => (1.0, "counts"),
        false => (3600.0 * 1.0_f64.to_degrees(), "deg/h"),
    };
    let settings = settings(1.0 / log.interval_s, scale);
    let columns = allan_log(&log, ["gyro_x", "gyro_y", "gyro_z"], &settings)?;
    Ok((report(unit, columns), log.clock.note()))
}
