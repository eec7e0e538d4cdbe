use gyrocal_statistics::deviates::Draw;

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

/// Six noises a sample, and normal deviates when they are asked for.
#[derive(Debug)]
pub(super) struct Source {
    draw: Draw,
    noise: Noise,
    before: [f64; 6],
}

impl Source {
    pub(super) fn new(draw: Draw, noise: Noise) -> Self {
        let before = [0.0; 6];
        Self {
            draw,
            noise,
            before,
        }
    }

    pub(super) fn normals<const N: usize>(&mut self) -> [f64; N] {
        core::array::from_fn(|_| self.draw.normal())
    }

    /// Noise of three gyros and three accelerometers, in units of the declared sigma.
    pub(super) fn sample(&mut self) -> [f64; 6] {
        let normals = self.normals();
        match self.noise {
            Noise::Declared => normals,
            Noise::Larger(factor) => normals.map(|normal| factor * normal),
            Noise::Correlated(coefficient) => {
                let fresh = (1.0 - coefficient * coefficient).sqrt();
                let before = self.before.map(|before| coefficient * before);
                self.before = core::array::from_fn(|at| before[at] + fresh * normals[at]);
                self.before
            }
            Noise::Student4 | Noise::Student4Both => core::array::from_fn(|place| {
                if place < 3 && self.noise == Noise::Student4 {
                    return normals[place];
                }
                // χ² with four degrees of freedom; the variance of the quotient is 2.
                let squares = self.normals::<4>().map(|normal| normal * normal);
                let chi_square: f64 = squares.iter().sum();
                normals[place] * (2.0 / chi_square).sqrt()
            }),
        }
    }
}
