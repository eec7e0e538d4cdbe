//! Generated model and streaming filter of an inertially stabilised platform, for controllers and
//! hosts.
//!
//! # What it is
//!
//! An extended Kalman filter that estimates the nine drift coefficients of three gyros from
//! the accelerometers of the platform that the gyros stabilise. Dynamics, measurement and
//! their exact Jacobians are generated from a symbolic model (`codegen/derive`); the kernel is
//! that of [`gyrocal_estimation`]. Nothing here allocates or needs the standard library.
//!
//! # The domain in brief
//!
//! On a static base the servo loops hold the platform to its gyros. With the gyros un-torqued
//! the platform keeps its attitude in inertial space but for gyro drift, so in platform axes
//! gravity rotates once a sidereal day. The drift of a gyro with specific force `a` along its
//! input axis is
//!
//! ```text
//! omega_d = D_F + D_I a + D_II a² + ε        [deg/h]
//! ```
//!
//! and the rotation makes all three coefficients observable in the accelerometers within days
//! (Li Zhong, *The method of calibrating gyroscope drift in the geometrical stability state of
//! inertial stabilized platform*, Geophysical and Geochemical Exploration 39(S1), 2015).
//!
//! | frame | axes |
//! |---|---|
//! | `enu` | East, North, Up at the site; fixed to the Earth |
//! | `chart` | fixed to the Earth; the filter moves it onto the platform at every step |
//! | `platform` | input axes of the gyros and sensitive axes of the accelerometers |
//!
//! `platform_c_enu` is the matrix that takes components along `enu` to components along
//! `platform`. Specific force is positive up: an accelerometer at rest with its axis up
//! reads +1 g, g being local gravity.
//!
//! # Example
//!
//! ```
//! use gyrocal::{FilterSettings, InitialAttitude, PlatformFilter, Site};
//!
//! # fn main() -> Result<(), gyrocal::EstimationError> {
//! let settings = FilterSettings::<f64> {
//!     accel_noise_g: 1e-5,
//!     drift_noise_deg_per_h: 0.002,
//!     ..FilterSettings::at_site(Site::at_latitude_deg(39.1))
//! };
//! let mut filter = PlatformFilter::new(&settings, &InitialAttitude::aligned())?;
//! filter.update(&[0.0, 0.0, 1.0])?; // the first sample belongs to the initial attitude
//! let innovation = filter.step(60.0, &[0.003_4, 0.0, 0.999_99])?;
//! assert!(innovation.nis < 16.3, "NIS of three components, 99.9 %");
//! let gyro_x_bias_deg_per_h = filter.drift().gyro_x_bias;
//! assert!(filter.drift_sigma().gyro_x_bias < 1.0);
//! # let _ = gyro_x_bias_deg_per_h;
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! - `derive` (default): the build derives the model again when its symbolic sources were
//!   edited; an unchanged tree builds without Python. Embedders turn default features off and
//!   compile the committed Rust, without any generator.
//! - `std` (default): fused multiply-add where the target has it.
//! - `batch`: attitudes as points of a trajectory, for estimation from whole records.
//! - `catalogue`: the platform with every effect of the catalogue, and the table of effects.
//! - `watch`: sequential diagnosis beside the filter (`watch::WatchedFilter`).
//! - `oracle`: slow, exact functions for tests.
//!
//! # What it does not do
//!
//! It reads no files, averages no samples and tests no residuals: records, batch estimation and
//! diagnosis are in other crates of the workspace. It models a static base only.

#![no_std]

mod anchor;
mod chart_vectors;
mod controller;
mod controller_error;
mod extension;
mod filter;
pub mod generated;
mod initial_attitude;
mod limits;
mod orientation;
mod regressors;
mod rotation;
mod saved;
mod settings;
mod site;
#[cfg(feature = "watch")]
pub mod watch;

#[cfg(feature = "batch")]
pub mod trajectory;

pub use anchor::{Anchored, Chart};
pub use chart_vectors::{ChartInputs, ChartVectors};
pub use controller::ControllerFilter;
pub use controller_error::ControllerError;
pub use extension::{ExtensionFilter, ExtensionKernel};
pub use filter::{FactorisedPlatformFilter, PlatformFilter};
#[cfg(feature = "catalogue")]
pub use generated::catalogue::{Catalogue, EFFECTS};
pub use generated::platform::{Drift, Platform};
pub use gyrocal_estimation::{
    self as estimation, EstimationError, Innovation, Integration, Precision, Recentring,
};
pub use gyrocal_scalar::{self as scalar, Real, Scalar};
pub use initial_attitude::{ChartAngles, InitialAttitude};
pub use limits::Limits;
pub use regressors::Regressors;
pub use saved::{SavedForm, SavedNumber};
pub use settings::{Discretisation, FilterSettings};
pub use site::{EARTH_RATE_RAD_PER_S, Site};

// emit: off
#[cfg(feature = "source")]
pub mod source;

pub use generated::strapdown::Strapdown;
#[cfg(feature = "catalogue")]
pub use generated::strapdown_catalogue::StrapdownCatalogue;
pub use generated::surveyed::Surveyed;
pub use gyrocal_scalar::effect::{self, Effect};
// emit: on

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
