//! Independent simulators of the example plants.
//!
//! # What it is
//!
//! Each module simulates one plant of `examples/` from its physics, with effects that the nominal model
//! lacks ([`simulate`]), and says how large they are ([`strength`]). Nothing here knows a model, its program
//! or its diagnosis; effects have the names that a diagnosis should find.
//!
//! # What it does not do
//!
//! It has no estimator. The simulator of the gyros' platform is `gyrocal-truth`.

mod cart_pole;
mod duffing;
mod population;
mod quadrotor;
mod random;
mod run;
mod servo;
mod setting;
mod strength;
mod tanks;

pub use random::Stream;
pub use run::Run;
pub use setting::{Facts, Kind, Setting};
pub use strength::{strength, with_strength};

/// The record of a setting. With `replayed` inputs nothing is fed back.
#[must_use]
pub fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    match setting.kind {
        Kind::Duffing => duffing::simulate(setting, replayed),
        Kind::Tanks => tanks::simulate(setting, replayed),
        Kind::Servo => servo::simulate(setting, replayed),
        Kind::CartPole => cart_pole::simulate(setting, replayed),
        Kind::Quadrotor => quadrotor::simulate(setting, replayed),
    }
}
