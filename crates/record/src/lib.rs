//! The files of `gyrocal`: records, bench descriptions, results, and errors that point into them.
//!
//! # The files
//!
//! A *record* is what the platform's accelerometers said while its gyros held it in inertial
//! space: a CSV file with the header `time_s,accel_x_g,accel_y_g,accel_z_g` and, if a
//! thermometer was logged, `temperature_c`. Specific force is in units of local gravity, up
//! positive: an accelerometer at rest with its axis up reads +1. Rows may be missing, sampling
//! may be irregular, time need not start at zero, and an accelerometer that has no value says
//! `nan`.
//!
//! A *bench description* stands beside it: a TOML file with latitude, initial attitude and
//! noise ([`Bench`]).
//!
//! *Results* are JSON ([`CalibrationReport`]), with a [`Manifest`] that says which program made
//! them from which inputs.
//!
//! # Example
//!
//! ```
//! use gyrocal_record::{Bench, Record};
//!
//! let record = Record::parse(
//!     "time_s,accel_x_g,accel_y_g,accel_z_g\n0,0.0,0.0,1.0\n60,nan,0.001,1.0\n",
//!     "tiny.csv",
//! )?;
//! assert_eq!(record.len(), 2);
//! assert!(record.accel_g[1][0].is_nan());
//!
//! let wrong = Record::parse("time_s,accel_x_g,accel_y_g,accel_z_g\n0,zero,0,1\n", "tiny.csv");
//! assert!(wrong.unwrap_err().to_string().starts_with("tiny.csv:2:3: found `zero`"));
//!
//! let bench = Bench::parse(
//!     "[site]\nlatitude_deg = 39.1\n\
//!      [platform]\ninitial_angles_deg = [0.0, 0.0, 0.0]\n\
//!      initial_angles_sigma_deg = [0.01, 0.01, 0.01]\n\
//!      [noise]\naccel_g = 1e-5\ngyro_deg_per_h = 0.002\n",
//!     "tiny.toml",
//! )?;
//! assert_eq!(bench.prior.bias_sigma_deg_per_h, [1.0; 3]);
//! # Ok::<(), gyrocal_record::Error>(())
//! ```
//!
//! # Errors
//!
//! Whatever is wrong with a file is an [`Error`] that names file, line, column, what was found,
//! what was expected and what to do. It is a [`miette::Diagnostic`], so a program with
//! miette's `fancy` feature shows the line itself with a mark under the place.
//!
//! # What it does not do
//!
//! It prints nothing, interprets nothing beyond plausibility, and knows no filter. Output files
//! are written whole or not at all ([`Outputs`]).

mod bench;
mod channel_report;
mod diagnosis_report;
mod error;
pub mod fields;
mod gain_report;
mod gimbals;
mod header;
mod manifest;
mod model_file;
mod output;
mod plan_report;
mod record;
mod report;
mod residuals_report;
mod rows;
mod source;
mod suggest;
mod tables;

pub use bench::{Bench, Gravity, Prior, SiteUncertainty};
pub use channel_report::{AllanCourse, AllanPointReport, AllanReport, NormReport};
pub use diagnosis_report::{
    CannotTellReport, DiagnosisReport, DiagnosisVerdict, EquivalentReport, FilterReport,
    FindingReport, NotSearchedReport, ParameterReport, RankedReport, RemainderReport,
    RemainderVerdict, RivalReport,
};
pub use error::{Error, InputError, InputErrorKind};
pub use gain_report::{
    CompensationReport, FreeRunReport, GainReport, ShiftReport, ValidationReport,
};
pub use gimbals::GimbalLimits;
pub use manifest::{Input, Manifest};
pub use model_file::{KnownEffect, ModelFile, ParameterEstimate, Standing};
pub use output::{Outputs, write_json, write_whole};
pub use plan_report::{
    GoalReport, OutlookReport, PlanAim, PlanReport, ProposalReport, SetMemberReport, SetReport,
    SigmaReport,
};
pub use record::Record;
pub use report::{
    AveragedReport, AzimuthReport, CalibrationMethod, CalibrationReport, Coefficient, FitVerdict,
    NoiseRatioReport, NoiseReport, OtherAzimuth, RunReport, SCHEMA_VERSION, SimulationReport,
    SiteReport, TrueCoefficient, TurnOn, UndeterminedReport,
};
pub use residuals_report::{
    AgainstReport, AutocorrelationReport, LineReport, NisReport, ResidualsReport,
};
pub use source::SourceText;
pub use suggest::nearest_few;
pub use tables::{Bound, Document, Table};
