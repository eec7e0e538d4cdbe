//! Rates and specific force at the stops, in physical units.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal::generated::catalogue::RATES;
use gyrocal_statistics::root_mean_square;

use crate::accel_from_norm::AccelCalibration;
use crate::error::{InstrumentError, Unfit};
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
    /// The part of the standard errors that comes from an unknown heading.
    pub heading_sigma_deg_per_h: Vec<[f64; 3]>,
    /// The part of them that comes from angles in steps.
    pub quantisation_sigma_deg_per_h: Vec<[f64; 3]>,
    /// Rates over equal parts of each stop, less that of the stop; none of a stop too short.
    pub parts_deg_per_h: Vec<Vec<[f64; 3]>>,
    /// Duration of each stop.
    pub duration_s: Vec<f64>,
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
        let heading = |force_g: &[f64; 3]| {
            force_g.map(|along| horizontal * (0.5 * (1.0 - along * along).max(0.0)).sqrt())
        };
        let sigma = |(stop, force_g): (&StopMeans, &[f64; 3])| {
            let heading = heading(force_g);
            core::array::from_fn(|gyro| {
                let noise = stop.gyro_sigma[gyro] * deg_per_h[gyro];
                noise.hypot(heading[gyro])
            })
        };
        let quantisation = |stop: &StopMeans| {
            core::array::from_fn(|gyro| stop.gyro_quantisation[gyro] * deg_per_h[gyro])
        };
        let parts = |stop: &StopMeans| {
            let scaled =
                |part: &[f64; 3]| core::array::from_fn(|gyro| part[gyro] * deg_per_h[gyro]);
            stop.gyro_parts.iter().map(scaled).collect()
        };
        Self {
            time_s: stops.iter().map(|stop| stop.time_s).collect(),
            rate_deg_per_h: stops.iter().zip(&force_g).map(rate).collect(),
            sigma_deg_per_h: stops.iter().zip(&force_g).map(sigma).collect(),
            heading_sigma_deg_per_h: force_g.iter().map(heading).collect(),
            quantisation_sigma_deg_per_h: stops.iter().map(quantisation).collect(),
            parts_deg_per_h: stops.iter().map(parts).collect(),
            duration_s: stops.iter().map(|stop| stop.to_s - stop.from_s).collect(),
            log: vec![0; stops.len()],
            force_g,
        }
    }

    /// Numbers of the logs that have stops, in rising order.
    pub(super) fn logs(&self) -> Vec<usize> {
        let mut logs = self.log.clone();
        logs.sort_unstable();
        logs.dedup();
        logs
    }

    /// Refuses gyros whose output does not change within a stop: nothing tells their noise.
    pub(super) fn refuse_still_gyros(&self) -> Result<(), InstrumentError> {
        /// Standard error over the rate that rounding leaves of none.
        const ROUNDING: f64 = 1e-10;
        let pairs = self.sigma_deg_per_h.iter().zip(&self.rate_deg_per_h);
        let still = pairs.enumerate().find_map(|(stop, (sigma, rate))| {
            let is_still = |gyro: &usize| sigma[*gyro] <= ROUNDING * rate[*gyro].abs();
            Some((stop, (0..3).find(is_still)?))
        });
        let Some((stop, gyro)) = still else {
            return Ok(());
        };
        Err(InstrumentError::unfit(
            Unfit::Saturated,
            format!(
                "{} with the same output in every sample of stop {} at {:.0} s",
                RATES[gyro].id,
                stop + 1,
                self.time_s[stop]
            ),
            "an output with noise",
            "record the outputs in finer steps, or stop for longer; a dead gyro or a wrong column has none either",
        ))
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
