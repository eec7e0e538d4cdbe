//! An independent simulator of the platform, the reference for calibration and diagnosis.
//!
//! # What it is
//!
//! [`simulate`] makes the record, the bench description and the [`Truth`] of a [`Scenario`];
//! [`Hidden`] effects are in the record and not in the bench description.
//!
//! # The platform
//!
//! Three gyros hold a platform in inertial space on a bench that rotates with the Earth. They
//! drift, so the platform rotates slowly in inertial space. The drift of a gyro is a constant, a
//! part proportional to the specific force along its axis and a part proportional to its square.
//! Three accelerometers on the platform measure gravity, which rotates once a sidereal day in
//! platform axes.
//!
//! # How it is simulated
//!
//! The state is one unit quaternion, the platform against an inertial frame that is local
//! east, north, up at the first row. Its rate is the drift alone. The rotation of the Earth is
//! applied exactly, by one rotation about its axis; gravity is fixed to the rotated frame. The
//! quaternion is integrated by a fourth-order Runge-Kutta rule with steps of at most a minute,
//! shorter for fast changes, exact to 1e-12 rad over days. A step ends where the drift is
//! discontinuous. The simulator has no Euler angles and shares nothing with the generated model,
//! whose equations in Euler angles against an Earth-fixed chart it checks.
//!
//! # Example
//!
//! ```
//! use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};
//!
//! let scenario = Scenario {
//!     seed: 7,
//!     coefficients: Coefficients::PAPER_LIKE,
//!     initial: InitialAttitude::AnglesDeg([10.0, -20.0, 30.0]),
//!     duration_s: 86_400.0,
//!     ..Scenario::default()
//! };
//! let simulation = simulate(&scenario)?;
//! assert_eq!(simulation.record.len(), 1441);
//! let platform_c_enu = simulation.truth.platform_c_enu_last().matrix();
//! // The third column is the vertical in platform axes, which the last sample measures.
//! let sample = simulation.record.accel_g[1440];
//! assert!((sample[0] - platform_c_enu[0][2]).abs() < 6.0 * scenario.accel_noise_g);
//! # Ok::<(), gyrocal_truth::Error>(())
//! ```
//!
//! # Entry points
//!
//! - [`simulate`]: record, bench description and [`Truth`] of a [`Scenario`].
//! - [`Hidden`]: a hidden effect of a scenario, by its id and parameters; [`simulate_with`] adds
//!   [`Term`]s defined by the caller.
//! - [`euler_rule`]: the same by the paper's rule, explicit Euler steps of the three angles.
//! - [`Platform::specific_force_g`]: outputs of ideal accelerometers at given times.
//! - [`Population`]: random scenarios.
//! - Modules behind features of their names: `plant`, simulators of the example plants; `faults`, records with gross
//!   errors, noise that is not normal, and effects that no catalogue holds; `units`, noise and tests of units at rest,
//!   records of strapdown units.
//!
//! The same scenario gives the same record, bit for bit: random numbers are ChaCha with one stream for each
//! seed and purpose, so that hiding an effect leaves all other random numbers as they are; sine,
//! cosine and logarithm are those of `libm` on every machine.
//!
//! # What it does not do
//!
//! It has no estimator and no filter.

mod attitude;
mod check;
mod coefficients;
mod drift;
mod earth_rotation;
mod effect;
mod error;
mod euler_rule;
#[cfg(feature = "faults")]
pub mod faults;
mod gyro_noise;
mod hidden;
mod hidden_file;
mod motion;
mod noise_free;
#[cfg(feature = "plant")]
pub mod plant;
mod platform;
mod population;
mod random;
mod report;
mod sampling;
mod scenario;
mod scenario_file;
mod sensing;
mod simulation;
mod temperature;
mod term;
#[cfg(feature = "units")]
pub mod units;

pub use attitude::Attitude;
pub use coefficients::Coefficients;
pub use error::Error;
pub use euler_rule::euler_rule;
pub use hidden::Hidden;
pub use platform::{EARTH_RATE_RAD_PER_S, Platform};
pub use population::Population;
pub use report::{HiddenReport, ParameterReport, TruthReport};
pub use scenario::{InitialAttitude, Scenario};
pub use simulation::{Simulation, Truth, simulate, simulate_watched, simulate_with};
pub use temperature::Temperature;
pub use term::{Moment, Term};
