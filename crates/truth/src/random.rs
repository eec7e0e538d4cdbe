//! Random numbers: one ChaCha stream for each seed and purpose.

use chacha20::ChaCha12Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use libm::{log, sincos};

use crate::attitude::Attitude;

/// The generator of a seed and a stream. ChaCha12: see `gyrocal_statistics::deviates`.
pub(crate) fn generator(seed: u64, stream: u64) -> ChaCha12Rng {
    let mut generator = ChaCha12Rng::seed_from_u64(seed);
    generator.set_stream(stream);
    generator
}

/// Purpose of a stream of random numbers. Drawing more or fewer for one purpose changes no other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// An initial attitude anywhere.
    InitialAttitude,
    /// The error of the declared initial angles.
    InitialAngles,
    /// The gyros' noise.
    GyroNoise,
    /// The accelerometers' noise.
    AccelNoise,
    /// Missing components.
    Missing,
    /// A rate random walk of the gyros.
    RandomWalk,
    /// Places and signs of outliers.
    Outliers,
    /// The course of the temperature.
    Temperature,
    /// A scenario of a population, by its number.
    Scenario(u64),
}

/// A stream of random numbers.
pub(crate) struct Stream {
    generator: ChaCha12Rng,
    /// Normal deviates come in pairs.
    second: Option<f64>,
}

impl Stream {
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        /// Streams below are for single scenarios.
        const FIRST_OF_POPULATION: u64 = 1 << 32;
        let stream = match purpose {
            Purpose::InitialAttitude => 0,
            Purpose::InitialAngles => 1,
            Purpose::GyroNoise => 2,
            Purpose::AccelNoise => 3,
            Purpose::Missing => 4,
            Purpose::RandomWalk => 5,
            Purpose::Outliers => 6,
            Purpose::Temperature => 7,
            Purpose::Scenario(number) => FIRST_OF_POPULATION.wrapping_add(number),
        };
        Self {
            generator: generator(seed, stream),
            second: None,
        }
    }

    /// Any whole number that fits a TOML integer.
    pub(crate) fn whole(&mut self) -> u64 {
        self.generator.next_u64() >> 1
    }

    /// Uniform between 0 and 1, neither included.
    pub(crate) fn uniform(&mut self) -> f64 {
        const SPACING: f64 = 1.0 / (1_u64 << 52) as f64;
        ((self.generator.next_u64() >> 12) as f64 + 0.5) * SPACING
    }

    /// Uniform between two limits.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// One of some things, each with the same probability; `None` of an empty list.
    pub(crate) fn one_of<'a, T>(&mut self, things: &'a [T]) -> Option<&'a T> {
        // The uniform number is less than 1, so the product is less than the length.
        things.get((self.uniform() * things.len() as f64) as usize)
    }

    /// Normal with mean 0 and standard deviation 1, by Box and Muller with `libm`, so that the
    /// bits are the same on every machine.
    pub(crate) fn normal(&mut self) -> f64 {
        if let Some(second) = self.second.take() {
            return second;
        }
        let radius = (-2.0 * log(self.uniform())).sqrt();
        let angle = core::f64::consts::TAU * self.uniform();
        let (sine, cosine) = sincos(angle);
        self.second = Some(radius * sine);
        radius * cosine
    }

    /// Three normal deviates.
    pub(crate) fn three_normals(&mut self) -> [f64; 3] {
        core::array::from_fn(|_| self.normal())
    }

    /// Uniform over the rotation group: the direction of four normals.
    pub(crate) fn attitude(&mut self) -> Attitude {
        let w = self.normal();
        Attitude::from_quaternion(w, self.three_normals())
    }
}
