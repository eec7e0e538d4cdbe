//! Records in, drift coefficients with covariances out.
//!
//! # What it is
//!
//! [`calibrate`] runs the streaming filter of [`gyrocal`] over a record and says what it
//! found: the nine coefficients, their covariance, how well the record fits the model, and
//! which coefficients the record determined.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_calibration::{Options, calibrate};
//! use gyrocal_record::{Bench, Record};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let record = Record::read("record.csv".as_ref())?;
//! let bench = Bench::read("bench.toml".as_ref())?;
//! let calibration = calibrate(&record, &bench, &Options::default(), |_| ())?;
//! for coefficient in calibration.coefficients() {
//!     println!("{} {} ± {}", coefficient.id, coefficient.estimate, coefficient.sigma);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It reads and writes no files and prints nothing.

mod attitude;
mod averaging;
mod azimuth;
mod batch;
mod calibrate;
mod coefficients;
#[cfg(test)]
mod convergence_tests;
mod cramer_rao;
mod error;
mod extended;
mod fit;
mod further;
mod gross_errors;
mod gyro_axes;
mod initial_guess;
mod initial_trajectory;
mod layout;
mod noise;
mod observability;
mod options;
mod planned_run;
mod problem;
mod result;
mod robust;
mod run;
mod settings;
mod single_run;
mod solve;
mod streaming;
mod uncertainty;

pub use averaging::{AveragedRecord, attitude_walk_share, average_record};
pub use calibrate::{calibrate, calibrate_runs, calibrate_strapdown};
pub use coefficients::BIASES;
pub use cramer_rao::cramer_rao_bound;
pub use error::CalibrationError;
pub use extended::{Estimates, Expectation, Extended, Extension, Jump, NoiseModel};
pub use fit::{Consistency, FitStatistics, chi_square_band};
pub use further::{Column, Further};
pub use gross_errors::gross_errors;
pub use gyro_axes::GyroAxes;
pub use layout::SiteQuantity;
pub use noise::{NoiseEstimate, NoiseRatio};
pub use observability::UnobservableCombination;
pub use options::{Method, Options};
pub use planned_run::{PlannedRun, PredictedInformation};
pub use result::{AzimuthSearch, Calibration, CoefficientEstimate, ConsiderSensitivity, RunResult};
pub use run::Run;
pub use settings::{declared_attitude, filter_settings};
pub use streaming::run_filter;
