//! Watched platforms by the thousand.
//!
//! The gains of a filter do not depend on the noise. So one run of the real filter over a record
//! without noise gives the closed loop of a platform, through which errors of many realisations of the
//! noise go in linear simulation ([`Platform`]); each has the scores of its own innovations beside the
//! signatures that all share ([`Lane`]). Effects enter by the specific force of the simulator and not
//! by the courses that the watch foretells.

#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

mod delays;
mod knocks;
mod lane;
mod noise;
mod platform;
mod sizes;
mod sound;

pub use delays::{Delay, Trial, delays};
pub use knocks::{Knocked, knocks};
pub use lane::{Injected, Lane};
pub use noise::Noise;
pub use platform::Platform;
pub use sound::{Sound, sound};
