//! Logs of units at rest and on a turntable, with the means that are the truth of an evaluation.

use gyrocal_instruments::Log;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::vector;
use gyrocal_truth::units::sensor_noise::SensorNoise;
use nalgebra::{Matrix3, Vector3};

/// A degree per hour in rad/s.
pub(super) const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// Earth rate \[deg/h\].
pub(super) const EARTH_DEG_PER_H: f64 = 15.041_07;

/// Standard deviation of the level by the biases of the accelerometers \[rad\].
pub(super) const LEVEL_RAD: f64 = 0.01 * core::f64::consts::PI / 180.0;

/// Standard deviation of a sample of ordinary accelerometers \[g\].
pub(super) const ACCEL_NOISE_G: f64 = 1e-3;

/// A unit, and the site.
#[derive(Debug, Clone, Default)]
pub(super) struct Unit {
    /// Errors of the gyros \[deg/h\].
    pub(super) bias: Vector3<f64>,
    /// Output of the gyros per rate about each axis, less that of exact ones.
    pub(super) matrix_error: Matrix3<f64>,
    /// Rate of the gyros per g along each axis \[deg/h/g\].
    pub(super) of_force: Matrix3<f64>,
    /// Standard deviation of the mean rate over a second \[deg/h\].
    pub(super) white: f64,
    /// White noise of the angle \[deg/h s\].
    pub(super) quantisation: f64,
    /// Bias instability \[deg/h\].
    pub(super) flicker: f64,
    /// Change of the rate in a second \[deg/h\].
    pub(super) walk: f64,
    /// Step of the outputs over the standard deviation of the noise of a sample.
    pub(super) step: f64,
    /// Standard deviations of the biases of the accelerometers, and of their samples \[g\].
    pub(super) accel: [f64; 2],
    /// Latitude.
    pub(super) latitude_deg: f64,
}

/// A log, and the mean of the biases of the gyros with their slow changes \[deg/h\].
pub(super) struct Made {
    pub(super) log: Log,
    pub(super) mean_bias: Vector3<f64>,
}

impl Unit {
    /// Noise as of any grade, in proportion to the white one, with ordinary accelerometers and outputs in steps,
    /// somewhere on Earth.
    pub(super) fn of_any_grade(white: f64, draw: &mut Draw) -> Self {
        Self {
            white,
            quantisation: white * draw.log_uniform([1e-3, 0.1]),
            flicker: white * draw.log_uniform([3e-3, 0.1]),
            walk: white * draw.log_uniform([1e-5, 1e-3]),
            step: draw.log_uniform([0.1, 1.0]),
            accel: [LEVEL_RAD, ACCEL_NOISE_G],
            latitude_deg: 120.0 * draw.uniform() - 60.0,
            ..Self::default()
        }
    }

    /// The vertical part of the Earth rate \[deg/h\].
    pub(super) fn vertical_earth(&self) -> f64 {
        EARTH_DEG_PER_H * self.latitude_deg.to_radians().sin()
    }

    /// A log of whole seconds at `rate_hz` with specific force along `up`, on a table that turns about it at
    /// `table` \[rad/s\] of the second. Flicker and walk change from second to second.
    pub(super) fn log(
        &self,
        up: Vector3<f64>,
        [seconds, rate_hz]: [usize; 2],
        table: impl Fn(usize) -> f64,
        draw: &mut Draw,
        seed: u64,
    ) -> Made {
        let slow = SensorNoise {
            bias_instability: self.flicker,
            rate_random_walk: self.walk,
            ..SensorNoise::default()
        };
        let slow: [Vec<f64>; 3] =
            core::array::from_fn(|axis| slow.rates(seconds, 10 * seed + axis as u64));
        let rate_of = |second: usize| Vector3::from_fn(|axis, _| slow[axis][second]);
        let (sine, cosine) = self.latitude_deg.to_radians().sin_cos();
        let north = vector(draw).cross(&up).normalize();
        let east = north.cross(&up);
        let interval_s = 1.0 / rate_hz as f64;
        let white = self.white * (rate_hz as f64).sqrt();
        let angle_noise = self.quantisation / interval_s;
        let step = self.step * white.hypot(angle_noise);
        let [accel_bias, accel_noise] = self.accel;
        let accel_bias = accel_bias * vector(draw);
        let mut before = angle_noise * vector(draw);
        let mut angle = 0.0_f64;
        let (mut gyro, mut accel) = (Vec::new(), Vec::new());
        for second in 0..seconds {
            let drift = self.bias + self.of_force * up + rate_of(second);
            for _ in 0..rate_hz {
                let table = table(second);
                angle += table * interval_s;
                let horizontal = angle.cos() * north + angle.sin() * east;
                let earth = EARTH_DEG_PER_H * (sine * up + cosine * horizontal);
                let after = angle_noise * vector(draw);
                let noise = white * vector(draw) + after - before;
                before = after;
                let rate = earth + up * (table / DEG_PER_H);
                let rate = rate + self.matrix_error * rate + drift + noise;
                let output = match step > 0.0 {
                    true => rate.map(|rate| (rate / step).round() * step),
                    false => rate,
                };
                gyro.push((DEG_PER_H * output).into());
                accel.push((up + accel_bias + accel_noise * vector(draw)).into());
            }
        }
        let mean = (0..seconds).map(rate_of).sum::<Vector3<f64>>() / seconds as f64;
        Made {
            log: Log::from_samples(interval_s, gyro, accel),
            mean_bias: self.bias + self.of_force * up + mean,
        }
    }
}
