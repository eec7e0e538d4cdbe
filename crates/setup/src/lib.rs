//! Gross errors of a set-up: what a record shows to be wrong before anything is fitted to it.
//!
//! # What it is
//!
//! [`check_setup`] looks at a record and its bench description and returns a [`SetupCheck`]: the
//! gross errors that it finds, each a [`SetupFinding`], and the record with what can be mended left
//! out. No model is fitted, and the cost is linear in the rows. Where the rows alone cannot decide
//! between two signs of the latitude, the check says so, and whoever fits models decides.
//!
//! # The domain in brief
//!
//! The accelerometers of a platform that gyros hold in inertial space read gravity, whose direction
//! turns once a sidereal day against the platform. So three things are known whatever the gyros do:
//! the magnitude is that of gravity; the direction moves smoothly and at the rate of the Earth; and
//! the turn has the sense and, with declared angles, the axis that latitude and attitude give it.
//! A gross error is a use of the instrument, or a description of it, that contradicts one of these
//! by far more than the gyros' drift or the noise can. `docs/setup-checks.md` lists all kinds.
//!
//! Axes permuted and signed, with determinant −1, and the other sign of the latitude fit every
//! record alike if no angles are declared; both are told together.
//!
//! # Example
//!
//! ```
//! use gyrocal_setup::{SetupKind, check_setup};
//! use gyrocal_truth::{InitialAttitude, Scenario, simulate};
//!
//! let scenario = Scenario { initial: InitialAttitude::Random, ..Scenario::default() };
//! let mut simulation = simulate(&scenario)?;
//! assert!(check_setup(&simulation.record, &simulation.bench).findings.is_empty());
//!
//! simulation.bench.latitude_deg *= -1.0;
//! let check = check_setup(&simulation.record, &simulation.bench);
//! assert_eq!(check.findings[0].kind, SetupKind::Latitude);
//! assert!(check.usable.is_none());
//! # Ok::<(), gyrocal_truth::Error>(())
//! ```
//!
//! # What it does not do
//!
//! It reads and prints nothing and fits no model. What is smaller than a gross error is left to the
//! diagnosis: jumps under two degrees, delayed columns, sidereal clocks.

mod attitude;
mod check;
mod clipped;
mod clock_order;
mod coded;
mod convention;
mod duplicated;
mod finding;
mod gravity;
mod jump;
mod kind;
mod missing;
mod motion;
mod noise;
mod platform_kind;
mod prior;
mod rate;
mod repeated;
mod rotation;
mod samples;
mod scale;
mod signed_axes;
mod stuck;
mod temperature;
mod text;
mod turn;
mod unit;
mod vector;

pub use check::{SetupCheck, check_setup, check_setup_of};
pub use finding::{Correction, SetupFinding};
pub use kind::SetupKind;
pub use noise::shown_noise_g;
pub use platform_kind::PlatformKind;
pub use rate::LEAST_TURN_S;
pub use signed_axes::SignedAxes;
