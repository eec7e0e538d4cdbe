//! Recordings of real inertial sensors: what they say of the gyros, without any simulator.
//!
//! # What it is
//!
//! - [`tumble`]: the multi-position drift test. A unit is stopped in many attitudes; the drift
//!   law is fitted to what its gyros say at rest, and extended while that is better than chance.
//! - [`strapdown`]: the analytic platform. A strapdown unit at rest becomes, in software, the
//!   space-stable platform that the rest of `gyrocal` calibrates.
//!
//! Logs are CSV files; a [`Description`] says what their columns mean.
//!
//! # The domain in brief
//!
//! A gyro at rest reads its drift and its share of Earth rate. The drift depends on specific
//! force, which the attitude to gravity sets: many attitudes determine many terms (the
//! multi-position test), one attitude determines one number for each gyro, however long it is
//! held. Outputs in raw counts need scales: the norm of gravity gives those of accelerometers,
//! turns between stops, which must take gravity from one stop to the next, those of gyros.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_instruments::tumble::{TumbleSettings, prepare, tumble};
//! use gyrocal_instruments::{Description, Log, StopSettings, find_stops};
//!
//! # fn main() -> Result<(), gyrocal_instruments::MeasuredError> {
//! let description = Description::read("log.toml".as_ref())?;
//! let log = Log::read("log.csv".as_ref(), &description)?;
//! let stops = find_stops(&log, &StopSettings::default())?;
//! let prepared = prepare(&log, &description, &stops)?;
//! let report = tumble(&prepared.positions, &TumbleSettings::default())?;
//! for finding in &report.findings {
//!     println!("{} {} ± {}", finding.effect, finding.estimate, finding.sigma);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It prints nothing and writes no files. It knows no filter. It repairs no log: gaps, clocks that
//! jump, wrong units and left-handed axes are errors that say what was found.

mod average;
mod columns;
pub mod description;
mod error;
mod least_squares;
mod log;
mod norms;
mod result_file;
mod stops;
pub mod strapdown;
pub mod tumble;
mod turns;

pub use average::{Stop, average};
pub use columns::read_columns;
pub use description::Description;
pub use error::{MeasuredError, Unfit};
pub use log::Log;
pub use norms::{AccelCalibration, calibrate_by_norm, refuse_wrong_norm};
pub use result_file::ResultFile;
pub use stops::{StopSettings, find_stops, given_stops};
pub use turns::{GyroCalibration, calibrate_by_turns};
