//! `gyrocal allan`: Allan deviations with confidence intervals of columns of a log.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use comfy_table::Cell;
use gyrocal_instruments::{AllanColumn, AllanSettings, InstrumentError, ResultFile, allan_columns};
use gyrocal_record::{SourceText, write_json};
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

/// Runs the command; returns the text for stdout.
pub(crate) fn run(arguments: &AllanArguments) -> Result<String, Failure> {
    outputs::check(&[&arguments.log], arguments.json.as_deref(), None)?;
    let settings = AllanSettings {
        rate_hz: arguments.rate_hz,
        scale: arguments.scale,
        confidence: arguments.confidence,
    };
    let names: Vec<&str> = arguments.columns.iter().map(String::as_str).collect();
    let columns = SourceText::read(&arguments.log)
        .map_err(InstrumentError::from)
        .and_then(|source| allan_columns(&source, &names, &settings))
        .map_err(|error| unusable(&arguments.log, error))?;
    if let Some(path) = &arguments.json {
        let result = json!({
            "unit": arguments.unit,
            "confidence": arguments.confidence,
            "columns": columns,
        });
        write_json(
            path,
            &ResultFile::new(manifest("", 0, &[&arguments.log])?, result),
        )?;
    }
    Ok(summary(arguments, &columns))
}

fn summary(arguments: &AllanArguments, columns: &[AllanColumn]) -> String {
    let mut text = String::new();
    for column in columns {
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
