//! Records of the platform that is computed from the outputs of a strapdown unit, with the axes of its
//! instruments.

use std::path::Path;

use gyrocal_record::{Bench, Prior, Record, write_whole};
use gyrocal_statistics::deviates::Normals;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use crate::platform::EARTH_RATE_RAD_PER_S;
use crate::scenario::Scenario;

const LATITUDE_DEG: f64 = 39.1;
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
const GYRO_DEG_PER_H: f64 = 0.002;
const ACCEL_G: f64 = 1e-5;
const DAY_S: f64 = 86_400.0;

/// A record, its bench description and the axes of the instruments.
#[derive(Clone, Debug)]
pub struct StrapdownUnit {
    /// Specific force along the platform, whose axes are East, North, Up at the first row.
    pub record: Record,
    /// Its bench description, the same of all.
    pub bench: Bench,
    /// Unit quaternions (w, x, y, z) that take components along the body to components along the platform,
    /// one for each row.
    pub platform_q_body: Vec<[f64; 4]>,
}

/// What a unit does, and how its instruments err.
pub struct UnitRun<'a> {
    /// Rotation vector that takes components along the body to East, North, Up at the first row, rad.
    pub attitude_rad: [f64; 3],
    /// Turn of the body against the Earth, along its axes, rad/s.
    pub turn_rad_per_s: [f64; 3],
    /// Time between two rows, s.
    pub interval_s: f64,
    /// Number of rows.
    pub rows: usize,
    /// Seed of the noise.
    pub seed: u64,
    /// Errors of the gyros by the specific force along the body in g and the time in days, deg/h.
    pub gyro_error: &'a dyn Fn([f64; 3], f64) -> [f64; 3],
    /// Errors of the accelerometers by the same, g.
    pub accel_error: &'a dyn Fn([f64; 3], f64) -> [f64; 3],
}

impl UnitRun<'_> {
    /// The bench description of all records: angles of zero, known to 0.02 degrees.
    fn bench() -> Bench {
        let scenario = Scenario {
            latitude_deg: LATITUDE_DEG,
            initial_angles_sigma_deg: [0.02; 3],
            accel_noise_g: ACCEL_G,
            gyro_noise_deg_per_h: GYRO_DEG_PER_H,
            prior: Prior {
                bias_sigma_deg_per_h: [1.0; 3],
                g_sigma_deg_per_h_per_g: [1.0; 3],
                gg_sigma_deg_per_h_per_g2: [1.0; 3],
                ..Prior::default()
            },
            ..Scenario::default()
        };
        scenario.bench()
    }

    /// The record. What the gyros read over an interval is the exact rotation between two rows, with the
    /// errors of its middle.
    #[must_use]
    pub fn simulate(&self) -> StrapdownUnit {
        let mut normals = Normals::of_seed(self.seed);
        let mut noise = |size: f64| Vector3::from_fn(|_, _| size * normals.normal());
        let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
        let earth = Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
        let turned = |rate: Vector3<f64>, time_s| UnitQuaternion::from_scaled_axis(rate * time_s);
        let first = turned(self.attitude_rad.into(), 1.0);
        let enu_c_body = |time_s| first * turned(self.turn_rad_per_s.into(), time_s);
        let inertial_c_body = |time_s| turned(earth, time_s) * enu_c_body(time_s);
        let force = |time_s| enu_c_body(time_s).inverse() * Vector3::z();
        let held = GYRO_DEG_PER_H * (60.0 / self.interval_s).sqrt();
        let mut platform_c_body = first;
        let mut unit = StrapdownUnit {
            record: Record::default(),
            bench: Self::bench(),
            platform_q_body: Vec::new(),
        };
        for row in 0..self.rows {
            let time_s = row as f64 * self.interval_s;
            let error = Vector3::from((self.accel_error)(force(time_s).into(), time_s / DAY_S));
            let read = platform_c_body * (force(time_s) + error + noise(ACCEL_G));
            let q = platform_c_body.quaternion();
            unit.record.time_s.push(time_s);
            unit.record.accel_g.push(read.into());
            unit.platform_q_body.push([q.w, q.i, q.j, q.k]);
            let middle_s = time_s + 0.5 * self.interval_s;
            let error = (self.gyro_error)(force(middle_s).into(), middle_s / DAY_S);
            let error = Vector3::from(error) + noise(held);
            let next = inertial_c_body(time_s + self.interval_s);
            let exact = (inertial_c_body(time_s).inverse() * next).scaled_axis();
            platform_c_body *= turned(exact + DEG_PER_H * self.interval_s * error, 1.0);
        }
        unit
    }
}

impl StrapdownUnit {
    /// Writes `record.csv`, `axes.csv` and `bench.toml` into a folder.
    ///
    /// # Errors
    /// Those of writing.
    pub fn write(&self, folder: &Path) -> Result<(), gyrocal_record::Error> {
        self.record.write(&folder.join("record.csv"))?;
        let mut axes = "time_s,q_w,q_x,q_y,q_z\n".to_owned();
        for (time_s, [w, x, y, z]) in self.record.time_s.iter().zip(&self.platform_q_body) {
            axes += &format!("{time_s},{w:?},{x:?},{y:?},{z:?}\n");
        }
        write_whole(&folder.join("axes.csv"), axes.as_bytes())?;
        self.bench.write(&folder.join("bench.toml"))
    }

    /// Matrices, by rows, that take components along the body to components along the platform: at the
    /// middle of the interval before a row, and at it.
    ///
    /// # Panics
    /// If there is no such row.
    #[must_use]
    pub fn axes(&self, row: usize) -> [[[f64; 3]; 3]; 2] {
        let at = |row: usize| {
            let [w, i, j, k] = self.platform_q_body[row];
            UnitQuaternion::new_normalize(nalgebra::Quaternion::new(w, i, j, k))
        };
        let middle = at(row.saturating_sub(1)).slerp(&at(row), 0.5);
        [middle, at(row)].map(|turn| {
            let matrix: Matrix3<f64> = turn.to_rotation_matrix().into_inner();
            matrix.transpose().into()
        })
    }
}
