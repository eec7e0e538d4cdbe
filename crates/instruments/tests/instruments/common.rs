//! Logs of a unit whose motion and errors are known.

use gyrocal_instruments::Log;
use gyrocal_statistics::deviates::Normals;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

pub(crate) const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;

/// Normal deviates of a seed.
pub(crate) struct Noise(Normals);

impl Noise {
    pub(crate) fn of_seed(seed: u64) -> Self {
        Self(Normals::of_seed(seed))
    }

    pub(crate) fn uniform(&mut self) -> f64 {
        self.0.uniform()
    }

    pub(crate) fn normal(&mut self) -> f64 {
        self.0.normal()
    }

    pub(crate) fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.normal(), self.normal(), self.normal())
    }
}

/// A log of samples at equal intervals, rad/s and g.
pub(crate) fn log(interval_s: f64, samples: &[(Vector3<f64>, Vector3<f64>)]) -> Log {
    let gyro = samples.iter().map(|(rate, _)| (*rate).into());
    let accel = samples.iter().map(|(_, force)| (*force).into());
    Log::from_samples(interval_s, gyro.collect(), accel.collect())
}

/// Errors of a unit, by which true rates and forces become a log.
pub(crate) struct Unit {
    pub(crate) gyro_matrix: Matrix3<f64>,
    pub(crate) gyro_zero: Vector3<f64>,
    /// Drift of the gyros per g \[rad/s/g\], a row for each gyro.
    pub(crate) g_sensitivity: Matrix3<f64>,
    pub(crate) gyro_noise: f64,
    pub(crate) accel_noise: f64,
}

impl Unit {
    /// A MEMS unit: bias of 0.3 deg/s, noise as that of an Xsens.
    pub(crate) fn mems() -> Self {
        Self {
            gyro_matrix: Matrix3::identity(),
            gyro_zero: Vector3::new(0.005, -0.004, 0.003),
            g_sensitivity: Matrix3::zeros(),
            gyro_noise: 0.006,
            accel_noise: 1e-3,
        }
    }
}

/// Stops of five seconds with turns of two seconds between them, at 100 Hz.
pub(crate) fn stops_and_turns(stops: usize, unit: &Unit, seed: u64) -> Log {
    const INTERVAL_S: f64 = 0.01;
    const STOP: usize = 500;
    const TURN: usize = 200;
    let mut noise = Noise::of_seed(seed);
    let mut samples = Vec::new();
    let mut level_c_body = UnitQuaternion::from_scaled_axis(noise.vector());
    let mut sample = |rate: Vector3<f64>, level_c_body: &UnitQuaternion<f64>, noise: &mut Noise| {
        let force = level_c_body.inverse() * Vector3::z();
        let gyro = unit.gyro_matrix * rate
            + unit.gyro_zero
            + unit.g_sensitivity * force
            + unit.gyro_noise * noise.vector();
        samples.push((gyro, force + unit.accel_noise * noise.vector()));
    };
    for stop in 0..stops {
        for _ in 0..STOP {
            sample(Vector3::zeros(), &level_c_body, &mut noise);
        }
        if stop + 1 == stops {
            break;
        }
        let axis = noise.vector().normalize();
        let angle = 1.0 + 1.5 * noise.uniform();
        // Fast in the middle, slow at the ends; the axis stays, so increments are exact.
        let passed = |step: usize| {
            let share = step as f64 / TURN as f64;
            angle * (share - (core::f64::consts::TAU * share).sin() / core::f64::consts::TAU)
        };
        for step in 0..TURN {
            let increment = axis * (passed(step + 1) - passed(step));
            level_c_body *= UnitQuaternion::from_scaled_axis(increment);
            sample(increment / INTERVAL_S, &level_c_body, &mut noise);
        }
    }
    log(INTERVAL_S, &samples)
}
