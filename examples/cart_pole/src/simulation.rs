//! A cart and pole of its own making: energy and momentum by hand, nothing of the generated code.

use crate::random::Random;
use crate::{GUSTS, MEAN, PRIOR, SENSORS};

/// Interval between samples, s.
pub const STEP_S: f64 = 0.01;
/// Steps of the integration in an interval; gusts are drawn anew in each.
const SUBSTEPS: usize = 10;

/// A simulated cart.
pub struct CartAndPole {
    /// Position, angle, velocity, rate, friction of the cart, of the pole.
    pub state: [f64; 6],
    random: Random,
    time_s: f64,
}

impl CartAndPole {
    /// A cart at rest; its place and friction are drawn about those that the filter starts from.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let state = core::array::from_fn(|i| MEAN[i] + PRIOR[i] * random.normal());
        Self {
            state,
            random,
            time_s: 0.0,
        }
    }

    /// The force of the drive over the next interval, N: two tones.
    #[must_use]
    pub fn force(&self) -> f64 {
        4.0 * (3.0 * self.time_s).sin() + 3.0 * (7.0 * self.time_s).cos()
    }

    /// Moves on by an interval and reads the sensors.
    pub fn step(&mut self) -> [f64; 2] {
        let force = self.force();
        let dt = STEP_S / SUBSTEPS as f64;
        for _ in 0..SUBSTEPS {
            let gust = [0, 1].map(|i| (GUSTS[i] / dt).sqrt() * self.random.normal());
            let push = [force + gust[0], gust[1]];
            // The midpoint rule: errors of 1e-7 in a step of a millisecond.
            let half = self.rates(&self.state, push);
            let middle = core::array::from_fn(|i| self.state[i] + 0.5 * dt * half[i]);
            let rates = self.rates(&middle, push);
            for (state, rate) in self.state.iter_mut().zip(rates) {
                *state += dt * rate;
            }
        }
        self.time_s += STEP_S;
        [0, 1].map(|i| self.state[i] + SENSORS[i].sqrt() * self.random.normal())
    }

    fn rates(&self, state: &[f64; 6], [force, torque]: [f64; 2]) -> [f64; 6] {
        let [_, theta, velocity, rate, b, c] = *state;
        let (sine, cosine) = theta.sin_cos();
        // Generalised forces over the determinant of the mass matrix, for masses of 1 and 0.2 kg
        // and a length of 0.5 m.
        let along = force - b * velocity + 0.1 * rate * rate * sine;
        let about = torque - c * rate - 0.981 * sine;
        let determinant = 0.06 - 0.01 * cosine * cosine;
        let acceleration = (0.05 * along - 0.1 * cosine * about) / determinant;
        let turning = (1.2 * about - 0.1 * cosine * along) / determinant;
        [velocity, rate, acceleration, turning, 0.0, 0.0]
    }
}
