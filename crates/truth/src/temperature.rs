//! A plausible course of the temperature at the bench.

use core::f64::consts::TAU;

use libm::{cos, pow, sin};

use crate::random::{Purpose, Stream};
use crate::term::Moment;

/// A temperature that is logged with the record: a daily wave and a slow wander, both by the
/// scenario's seed. Between the rows of the regular grid it is linear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Temperature {
    /// Its centre.
    pub mean_c: f64,
    /// Amplitude of the daily wave, whose phase is random.
    pub daily_k: f64,
    /// Root mean square of the wander, over a time much longer than its slowest part of twelve
    /// days.
    pub wander_k: f64,
}

impl Default for Temperature {
    /// A room without air conditioning: 20 °C, a wave of 1.5 K, a wander of 0.7 K.
    fn default() -> Self {
        Self {
            mean_c: 20.0,
            daily_k: 1.5,
            wander_k: 0.7,
        }
    }
}

/// What an effect of temperature is proportional to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum OfTemperature {
    Itself,
    Square,
    Rate,
    Hysteresis,
}

/// Temperature about its mean and what a gyro or an accelerometer may have of it besides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Thermal {
    pub(crate) temperature_k: f64,
    pub(crate) rate_k_per_h: f64,
    pub(crate) hysteresis_k: f64,
}

/// Temperature and its exact derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub(crate) temperature_c: f64,
    pub(crate) rate_k_per_h: f64,
}

/// Width of the loop of the hysteresis over the range of temperature.
const LOOP: f64 = 0.25;

impl OfTemperature {
    pub(crate) const ALL: [Self; 4] = [Self::Itself, Self::Square, Self::Rate, Self::Hysteresis];

    /// End of the id of an effect.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Itself => "temperature",
            Self::Square => "temperature_square",
            Self::Rate => "temperature_rate",
            Self::Hysteresis => "temperature_hysteresis",
        }
    }

    pub(crate) fn at(self, moment: &Moment) -> f64 {
        match self {
            Self::Itself => moment.temperature_k,
            Self::Square => moment.temperature_k * moment.temperature_k,
            Self::Rate => moment.temperature_rate_k_per_h,
            Self::Hysteresis => moment.temperature_hysteresis_k,
        }
    }
}

/// Temperatures at the rows of a grid as effects see them: about their mean over the rows that are
/// logged, with the loop of a friction that slips at an eighth of their range. Friction acts in gaps of the log
/// too.
pub(crate) fn thermal_course(course: &[Point], logged: &[bool]) -> Vec<Thermal> {
    let rows = || course.iter().zip(logged);
    let seen = || rows().filter_map(|(point, logged)| logged.then_some(point));
    let count = seen().count().max(1) as f64;
    let mean_c = seen().map(|point| point.temperature_c).sum::<f64>() / count;
    let most = seen().fold(f64::MIN, |most, point| most.max(point.temperature_c));
    let least = seen().fold(f64::MAX, |least, point| least.min(point.temperature_c));
    let slip_k = 0.5 * LOOP * (most - least).max(0.0);
    let mut stretch_k: f64 = 0.0;
    let mut before_c = course.first().map_or(0.0, |point| point.temperature_c);
    let seen_by_effects = |point: &Point| {
        stretch_k = (stretch_k + point.temperature_c - before_c).clamp(-slip_k, slip_k);
        before_c = point.temperature_c;
        Thermal {
            temperature_k: point.temperature_c - mean_c,
            rate_k_per_h: point.rate_k_per_h,
            hysteresis_k: stretch_k,
        }
    };
    let mut thermal: Vec<Thermal> = course.iter().map(seen_by_effects).collect();
    let stretched = thermal.iter().zip(logged).filter(|(_, logged)| **logged);
    let mean_k = stretched.map(|(one, _)| one.hysteresis_k).sum::<f64>() / count;
    for one in &mut thermal {
        one.hysteresis_k -= mean_k;
    }
    thermal
}

const DAY_S: f64 = 86_400.0;
const HOUR_S: f64 = 3600.0;

/// Waves of the wander.
const WAVES: usize = 8;
/// Periods of the fastest and the slowest.
const PERIODS_S: [f64; 2] = [6.0 * 3600.0, 12.0 * DAY_S];

impl Temperature {
    /// The temperature at each of the times since the first row.
    pub(crate) fn course(&self, seed: u64, times_s: impl Iterator<Item = f64>) -> Vec<Point> {
        let mut stream = Stream::new(seed, Purpose::Temperature);
        let daily = Wave {
            amplitude_k: self.daily_k,
            period_s: DAY_S,
            phase_rad: stream.between(0.0, TAU),
        };
        let mut wander: [Wave; WAVES] = core::array::from_fn(|wave| {
            let place = (wave as f64 + stream.uniform()) / WAVES as f64;
            let period_s = PERIODS_S[0] * pow(PERIODS_S[1] / PERIODS_S[0], place);
            Wave {
                // As in a random walk, power rises in proportion to the period.
                amplitude_k: period_s.sqrt(),
                period_s,
                phase_rad: stream.between(0.0, TAU),
            }
        });
        let power: f64 = wander.iter().map(|wave| 0.5 * wave.period_s).sum();
        for wave in &mut wander {
            wave.amplitude_k *= self.wander_k / power.sqrt();
        }
        times_s
            .map(|time_s| {
                let wander_k: f64 = wander.iter().map(|wave| wave.at_k(time_s)).sum();
                let wander_k_per_s: f64 = wander.iter().map(|wave| wave.k_per_s(time_s)).sum();
                Point {
                    temperature_c: self.mean_c + daily.at_k(time_s) + wander_k,
                    rate_k_per_h: HOUR_S * (daily.k_per_s(time_s) + wander_k_per_s),
                }
            })
            .collect()
    }
}

struct Wave {
    amplitude_k: f64,
    period_s: f64,
    phase_rad: f64,
}

impl Wave {
    fn at_k(&self, time_s: f64) -> f64 {
        self.amplitude_k * cos(TAU * time_s / self.period_s + self.phase_rad)
    }

    fn k_per_s(&self, time_s: f64) -> f64 {
        let angle_rad = TAU * time_s / self.period_s + self.phase_rad;
        -self.amplitude_k * TAU / self.period_s * sin(angle_rad)
    }
}
