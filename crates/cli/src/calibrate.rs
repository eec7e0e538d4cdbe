//! `gyrocal calibrate`: a record and its bench description in, nine drift coefficients out.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use comfy_table::{Cell, CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use gyrocal::generated::MODEL_HASH;
use gyrocal::{EstimationError, Platform};
use gyrocal_calibration::{Calibration, CalibrationError, Options, Verdict, calibrate};
use gyrocal_record::{
    Bench, CalibrationReport, Coefficient, FitVerdict, Record, SCHEMA_VERSION, write_json,
};
use miette::Diagnostic;

use crate::Failure;
use crate::latitude::LatitudeEffect;
use crate::outputs::{manifest, refuse_overlap};
use crate::progress::Progress;
use crate::rounding::rounded;

/// Estimate the nine drift coefficients from a record.
///
/// Prints each coefficient with its standard deviation, and whether the record fits the model
/// within the noise that the bench file declares.
#[derive(Debug, Args)]
pub(crate) struct CalibrateArguments {
    /// The record (CSV): time_s,accel_x_g,accel_y_g,accel_z_g.
    record: PathBuf,
    /// The bench description (TOML); examples/data/three_days.bench.toml is one.
    #[arg(long, value_name = "BENCH.toml")]
    bench: PathBuf,
    /// The result to write for programs (JSON).
    #[arg(long, value_name = "OUT.json")]
    json: Option<PathBuf>,
    /// Filter as the paper does: Euler angles as states, one Euler step a sample. It is right
    /// only for records that were simulated by the same rule.
    #[arg(long)]
    paper: bool,
    /// Carry the covariance as factors: slower, for priors that are too wide otherwise.
    #[arg(long)]
    factorised: bool,
}

/// Runs the command; returns what is to be said on stdout.
pub(crate) fn run(arguments: &CalibrateArguments) -> Result<String, Failure> {
    refuse_overlap(
        &[&arguments.record, &arguments.bench],
        &[("--json", arguments.json.as_deref())],
    )?;
    let bench = Bench::read(&arguments.bench)?;
    let record = Record::read_at_least(&arguments.record, Platform::STATES)?;
    tracing::info!(rows = record.len(), ?bench, "read");
    let mut options = if arguments.paper {
        Options::of_the_paper()
    } else {
        Options::default()
    };
    options.factorised = arguments.factorised;
    let stopped = |source| NotCalibrated {
        record: arguments.record.clone(),
        paper: arguments.paper,
        factorised: arguments.factorised,
        source,
    };
    let mut progress = Progress::new("calibrating", record.len());
    let calibration =
        calibrate(&record, &bench, &options, |row| progress.reach(row)).map_err(stopped)?;
    drop(progress);
    // A fit that is wrong says nothing of such small things.
    let effect = if calibration.fit.verdict() == Verdict::TooLarge {
        None
    } else {
        let mut progress = Progress::new("moving latitude", record.len());
        let reach = |row| progress.reach(row);
        let effect = LatitudeEffect::of(&calibration, &record, &bench, &options, reach);
        Some(effect.map_err(stopped)?)
    };
    tracing::info!(fit = ?calibration.fit, ?effect, "calibrated");
    if let Some(path) = &arguments.json {
        let inputs = [&*arguments.record, &*arguments.bench];
        write_json(path, &report(&calibration, &inputs)?)?;
    }
    Ok(summary(arguments, &record, &calibration, effect))
}

/// The filter could not go through the record.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{}: no calibration", record.display())]
#[diagnostic(code(gyrocal::calibrate::filter), help("{}", self.advice()))]
struct NotCalibrated {
    record: PathBuf,
    paper: bool,
    factorised: bool,
    source: CalibrationError,
}

impl NotCalibrated {
    fn advice(&self) -> &'static str {
        use EstimationError as Filter;

