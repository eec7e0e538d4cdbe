//! Random scenarios.

use crate::coefficients::Coefficients;
use crate::random::{Purpose, Stream};
use crate::scenario::{InitialAttitude, Scenario};

/// A population of scenarios: any attitude, and uniform distributions for the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Population {
    /// Seed of the population; scenarios get their own from it.
    pub seed: u64,
    /// Largest latitude, north and south.
    pub largest_latitude_deg: f64,
    /// Largest constant drift of a gyro, of either sign.
    pub largest_bias_deg_per_h: f64,
    /// Largest drift proportional to specific force, of either sign.
    pub largest_g_deg_per_h_per_g: f64,
    /// Largest drift proportional to its square, of either sign.
    pub largest_gg_deg_per_h_per_g2: f64,
    /// Shortest and longest record.
    pub duration_days: [f64; 2],
    /// What scenarios have in common: noise, interval, prior, sigma of the initial angles.
    pub common: Scenario,
}

impl Population {
    /// The usual population: any attitude, latitude to 80°, drifts to 1 deg/h,
    /// 0.3 deg/h/g and 0.15 deg/h/g², one to fourteen days each minute.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self {
            seed,
            largest_latitude_deg: 80.0,
            largest_bias_deg_per_h: 1.0,
            largest_g_deg_per_h_per_g: 0.3,
            largest_gg_deg_per_h_per_g2: 0.15,
            duration_days: [1.0, 14.0],
            common: Scenario::default(),
        }
    }

    /// The scenario of a number; each has its own stream, so they can be drawn in any order.
    #[must_use]
    pub fn scenario(&self, number: u64) -> Scenario {
        let mut stream = Stream::new(self.seed, Purpose::Scenario(number));
        let mut three = |largest: f64| -> [f64; 3] {
            core::array::from_fn(|_| stream.between(-largest, largest))
        };
        let coefficients = Coefficients {
            bias_deg_per_h: three(self.largest_bias_deg_per_h),
            g_deg_per_h_per_g: three(self.largest_g_deg_per_h_per_g),
            gg_deg_per_h_per_g2: three(self.largest_gg_deg_per_h_per_g2),
        };
        let latitude_deg = stream.between(-self.largest_latitude_deg, self.largest_latitude_deg);
        let days = stream.between(self.duration_days[0], self.duration_days[1]);
        let interval_s = self.common.interval_s;
        Scenario {
            seed: stream.whole(),
            latitude_deg,
            coefficients,
            initial: InitialAttitude::Random,
            duration_s: (days * 86_400.0 / interval_s).floor() * interval_s,
            ..self.common.clone()
        }
    }
}
