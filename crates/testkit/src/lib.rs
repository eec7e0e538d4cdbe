//! Shared support of tests, benches and figures; not part of the library.
//!
//! - Without features: copies of the workspace, cargo and Python as a user would
//!   have them, for tests of the build, tools that a build does not bring (`tools`), and interleaved timing.
//! - `filters`: a platform with any number of states, rounding errors against 400-bit references,
//!   Kalman filters of other packages, and times of a step.
//! - `browser`: a headless browser for pages.
//! - `contracts`: results of all commands against their published schemas.
//! - `calibration`: dense least squares for short records.
//! - `noise`: innovations of records with faulty noise.
//! - `extended`: the controller of `examples/extended` against the catalogue.
//!
//! Each module has more than one user among tests, benches and `cargo figures`; support of a single test
//! stays with that test. What simulates records is in `gyrocal_truth`. Helpers panic when the machine lacks something: that is how a test fails.
#![expect(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::missing_panics_doc,
    clippy::missing_errors_doc,
    clippy::must_use_candidate,
    reason = "a panic of a helper is how its test fails"
)]

#[cfg(feature = "browser")]
pub mod browser;
mod command;
#[cfg(feature = "contracts")]
pub mod contracts;
mod copy;
#[cfg(feature = "calibration")]
pub mod dense_least_squares;
#[cfg(feature = "extended")]
pub mod extended_comparison;
#[cfg(feature = "filters")]
pub mod extended_filter;
#[cfg(feature = "filters")]
pub mod extended_platform;
mod files;
#[cfg(feature = "noise")]
pub mod noise_faults;
#[cfg(feature = "filters")]
pub mod peer_filters;
#[cfg(feature = "filters")]
pub mod rounding_errors;
#[cfg(feature = "filters")]
pub mod step_times;
pub mod timing;
mod tools;

pub use command::{Outcome, cargo, codegen, python_with, real_environments, run, system_python};
pub use copy::{WorkspaceCopy, workspace};
pub use files::{edit, executable, fresh_directory, snapshot};
pub use tools::{Tool, leave_out, programs, tool};
