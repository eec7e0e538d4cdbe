//! Independent simulators of the example plants.
//!
//! Each module simulates one plant of `examples/` from its physics, with effects that the nominal model
//! lacks ([`simulate`]), and says how large they are ([`strength`]). Nothing here knows a model, its program
//! or its diagnosis; effects have the names that a diagnosis should find.

mod cart_pole;
mod duffing;
mod quadrotor;
mod run;
mod servo;
mod setting;
mod strength;
mod tanks;

use chacha20::ChaCha12Rng;
use chacha20::rand_core::Rng as _;

pub use run::Run;
pub use setting::{Facts, Kind, Setting};
pub use strength::{strength, with_strength};

/// The record of a setting. With `replayed` inputs nothing is fed back.
#[must_use]
pub fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    (setting.kind.facts().simulate)(setting, replayed)
}

/// A stream of random numbers. Its deviates are not those of the platform's simulator, which have one bit
/// less and come in pairs: records would change.
#[derive(Debug)]
pub struct Stream(ChaCha12Rng);

impl Stream {
    /// The stream of a seed for a purpose.
    #[must_use]
    pub fn new(seed: u64, purpose: u64) -> Self {
        Self(crate::random::generator(seed, purpose))
    }

    /// Uniform, greater than 0 and at most 1.
    pub fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform in the logarithm between two positive numbers.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * libm::pow(high / low, self.uniform())
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(self.uniform()));
        radius * libm::cos(core::f64::consts::TAU * self.uniform())
    }
}
