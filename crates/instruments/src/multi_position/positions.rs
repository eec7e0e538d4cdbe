//! Rates and specific force at the stops, in physical units.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_statistics::root_mean_square;

use crate::accel_from_norm::AccelCalibration;
use crate::stop_means::StopMeans;

/// Gyro rates and specific force at the stops.
#[derive(Debug, Clone, PartialEq)]
pub struct Positions {
    /// Time of each stop.
    pub time_s: Vec<f64>,
    /// Output of each gyro about its own input axis, less the vertical part of Earth rate.
    pub rate_deg_per_h: Vec<[f64; 3]>,
    /// Standard errors of the rates.
    pub sigma_deg_per_h: Vec<[f64; 3]>,
    /// Specific force along the axes of the accelerometers.
    pub force_g: Vec<[f64; 3]>,
    /// Number of the log of each stop, from zero.
    pub log: Vec<usize>,
}

/// Calibration constants of the sensors, and the site.
#[derive(Debug, Clone, PartialEq)]
pub struct Instrument {
    /// Calibration of the accelerometers; `None` for a log in g.
    pub accel: Option<AccelCalibration>,
    /// Outputs of the gyros per rad/s.
    pub outputs_per_rad_per_s: [f64; 3],
    /// Latitude; `None` if Earth rate is not subtracted.
    pub latitude_deg: Option<f64>,
}

impl Positions {
    /// Root mean square of the standard errors of the rates of one gyro, deg/h.
    #[must_use]
    pub fn rms_sigma_deg_per_h(&self, gyro: usize) -> f64 {
        root_mean_square(self.sigma_deg_per_h.iter().map(|sigma| sigma[gyro]))
    }

    /// Converts the means of stops to physical units.
    ///
    /// Gravity determines the attitude at a stop except for its heading. The vertical part of Earth
    /// rate, Ω sin φ along specific force, is therefore known and subtracted. The horizontal part,
    /// Ω cos φ in an unknown direction, counts as an error of each stop with the variance of a random
    /// heading: (Ω cos φ)² (1 - a²) / 2 for a gyro with specific force a along its input axis.
    #[must_use]
    pub fn new(stops: &[StopMeans], instrument: &Instrument) -> Self {
        let deg_per_h = instrument
            .outputs_per_rad_per_s
            .map(|outputs| per_hour(1.0 / outputs));
        let force = |stop: &StopMeans| match &instrument.accel {
            Some(calibration) => calibration.force_g(stop.accel),
            None => stop.accel,
        };
        let force_g: Vec<[f64; 3]> = stops.iter().map(force).collect();
        let (vertical, horizontal) = match instrument.latitude_deg {
            Some(latitude_deg) => {
                let earth_deg_per_h = per_hour(EARTH_RATE_RAD_PER_S);
                let (sine, cosine) = latitude_deg.to_radians().sin_cos();
                (earth_deg_per_h * sine, earth_deg_per_h * cosine)
            }
            None => (0.0, 0.0),
        };
        let rate = |(stop, force_g): (&StopMeans, &[f64; 3])| {
            core::array::from_fn(|gyro| {
                stop.gyro[gyro] * deg_per_h[gyro] - vertical * force_g[gyro]
            })
        };
        let sigma = |(stop, force_g): (&StopMeans, &[f64; 3])| {
            core::array::from_fn(|gyro| {
                let across = (1.0 - force_g[gyro].powi(2)).max(0.0);
                let noise = stop.gyro_sigma[gyro] * deg_per_h[gyro];
                (noise.powi(2) + 0.5 * across * horizontal.powi(2)).sqrt()
            })
        };
        Self {
            time_s: stops.iter().map(|stop| stop.time_s).collect(),
            rate_deg_per_h: stops.iter().zip(&force_g).map(rate).collect(),
            sigma_deg_per_h: stops.iter().zip(&force_g).map(sigma).collect(),
            log: vec![0; stops.len()],
            force_g,
        }
    }

    /// The same stops of several logs, each with its number from zero.
    #[must_use]
    pub fn of_logs(self, log: Vec<usize>) -> Self {
        Self { log, ..self }
    }
}

fn per_hour(rad_per_s: f64) -> f64 {
    rad_per_s.to_degrees() * 3600.0
}
