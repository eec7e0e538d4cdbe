//! What is to be simulated.

use gyrocal_record::{Bench, Bound, Gravity, Prior};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::platform::Platform;
use crate::random::{Purpose, Stream};

/// A platform, its bench, and how it is recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Seed of all that is random.
    pub seed: u64,
    /// Astronomic latitude, north positive.
    pub latitude_deg: f64,
    /// Local gravity and the accelerometers' unit, when they differ.
    pub gravity: Option<Gravity>,
    /// What the gyros do.
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
        }
    }
}

/// More rows are a mistake in a unit.
pub(crate) const MOST_ROWS: f64 = 1e7;

impl Scenario {
    /// The bench description that goes with the record.
    #[must_use]
    pub fn bench(&self) -> Bench {
        Bench {
            latitude_deg: self.latitude_deg,
            gravity: self.gravity,
            initial_angles_deg: self.declared_angles_deg(),
            initial_angles_sigma_deg: self.initial_angles_sigma_deg,
            accel_noise_g: self.accel_noise_g,
            gyro_noise_deg_per_h: self.gyro_noise_deg_per_h,
            prior: self.prior,
        }
    }

    /// The platform as it truly is: declared angles and their error.
    #[must_use]
    pub fn platform(&self) -> Platform {
        let error = Stream::new(self.seed, Purpose::InitialAngles).three_normals();
        let declared = self.declared_angles_deg();
        let angles_deg = [0, 1, 2]
            .map(|axis| declared[axis] + self.initial_angles_sigma_deg[axis] * error[axis]);
        Platform {
            latitude_deg: self.latitude_deg,
            specific_force_at_rest_g: self.bench_gravity(),
            coefficients: self.coefficients,
            initial_platform_c_enu: Attitude::from_angles_rad(angles_deg.map(f64::to_radians)),
        }
    }

    /// Standard deviation of the gyro noise as it is held over one interval.
    #[must_use]
    pub fn held_gyro_noise_deg_per_h(&self) -> f64 {
        self.gyro_noise_deg_per_h * libm::sqrt(60.0 / self.interval_s)
    }

    /// Rows of the regular grid, those in gaps included.
    #[must_use]
    pub fn grid_rows(&self) -> usize {
        // A duration of whole intervals must not lose its last row by rounding.
        (self.duration_s / self.interval_s + 1e-9).floor() as usize + 1
    }

    /// The angles that the bench file declares, which a random attitude gets from the seed.
    #[must_use]
    pub fn declared_angles_deg(&self) -> [f64; 3] {
        match self.initial {
            InitialAttitude::AnglesDeg(angles_deg) => angles_deg,
            InitialAttitude::Random => Stream::new(self.seed, Purpose::InitialAttitude)
                .attitude()
                .angles_deg(),
        }
    }

    /// Says what is wrong with the values, if something is.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidScenario`] for the first value that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let coefficients = self.coefficients;
        let single = [
            (
                "latitude_deg",
                self.latitude_deg,
                Bound::Within(-90.0, 90.0),
            ),
            ("accel_noise_g", self.accel_noise_g, Bound::NotNegative),
            (
                "gyro_noise_deg_per_h",
                self.gyro_noise_deg_per_h,
                Bound::NotNegative,
            ),
            ("gravity", self.bench_gravity(), Bound::Positive),
            ("start_s", self.start_s, Bound::Finite),
            ("interval_s", self.interval_s, Bound::Positive),
            ("duration_s", self.duration_s, Bound::NotNegative),
            (
                "duration_s / interval_s",
                self.duration_s / self.interval_s,
                Bound::Within(0.0, MOST_ROWS),
            ),
            (
                "missing_fraction",
                self.missing_fraction,
                Bound::Within(0.0, 1.0),
            ),
        ];
        let three = [
            (
                "initial_angles_sigma_deg",
                self.initial_angles_sigma_deg,
                Bound::NotNegative,
            ),
            ("initial", self.declared_angles_deg(), Bound::Finite),
            (
                "coefficients.bias_deg_per_h",
                coefficients.bias_deg_per_h,
                Bound::Finite,
            ),
            (
                "coefficients.g_deg_per_h_per_g",
                coefficients.g_deg_per_h_per_g,
                Bound::Finite,
            ),
            (
                "coefficients.gg_deg_per_h_per_g2",
                coefficients.gg_deg_per_h_per_g2,
                Bound::Finite,
            ),
        ];
        let all = three
            .into_iter()
            .flat_map(|(name, values, bound)| values.map(|value| (name, value, bound)))
            .chain(single);
        for (name, value, bound) in all {
            if !bound.holds(value) {
                return Err(Error::InvalidScenario {
                    name,
                    found: value.to_string(),
                    expected: bound.describe(),
                });
            }
        }
        match self
            .gaps_s
            .iter()
            .find(|gap| !(gap[0] > 0.0 && gap[1] > gap[0]))
        {
            Some(gap) => Err(Error::InvalidScenario {
                name: "gaps_s",
                found: format!("{gap:?}"),
                expected: "0 < from < to (the first row has the initial attitude)".to_owned(),
            }),
            None => Ok(()),
        }
    }

    fn bench_gravity(&self) -> f64 {
        self.gravity.map_or(1.0, Gravity::ratio)
    }
}
