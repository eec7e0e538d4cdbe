//! Noise of the drift.

use crate::effect::Effect;
use crate::random::{Purpose, Stream};
use crate::scenario::Scenario;

/// White noise and rate random walk of the three gyros, interval by interval.
pub(crate) struct GyroNoise {
    white: Stream,
    held_deg_per_h: [f64; 3],
    walk: Option<Walk>,
}

/// A Brownian motion of the drift itself, 0 at the first row.
struct Walk {
    steps: Stream,
    size_deg_per_h_per_sqrt_h: [f64; 3],
    now_deg_per_h: [f64; 3],
}

impl GyroNoise {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let mut held_deg_per_h = [scenario.held_gyro_noise_deg_per_h(); 3];
        let mut size_deg_per_h_per_sqrt_h = [0.0; 3];
        for hidden in &scenario.hidden {
            match hidden.effect() {
                Effect::GyroNoise(gyro) => held_deg_per_h[gyro] *= hidden.value(0),
                Effect::GyroRandomWalk(gyro) => size_deg_per_h_per_sqrt_h[gyro] = hidden.value(0),
                _ => {}
            }
        }
        let walks = size_deg_per_h_per_sqrt_h != [0.0; 3];
        Self {
            white: Stream::new(scenario.seed, Purpose::GyroNoise),
            held_deg_per_h,
            walk: walks.then(|| Walk {
                steps: Stream::new(scenario.seed, Purpose::RandomWalk),
                size_deg_per_h_per_sqrt_h,
                now_deg_per_h: [0.0; 3],
            }),
        }
    }

    /// The mean of the noise over the next interval \[deg/h\].
    pub(crate) fn next_deg_per_h(&mut self, interval_s: f64) -> [f64; 3] {
        let normals = self.white.three_normals();
        let mut mean = core::array::from_fn(|gyro| self.held_deg_per_h[gyro] * normals[gyro]);
        if let Some(walk) = &mut self.walk {
            let drift = walk.next_deg_per_h(interval_s);
            mean = core::array::from_fn(|gyro| mean[gyro] + drift[gyro]);
        }
        mean
    }

    /// Present value of the random walk \[deg/h\].
    pub(crate) fn walk_deg_per_h(&self) -> [f64; 3] {
        let walk = self.walk.as_ref();
        walk.map_or([0.0; 3], |walk| walk.now_deg_per_h)
    }
}

impl Walk {
    /// Advances by an interval and returns the mean over it.
    fn next_deg_per_h(&mut self, interval_s: f64) -> [f64; 3] {
        let root_h = (interval_s / 3600.0).sqrt();
        let (increments, bridges) = (self.steps.three_normals(), self.steps.three_normals());
        core::array::from_fn(|gyro| {
            let sigma = self.size_deg_per_h_per_sqrt_h[gyro] * root_h;
            let now = &mut self.now_deg_per_h[gyro];
            let (mean, end) = walked(*now, sigma, [increments[gyro], bridges[gyro]]);
            *now = end;
            mean
        })
    }
}

/// Mean over an interval and end of a Brownian motion that changes by `sigma` in it, from two normal deviates. They
/// have its joint distribution: the mean is half of the increment, and an independent part of variance Δt/12.
pub(crate) fn walked(before: f64, sigma: f64, [increment, bridge]: [f64; 2]) -> (f64, f64) {
    let mean = before + sigma * (0.5 * increment + bridge / 12.0_f64.sqrt());
    (mean, before + sigma * increment)
}
