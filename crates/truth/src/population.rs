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
    /// Times between rows, of which each scenario has one; that of `common` if there are none.
    pub intervals_s: Vec<f64>,
    /// Most gaps in a record; any number from none has the same probability.
    pub most_gaps: u32,
    /// Shortest and longest gap.
    pub gap_s: [f64; 2],
    /// Values common to all scenarios: noise, interval, prior, sigma of the initial angles.
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
            intervals_s: Vec::new(),
            most_gaps: 0,
            gap_s: [600.0, 21_600.0],
            common: Scenario::default(),
        }
    }

    /// A population of varied sampling: the usual one, but two to seven days, sampled each 10, 30,
    /// 60 or 120 s, with up to three gaps of ten minutes to six hours.
    #[must_use]
    pub fn varied(seed: u64) -> Self {
        Self {
            duration_days: [2.0, 7.0],
            intervals_s: vec![10.0, 30.0, 60.0, 120.0],
            most_gaps: 3,
            ..Self::new(seed)
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
        let seed = stream.whole();
        let drawn = stream.one_of(&self.intervals_s).copied();
        let interval_s = drawn.unwrap_or(self.common.interval_s);
        let duration_s = (days * 86_400.0 / interval_s).floor() * interval_s;
        let mut gaps_s = self.common.gaps_s.clone();
        gaps_s.extend(self.gaps_s(&mut stream, duration_s));
        Scenario {
            seed,
            latitude_deg,
            coefficients,
            initial: InitialAttitude::Random,
            interval_s,
            duration_s,
            gaps_s,
            ..self.common.clone()
        }
    }

    /// Gaps anywhere after the first row and before the last.
    fn gaps_s(&self, stream: &mut Stream, duration_s: f64) -> Vec<[f64; 2]> {
        let count = (stream.uniform() * f64::from(self.most_gaps + 1)).floor() as u32;
        let gap = |_| {
            let length_s = stream.between(self.gap_s[0], self.gap_s[1]);
            let from_s = stream.between(0.0, duration_s - length_s);
            [from_s, from_s + length_s]
        };
        let gaps = (0..count).map(gap);
        gaps.filter(|gap: &[f64; 2]| gap[0] > 0.0).collect()
    }
}
