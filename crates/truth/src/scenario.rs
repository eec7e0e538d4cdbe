//! Scenarios: a platform, its bench, and its record.

use gyrocal_record::{Bench, GimbalLimits, Gravity, Prior, SiteUncertainty};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;
use crate::effect::Effect;
use crate::hidden::Hidden;
use crate::platform::Platform;
use crate::random::{Purpose, Stream};
use crate::temperature::{Point, Temperature};

/// A scenario to be simulated: a platform, its bench, and the sampling of its record.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Seed of all random numbers.
    pub seed: u64,
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Local gravity and the accelerometers' unit, when they differ.
    pub gravity: Option<Gravity>,
    /// Drift coefficients of the gyros.
    pub coefficients: Coefficients,
    /// The initial attitude that the bench file declares.
    pub initial: InitialAttitude,
    /// Standard deviation of the error of each declared angle, drawn once for a record.
    pub initial_angles_sigma_deg: [f64; 3],
    /// Standard deviation of one sample of an accelerometer; may be 0.
    pub accel_noise_g: f64,
    /// Standard deviation of the white gyro noise as held over one minute; may be 0. Held over
    /// an interval Δt it is larger by √(60 s / Δt).
    pub gyro_noise_deg_per_h: f64,
    /// Prior of the coefficients for the bench file; the simulation does not use it.
    pub prior: Prior,
    /// Time of the first row.
    pub start_s: f64,
    /// Time between rows.
    pub interval_s: f64,
    /// Time from the first row to the last, or less than one interval more than that.
    pub duration_s: f64,
    /// Intervals `[from, to)` since the first row in which rows are missing.
    pub gaps_s: Vec<[f64; 2]>,
    /// Fraction of the accelerometer components that are missing.
    pub missing_fraction: f64,
    /// Temperature logged with the record, if any.
    pub temperature: Option<Temperature>,
    /// The Earth's magnetic field in local east, north, up, if the bench file gives it.
    pub magnetic_field_gauss: Option<[f64; 3]>,
    /// Hidden effects: deviations from the nominal model and from the bench file.
    pub hidden: Vec<Hidden>,
}

/// An initial attitude.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum InitialAttitude {
    /// Platform against local east, north, up: angles about x, then y, then z.
    AnglesDeg([f64; 3]),
    /// Any attitude with the same probability, by the scenario's seed.
    Random,
}

impl Default for Scenario {
    /// Three days each minute at latitude 39.1°, aligned to east, north, up, without drift,
    /// with a noise of 1e-5 g and 0.002 deg/h.
    fn default() -> Self {
        Self {
            seed: 1,
            latitude_deg: 39.1,
            gravity: None,
            coefficients: Coefficients::NONE,
            initial: InitialAttitude::AnglesDeg([0.0; 3]),
            initial_angles_sigma_deg: [0.01; 3],
            accel_noise_g: 1e-5,
            gyro_noise_deg_per_h: 0.002,
            prior: Prior::default(),
            start_s: 0.0,
            interval_s: 60.0,
            duration_s: 3.0 * 86_400.0,
            gaps_s: Vec::new(),
            missing_fraction: 0.0,
            temperature: None,
            magnetic_field_gauss: None,
            hidden: Vec::new(),
        }
    }
}

/// Largest number of rows; more are a mistake in a unit.
pub(crate) const MAX_ROWS: f64 = 1e7;

impl Scenario {
    /// The bench description that goes with the record.
    #[must_use]
    pub fn bench(&self) -> Bench {
        Bench {
            identification: std::collections::BTreeMap::new(),
            latitude_deg: self.latitude_deg,
            gravity: self.gravity,
            uncertainty: SiteUncertainty::default(),
            magnetic_field_gauss: self.magnetic_field_gauss,
            initial_angles_deg: Some(self.declared_angles_deg()),
            initial_angles_sigma_deg: self.initial_angles_sigma_deg,
            gimbal_limits: GimbalLimits::default(),
            accel_noise_g: self.accel_noise_g,
            gyro_noise_deg_per_h: self.gyro_noise_deg_per_h,
            prior: self.prior,
        }
    }

    /// The true platform at its site: declared angles and their errors, and hidden effects on
    /// latitude, gravity and initial attitude.
    #[must_use]
    pub fn platform(&self) -> Platform {
        let error = Stream::new(self.seed, Purpose::InitialAngles).three_normals();
        let declared = self.declared_angles_deg();
        let angles_deg: [f64; 3] = core::array::from_fn(|axis| {
            declared[axis] + self.initial_angles_sigma_deg[axis] * error[axis]
        });
        let mut platform = Platform {
            latitude_deg: self.latitude_deg,
            specific_force_at_rest_g: self.bench_gravity(),
            coefficients: self.coefficients,
            initial_platform_c_enu: Attitude::from_angles_rad(angles_deg.map(f64::to_radians)),
        };
        for hidden in &self.hidden {
            match hidden.effect() {
                Effect::Latitude => platform.latitude_deg += hidden.value(0),
                Effect::Gravity => platform.specific_force_at_rest_g *= 1.0 + hidden.value(0),
                Effect::InitialAttitude => {
                    let turn = Attitude::turned_by(hidden.three().map(f64::to_radians));
                    platform.initial_platform_c_enu = turn.after(platform.initial_platform_c_enu);
                }
                _ => {}
            }
        }
        platform
    }

    /// Standard deviation of the gyro noise as it is held over one interval.
    #[must_use]
    pub fn held_gyro_noise_deg_per_h(&self) -> f64 {
        self.gyro_noise_deg_per_h * (60.0 / self.interval_s).sqrt()
    }

    /// Rows of the regular grid, those in gaps included.
    #[must_use]
    pub fn grid_rows(&self) -> usize {
        // A duration of whole intervals must not lose its last row by rounding.
        (self.duration_s / self.interval_s + 1e-9).floor() as usize + 1
    }

    /// Time since the first row of each row of the regular grid, by the record's clock.
    pub(crate) fn grid_s(&self) -> impl Iterator<Item = f64> + use<> {
        let interval_s = self.interval_s;
        (0..self.grid_rows()).map(move |row| row as f64 * interval_s)
    }

    /// The temperature at each row of the regular grid, if the scenario has one.
    pub(crate) fn temperature_course(&self) -> Option<Vec<Point>> {
        let temperature = self.temperature?;
        Some(temperature.course(self.seed, self.grid_s()))
    }

    /// True if the logger writes a row at this time since the first.
    pub(crate) fn logs(&self, since_first_s: f64) -> bool {
        let mut gaps = self.gaps_s.iter();
        !gaps.any(|gap| (gap[0]..gap[1]).contains(&since_first_s))
    }

    /// The angles that the bench file declares, which a random attitude gets from the seed.
    #[must_use]
    pub fn declared_angles_deg(&self) -> [f64; 3] {
        match self.initial {
            InitialAttitude::AnglesDeg(angles_deg) => angles_deg,
            InitialAttitude::Random => {
                let mut stream = Stream::new(self.seed, Purpose::InitialAttitude);
                stream.attitude().angles_deg()
            }
        }
    }

    /// Specific force at rest as the bench file states it.
    pub(crate) fn bench_gravity(&self) -> f64 {
        self.gravity.map_or(1.0, Gravity::ratio)
    }
}
