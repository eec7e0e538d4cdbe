//! A plausible course of the temperature at the bench.

use core::f64::consts::TAU;

use libm::{cos, pow};

use crate::random::{Purpose, Stream};

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

const DAY_S: f64 = 86_400.0;

/// Waves of the wander.
const WAVES: usize = 8;
/// Periods of the fastest and the slowest.
const PERIODS_S: [f64; 2] = [6.0 * 3600.0, 12.0 * DAY_S];

impl Temperature {
    /// The temperature at each of the times since the first row.
    pub(crate) fn course_c(&self, seed: u64, times_s: impl Iterator<Item = f64>) -> Vec<f64> {
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
                self.mean_c + daily.at_k(time_s) + wander_k
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
}
