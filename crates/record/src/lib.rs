//! File formats: records, bench descriptions, model files and results; errors with file, line and
//! column.
//!
//! # What it is
//!
//! A *record* is a time series of the accelerometers of a platform that its gyros hold in inertial
//! space: a CSV file with the header `time_s,accel_x_g,accel_y_g,accel_z_g` and optionally
//! `temperature_c` ([`Record`]). Specific force is in units of local gravity, up positive: an
//! accelerometer at rest with its axis up reads +1. Rows may be missing, sampling may be irregular,
//! time need not start at zero, and a missing value is `nan`.
//!
//! A *bench description* is a TOML file with the latitude, initial attitude, noise and priors of the
//! record ([`Bench`]); a *model file* is a TOML file with the effects of an extended model
//! ([`ModelFile`]).
//!
//! *Results* are JSON, for example [`CalibrationReport`], with a [`Manifest`] of the program and its
//! inputs. `docs/formats.md` describes all files.
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
//! A fault of a file is an [`Error`] with file, line, column, the value found, the value expected
//! and advice. It is a [`miette::Diagnostic`], so a program with miette's `fancy` feature shows the
//! line with a mark at the position.
//!
//! # What it does not do
//!
//! It prints nothing, checks plausibility only, and has no filter. Output files are written whole or
//! not at all ([`Outputs`]).

mod bench;
mod bound;
mod clock;
mod coefficient_table;
mod content;
mod document;
mod error;
mod excerpt;
mod extension_report;
pub mod fields;
mod gimbals;
mod header;
#[cfg(feature = "schema")]
mod json_schema;
mod manifest;
mod model_file;
mod module_name;
mod noise_ratio;
mod output;
mod plausible;
mod printable;
mod record;
mod record_file;
mod report;
mod result_table;
mod rows;
mod setup;
mod site;
mod source;
mod suggest;
mod swapped;
mod table;
mod temporary;
mod white_noise;
mod words;

pub use bench::{Bench, Prior};
pub use bound::Bound;
pub use clock::{ClockFault, UNNAMED, restarts};
pub use content::{
    LARGE_MIB, LARGE_RATIO, digest_of_text, is_encoding, keep_streams, open_content, open_text,
    read_content,
};
pub use document::Document;
pub use error::{Error, InputError, InputErrorKind};
pub use extension_report::{ExtensionReport, LeftOut};
pub use gimbals::GimbalLimits;
#[cfg(feature = "schema")]
pub use json_schema::written_schema;
pub use manifest::{Input, InputRole, Manifest};
pub use model_file::{Gyros, KnownEffect, ModelFile, ParameterEstimate, Standing};
pub use module_name::module_name;
pub use noise_ratio::{NoiseDifference, NoiseEstimate, NoiseRatio};
pub use output::{Outputs, file_behind, write_json, write_whole};
pub use plausible::most_equal;
pub use printable::{printable, printable_line, printable_path, shell_quoted};
pub use record::Record;
pub use record_file::RecordFile;
pub use report::{
    AveragedReport, AzimuthReport, CALIBRATION_SCHEMA_VERSION, CalibrationMethod,
    CalibrationReport, Coefficient, EffectTest, FitVerdict, FittedEffect, FittedEffects,
    FittedParameter, NamedCause, OtherAzimuth, RecordReport, RunReport, SCHEMA_VERSION,
    SimulationReport, SiteReport, TrueCoefficient, TurnOn, UndeterminedReport,
};
pub use result_table::ResultTable;
pub use setup::SetupProblem;
pub use site::{Gravity, Site, SiteUncertainty};
pub use source::SourceText;
pub use suggest::{any_of, nearest_names, similar_names};
pub use table::Table;
pub use white_noise::WhiteNoise;
pub use words::{capitalised, counted};

/// Letters of the axes, in the order of every array of three: keys of tables and parts of names.
pub const AXES: [&str; 3] = ["x", "y", "z"];
