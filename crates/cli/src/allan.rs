//! `gyrocal allan`: Allan deviations with confidence intervals of columns of a log.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use comfy_table::Cell;
use gyrocal_instruments::{InstrumentError, ResultFile, Unfit, read_columns};
use gyrocal_record::{InputErrorKind, SourceText, write_json};
use gyrocal_statistics::allan::{
    AllanPoint, NoiseCoefficients, allan_deviation, noise_coefficients, octaves,
};
use serde_json::json;

use crate::Failure;
use crate::measured::unusable;
use crate::numbers::{positive, probability};
use crate::outputs::{self, manifest};
use crate::tables::{right, table};

/// Overlapping Allan deviation of columns of a log.
///
/// Each column is a rate sampled at equal intervals. Confidence intervals are those of NIST SP
/// 1065, with the degrees of freedom of the dominant noise type at each averaging time.
#[derive(Debug, Args)]
pub(crate) struct AllanArguments {
    /// The log (CSV) with a header row.
    log: PathBuf,
    /// The columns.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    columns: Vec<String>,
    /// Samples per second.
    #[arg(long, value_name = "HZ", value_parser = positive)]
    rate_hz: f64,
    /// Factor of the values, for example 206264.8 for deg/h from rad/s.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive)]
    scale: f64,
    /// Unit of the scaled values, for the output.
    #[arg(long, value_name = "UNIT", default_value = "units of the column")]
    unit: String,
    /// Confidence level of the intervals.
    #[arg(long, value_name = "P", default_value_t = 0.683, value_parser = probability)]
    confidence: f64,
    /// Write the result for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
}

/// One column's result.
struct Column<'a> {
    name: &'a str,
    points: Vec<AllanPoint>,
    noise: NoiseCoefficients,
}

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &AllanArguments) -> Result<String, Failure> {
    outputs::check(&[&arguments.log], arguments.json.as_deref(), None)?;
    let columns = work(arguments).map_err(|error| unusable(&arguments.log, error))?;
    if let Some(path) = &arguments.json {
        let result = json!({
            "unit": arguments.unit,
            "confidence": arguments.confidence,
            "columns": columns.iter().map(document).collect::<Vec<_>>(),
        });
        write_json(
            path,
            &ResultFile::new(manifest("", 0, &[&arguments.log])?, result),
        )?;
    }
    Ok(summary(arguments, &columns))
}

fn work(arguments: &AllanArguments) -> Result<Vec<Column<'_>>, InstrumentError> {
    let source = SourceText::read(&arguments.log)?;
    let names: Vec<&str> = arguments.columns.iter().map(String::as_str).collect();
    let columns = read_columns(&source, &names)?.values;
    let interval_s = 1.0 / arguments.rate_hz;
    names
        .into_iter()
        .zip(columns)
        .map(|(name, values)| {
            if values.len() > 1 && values.windows(2).all(|pair| pair[0] == pair[1]) {
                return Err(constant(&source, name));
            }
            let values: Vec<f64> = values.iter().map(|value| value * arguments.scale).collect();
            if values.iter().any(|value| !value.is_finite()) {
                return Err(overflow(name, arguments.scale));
            }
            let averaging = octaves(values.len().max(3));
            let points = allan_deviation(&values, interval_s, &averaging, arguments.confidence)?;
            let noise = noise_coefficients(&points);
            Ok(Column {
                name,
                points,
                noise,
            })
        })
        .collect()
}

fn overflow(name: &str, scale: f64) -> InstrumentError {
    InstrumentError::Unfit {
        kind: Unfit::Setting,
        found: format!("values of `{name}` that are too large when multiplied by {scale:e}"),
        expected: "finite numbers".to_owned(),
        advice: "give a smaller --scale".to_owned(),
    }
}

fn constant(source: &SourceText, name: &str) -> InstrumentError {
    let error = source.error(
        InputErrorKind::Stuck,
        0..0,
        format!("a column `{name}` that never changes"),
        "samples of a rate, which has noise",
        "check the sensor and the logger",
    );
    error.into()
}

fn document(column: &Column<'_>) -> serde_json::Value {
    let points: Vec<_> = column
        .points
        .iter()
        .map(|point| {
            json!({
                "tau_s": point.tau_s,
                "deviation": point.deviation,
                "low": point.interval[0],
                "high": point.interval[1],
                "degrees_of_freedom": point.degrees_of_freedom,
                "noise": point.noise.description(),
            })
        })
        .collect();
    json!({ "name": column.name, "points": points, "noise": column.noise })
}

fn summary(arguments: &AllanArguments, columns: &[Column<'_>]) -> String {
    let mut text = String::new();
    for column in columns {
        let mut table = table(["tau [s]", "deviation", "low", "high", "freedom", "noise"]);
        for point in &column.points {
            table.add_row([
                right(format!("{:.4}", point.tau_s)),
                right(format!("{:.4e}", point.deviation)),
                right(format!("{:.4e}", point.interval[0])),
                right(format!("{:.4e}", point.interval[1])),
                right(format!("{:.1}", point.degrees_of_freedom)),
                Cell::new(point.noise.description()),
            ]);
        }
        let noise = &column.noise;
        let _ = writeln!(
            text,
            "{}: overlapping Allan deviation [{}], confidence {}\n\n{}\n\nNoise coefficients: \
             quantisation {:.3e} × s, random walk {:.3e} × √s, bias instability {:.3e},\nrate \
             random walk {:.3e} / √s (0: not visible).\n",
            column.name,
            arguments.unit,
            arguments.confidence,
            table.trim_fmt(),
            noise.quantisation,
            noise.random_walk,
            noise.bias_instability,
            noise.rate_random_walk,
        );
    }
    if let Some(path) = &arguments.json {
        let _ = writeln!(text, "{}: the result for programs", path.display());
    }
    text
}