        let lost = match &self.source {
            CalibrationError::TooShort { .. } => return "record for longer",
            CalibrationError::NotPositiveDefinite => true,
            CalibrationError::Filter { source, .. } => matches!(
                source,
                Filter::LostPrecision { .. } | Filter::NotPositiveDefinite { .. }
            ),
            _ => false,
        };
        if self.paper {
            "the paper's filter fails where the second platform angle comes near 90 deg: leave \
             out --paper"
        } else if lost && !self.factorised {
            "the prior is very wide against the noise: give [prior] and initial_angles_sigma_deg \
             the sizes that are believed, or carry the covariance as factors with --factorised"
        } else {
            "the numbers of the bench file are out of proportion to each other or to the record: \
             check [noise], [prior] and initial_angles_sigma_deg"
        }
    }
}

impl From<NotCalibrated> for Failure {
    fn from(error: NotCalibrated) -> Self {
        Self::Work(error.into())
    }
}

fn report(calibration: &Calibration, inputs: &[&Path]) -> Result<CalibrationReport, Failure> {
    let fit = &calibration.fit;
    Ok(CalibrationReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, 0, inputs)?,
        coefficients: calibration
            .coefficients()
            .into_iter()
            .map(|coefficient| Coefficient {
                name: coefficient.id.to_owned(),
                estimate: coefficient.estimate,
                sigma: coefficient.sigma,
                unit: coefficient.unit.to_owned(),
                determined: coefficient.determined,
            })
            .collect(),
        covariance: calibration.covariance.map(Vec::from).to_vec(),
        nis_mean: fit.nis_mean(),
        nis_band: fit.nis_band(),
        verdict: match fit.verdict() {
            Verdict::Consistent => FitVerdict::Consistent,
            Verdict::TooLarge => FitVerdict::TooLarge,
            Verdict::TooSmall => FitVerdict::TooSmall,
        },
        verdict_text: fit.verdict_text(),
        iterations: 1,
        rows: fit.rows(),
        final_angles_deg: calibration.final_angles_rad.map(f64::to_degrees),
    })
}

fn summary(
    arguments: &CalibrateArguments,
    record: &Record,
    calibration: &Calibration,
    effect: Option<LatitudeEffect>,
) -> String {
    let mut text = format!(
        "{}: {} rows over {:.2} days\n\n{}\n\n",
        arguments.record.display(),
        calibration.fit.rows(),
        record.duration_s() / 86_400.0,
        table(calibration).trim_fmt()
    );
    let _ = writeln!(text, "Fit: {}.", calibration.fit.verdict_text());
    let [x, y, z] = calibration.final_angles_rad.map(f64::to_degrees);
    let _ = writeln!(
        text,
        "Platform against east, north, up at the last row: {x:.4}, {y:.4}, {z:.4} deg \
         about x, y, z."
    );
    text.push_str("Latitude is taken as exactly known, and it must be the astronomic one");
    if let Some(effect) = effect {
        let _ = write!(
            text,
            ": an error of 1 arc second moves the\n\
             mean of the three D_I by {:.1e} deg/h/g and a single one by up to {:.1e}, which no \
             sigma includes",
            effect.mean_d_i_deg_per_h_per_g, effect.largest_d_i_deg_per_h_per_g,
        );
    }
    text.push_str(".\n");
    if let Some(path) = &arguments.json {
        let _ = writeln!(text, "{}: the result for programs", path.display());
    }
    text
}

fn table(calibration: &Calibration) -> Table {
    let rule = LineStyle::none().fill('─').junction('─');
    let mut table = Table::new();
    table
        .load_style(TableStyle::new().header_separator(rule))
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_header([
            "coefficient",
            "estimate",
            "sigma",
            "unit",
            "determined",
            "meaning",
        ]);
    for coefficient in calibration.coefficients() {
        let [estimate, sigma] = rounded(coefficient.estimate, coefficient.sigma);
        let right = |text: String| Cell::new(text).set_alignment(CellAlignment::Right);
        table.add_row([
            Cell::new(coefficient.id),
            right(estimate),
            right(sigma),
            Cell::new(coefficient.unit),
            Cell::new(if coefficient.determined { "yes" } else { "no" }),
            Cell::new(coefficient.meaning),
        ]);
    }
    table
}
