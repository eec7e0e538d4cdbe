//! Random deviates: streams of ChaCha, the same on every machine.
//!
//! There are two generators, and neither takes the place of the other: a seed gives the same record and
//! the same figures for ever. ChaCha12, the standard generator of `rand`, has the simulators, noise that is
//! added to a record, and permutations of measured stops. ChaCha8, which takes two thirds of its time and is
//! as random to a statistic, has what methods draw (null distributions, expected sets) and what an
//! evaluation chooses ([`Draw`]).

use core::f64::consts::TAU;

use chacha20::rand_core::{Rng, SeedableRng};
use chacha20::{ChaCha8Rng, ChaCha12Rng};

use crate::math::{ln, pow};

/// Spacing of uniform deviates of 53 bits.
const SPACING: f64 = 1.0 / (1_u64 << 53) as f64;

/// A standard normal deviate of two uniform ones, the first greater than 0 (Box and Muller). The
/// cosine is that of `libm`, not of [`crate::math`], whose last bit may differ: a seed gives the same
/// record for ever.
#[must_use]
pub fn box_muller([radius, angle]: [f64; 2]) -> f64 {
    (-2.0 * ln(radius)).sqrt() * libm::cos(TAU * angle)
}

/// A standard normal deviate by the polar method (Marsaglia).
pub fn polar(generator: &mut impl Rng) -> f64 {
    let mut uniform = || (generator.next_u64() >> 11) as f64 * (2.0 * SPACING) - 1.0;
    loop {
        let (x, y) = (uniform(), uniform());
        let square = x * x + y * y;
        if square < 1.0 && square > 0.0 {
            return x * (-2.0 * ln(square) / square).sqrt();
        }
    }
}

/// Random numbers of one seed and one purpose, which choose what is simulated.
#[derive(Debug)]
pub struct Draw(ChaCha8Rng);

impl Draw {
    /// The stream of a seed for a purpose.
    #[must_use]
    pub fn new(seed: u64, purpose: u64) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        generator.set_stream(purpose);
        Self(generator)
    }

    /// Uniform, at least 0 and less than 1.
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * SPACING
    }

    /// Uniform in the logarithm between two positive numbers.
    pub fn log_uniform(&mut self, [low, high]: [f64; 2]) -> f64 {
        low * pow(high / low, self.uniform())
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = 1.0 - self.uniform();
        box_muller([radius, self.uniform()])
    }

    /// 1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.uniform() < 0.5 { -1.0 } else { 1.0 }
    }

    /// One of some things.
    ///
    /// # Panics
    /// If there are none.
    pub fn one_of<'a, T>(&mut self, things: &'a [T]) -> &'a T {
        &things[(self.uniform() * things.len() as f64) as usize]
    }
}

/// Normal and uniform deviates of one seed, for simulated noise.
#[derive(Debug)]
pub struct Normals(ChaCha12Rng);

impl Normals {
    /// The deviates of a seed.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        Self(ChaCha12Rng::seed_from_u64(seed))
    }

    /// Uniform between 0 and 1, neither included.
    pub fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) * SPACING
    }

    /// Normal with mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        box_muller([self.uniform(), self.uniform()])
    }

    /// Rows of three normal deviates.
    pub fn rows(&mut self, count: usize) -> Vec<[f64; 3]> {
        (0..count)
            .map(|_| core::array::from_fn(|_| self.normal()))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moments of many deviates: 0, 1, 0 and 3 within four of their standard errors.
    fn assert_normal(mut draw: impl FnMut() -> f64) {
        const COUNT: u32 = 100_000;
        let mut sums = [0.0; 4];
        for _ in 0..COUNT {
            let value = draw();
            for (sum, power) in sums.iter_mut().zip(1..) {
                *sum += value.powi(power);
            }
        }
        let count = f64::from(COUNT);
        // Variances of the powers 1 to 4 of a standard normal variable.
        let expected = [(0.0, 1.0), (1.0, 2.0), (0.0, 15.0), (3.0, 96.0)];
        for (sum, (mean, variance)) in sums.iter().zip(expected) {
            let allowed = 4.0 * f64::sqrt(variance / count);
            assert!((sum / count - mean).abs() < allowed, "{sums:?}");
        }
    }

    #[test]
    fn deviates_of_every_kind_are_normal() {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        assert_normal(|| polar(&mut generator));
        let mut draw = Draw::new(1, 2);
        assert_normal(|| draw.normal());
        let mut normals = Normals::of_seed(1);
        assert_normal(|| normals.normal());
    }

    #[test]
    fn a_seed_gives_the_same_numbers_for_ever() {
        // Records of evaluations depend on these.
        let mut generator = ChaCha8Rng::seed_from_u64(7);
        let mut draw = Draw::new(7, 1);
        let mut normals = Normals::of_seed(7);
        let found = [polar(&mut generator), draw.normal(), normals.normal()];
        assert_eq!(
            found,
            [
                -0.312_907_562_149_297_4,
                3.106_882_642_827_655_2,
                -0.928_243_581_796_784_1
            ]
        );
    }
}
