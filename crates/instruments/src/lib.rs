//! Instrument tests: calibration and tests of gyros and accelerometers from logs of real sensors.
//!
//! # What it is
//!
//! - [`Log`] and [`Description`]: samples of gyros and accelerometers from a file whose columns, units and axes a
//!   TOML file describes.
//! - [`read_record`] and [`average_file`]: the record of a stable platform from a described file of any such
//!   format.
//! - [`find_stops`] and [`stop_means`]: intervals at rest, and means over them with standard errors for
//!   coloured noise.
//! - [`accel_from_norm`] and [`gyro_from_turns`]: scales, zeros and alignment of raw counts, from the norm
//!   of gravity at rest and from the turns between stops.
//! - [`multi_position`]: the multi-position test (tumble test). A unit is stopped in many attitudes; the
//!   drift law is fitted to its gyro outputs at rest and extended by significant terms.
//! - [`rates`]: logs in the rate domain. Gyro outputs at rest or on a turntable against Earth rate, known
//!   rates, specific force, temperature and time; biases may be of any size.
//! - [`strapdown`]: the import of a strapdown unit at rest as an analytic platform, the space-stable
//!   platform that the rest of `gyrocal` calibrates.
//!
//! # The domain in brief
//!
//! A gyro at rest reads its drift and its component of Earth rate. The drift depends on specific force,
//! and so on the attitude to gravity: many attitudes determine many terms of the drift law (the
//! multi-position test); one attitude determines one number for each gyro, whatever its duration.
//! Outputs in raw counts need scales. The norm of gravity determines those of accelerometers. Turns
//! between stops, whose integrated rate must rotate gravity from one stop to the next, determine those
//! of gyros.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_instruments::multi_position::{MultiPositionSettings, multi_position_test, prepare};
//! use gyrocal_instruments::{Description, Log, StopSettings, find_stops};
//!
//! # fn main() -> Result<(), gyrocal_instruments::InstrumentError> {
//! let description = Description::read("log.toml".as_ref())?;
//! let log = Log::read("log.csv".as_ref(), &description)?;
//! let stops = find_stops(&log, &StopSettings::default())?;
//! let prepared = prepare(&log, &description, &stops)?;
//! let report = multi_position_test(&prepared.positions, &MultiPositionSettings::default())?;
//! for finding in &report.findings {
//!     println!("{} {} ± {}", finding.effect, finding.estimate, finding.sigma);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It prints nothing and writes no files. It knows no filter and no simulator. It repairs no log: gaps,
//! clocks that jump, wrong units and left-handed axes are errors.

mod accel_from_norm;
mod accel_from_positions;
mod allan_analysis;
mod bad_samples;
mod binary_file;
mod cell;
mod clock;
mod columns;
mod covariates;
mod date_time;
pub mod description;
mod earth_rate;
mod error;
mod fast_noise;
pub mod file_format;
mod gyro_from_turns;
mod interval_noise;
mod least_squares;
mod log;
mod log_lines;
mod matlab_file;
#[cfg(feature = "mcap")]
mod mcap_file;
pub mod multi_position;
#[cfg(feature = "parquet")]
mod parquet_file;
mod platform_average;
mod platform_record;
mod platform_row;
mod proposal;
pub mod rates;
mod remedy;
mod result_file;
#[cfg(feature = "mcap")]
mod ros_message;
mod row_time;
mod scale;
mod selection;
mod stop_means;
mod stops;
pub mod strapdown;
mod typed_file;

pub use accel_from_norm::{AccelCalibration, accel_from_norm, refuse_wrong_norm};
pub use accel_from_positions::{AccelCoefficient, AccelErrors, accel_from_positions};
pub use allan_analysis::{
    AllanColumn, AllanColumnPoint, AllanReport, AllanSettings, LeftOut, allan_file, allan_log,
    allan_values,
};
pub use bad_samples::BadSample;
pub use clock::Clock;
pub use columns::{Columns, read_columns, read_described};
pub use covariates::Saturated;
pub use description::Description;
pub use error::{InstrumentError, Unfit};
pub use gyro_from_turns::{GyroCalibration, gyro_from_turns};
pub use log::{BadSamples, Log};
pub use platform_average::{AveragedRecordFile, LONGEST_STREAMED_S, average_file};
pub use platform_record::{parse_record, read_any, read_record};
pub use proposal::propose_map;
pub use result_file::ResultFile;
pub use stop_means::{StopMeans, stop_means};
pub use stops::{StopSettings, find_stops, given_stops};
