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
mod batch;
mod begin;
mod bound;
mod calibrate;
mod error;
mod extended;
mod fit;
mod further;
mod gyro_axes;
mod imagined;
mod layout;
mod noise;
mod observability;
mod problem;
mod result;
mod robust;
mod run;
mod settings;
mod solve;
mod spikes;
mod start;
mod streaming;
mod uncertainty;

pub use averaging::{Averaged, average, walk_share};
pub use bound::bound;
pub use calibrate::{Method, Options, calibrate, calibrate_runs, calibrate_strapdown};
pub use error::CalibrationError;
pub use extended::{Estimates, Expectation, Extended, Extension, Jump, NoiseModel};
pub use fit::{Consistency, FitStatistics, chi_square_band};
pub use further::{Column, Further};
pub use gyro_axes::GyroAxes;
pub use imagined::{Foreseen, ImaginedRun};
pub use layout::{BIASES, SiteQuantity};
pub use noise::{NoiseEstimate, NoiseRatio};
pub use observability::Undetermined;
pub use result::{AzimuthSearch, Calibration, CoefficientEstimate, RunResult, SiteInfluence};
pub use run::Run;
pub use settings::settings;
pub use spikes::spikes;
pub use streaming::pass;

/// Number of drift coefficients.
const PARAMETERS: usize = gyrocal::Platform::PARAMETERS;
