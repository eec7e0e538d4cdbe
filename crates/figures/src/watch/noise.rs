use chacha20::ChaCha12Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// True noise of a platform, whose declared one is white and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Noise {
    /// As declared.
    Declared,
    /// Normal and white, but larger by this factor.
    Larger(f64),
    /// Autoregressive of first order with this coefficient, of the declared variance.
    Correlated(f64),
    /// That of accelerometers is Student's with four degrees of freedom, of the declared variance.
    Student4,
    /// That of gyros and accelerometers is. Outliers of gyros are jumps of the attitude: a sample of
    /// sixty sigma, of which a year has some, turns the platform by as much as jumps that are looked for.
    Student4Both,
}

/// Six noises a sample, and three steps of walks when they are asked for.
#[derive(Debug)]
pub(super) struct Source {
    /// ChaCha12: see [`gyrocal_statistics::deviates`].
    generator: ChaCha12Rng,
    noise: Noise,
    before: [f64; 6],
}

impl Source {
    pub(super) fn new(seed: u64, stream: u64, noise: Noise) -> Self {
        let mut generator = ChaCha12Rng::seed_from_u64(seed);
        generator.set_stream(stream);
        Self {
            generator,
            noise,
            before: [0.0; 6],
        }
    }

    fn uniform(&mut self) -> f64 {
        const SPACING: f64 = 1.0 / (1_u64 << 52) as f64;
        ((self.generator.next_u64() >> 12) as f64 + 0.5) * SPACING
    }

    fn two_normals(&mut self) -> [f64; 2] {
        let radius = (-2.0 * self.uniform().ln()).sqrt();
        let (sine, cosine) = (core::f64::consts::TAU * self.uniform()).sin_cos();
        [radius * cosine, radius * sine]
    }

    pub(super) fn normals<const N: usize>(&mut self) -> [f64; N] {
        let mut normals = [0.0; N];
        for pair in normals.chunks_mut(2) {
            let two = self.two_normals();
            pair.copy_from_slice(&two[..pair.len()]);
        }
        normals
    }

    /// Noise of three gyros and three accelerometers, in units of the declared sigma.
    pub(super) fn sample(&mut self) -> [f64; 6] {
        let mut normals: [f64; 6] = self.normals();
        match self.noise {
            Noise::Declared => {}
            Noise::Larger(factor) => normals = normals.map(|normal| factor * normal),
            Noise::Correlated(coefficient) => {
                let fresh = (1.0 - coefficient * coefficient).sqrt();
                for (normal, before) in normals.iter_mut().zip(&mut self.before) {
                    *normal = coefficient * *before + fresh * *normal;
                    *before = *normal;
                }
            }
            Noise::Student4 | Noise::Student4Both => {
                let first = if self.noise == Noise::Student4 { 3 } else { 0 };
                for normal in &mut normals[first..] {
                    // χ² with four degrees of freedom; the variance of the quotient is 2.
                    let chi_square = -2.0 * (self.uniform() * self.uniform()).ln();
                    *normal *= (2.0 / chi_square).sqrt();
                }
            }
        }
        normals
    }
}
