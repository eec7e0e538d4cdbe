//! Terms of the law of a gyro's output in rates, as columns of a linear regression.

use core::cmp::Ordering;

use gyrocal::generated::catalogue::RATES;
use gyrocal_record::AXES;
use gyrocal_statistics::{followed_with_play, local_slopes};
use nalgebra::DVector;

use super::blocks::Blocks;
use crate::earth_rate::deg_per_h;
use crate::multi_position::Term;

/// A term of the law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum RateTerm {
    /// A term of the drift law in specific force, or a ramp in time.
    Drift(Term),
    /// Error of scale for the own axis, misalignment toward another.
    Turn(usize),
    /// Power of temperature about its mean.
    Temperature(i32),
    /// Rate of change of temperature.
    TemperatureRate,
    /// Part of temperature that follows it with play: different on the way up and on the way down. Half the play, over
    /// the range of temperature.
    Hysteresis(f64),
    /// Change at a time \[s\] of a log.
    Step { log: usize, time_s: f64 },
}

impl RateTerm {
    /// Public name.
    pub(super) fn name(self, gyro: usize) -> String {
        let own = RATES[gyro].id;
        match self {
            Self::Drift(term) => term.id(gyro).to_owned(),
            Self::Turn(axis) if axis == gyro => format!("{own}.scale"),
            Self::Turn(axis) => format!("{own}.about_{}", AXES[axis]),
            Self::Temperature(1) => format!("{own}.temperature"),
            Self::Temperature(power) => format!("{own}.temperature_{power}"),
            Self::TemperatureRate => format!("{own}.temperature_rate"),
            Self::Hysteresis(_) => format!("{own}.temperature_hysteresis"),
            Self::Step { .. } => format!("{own}.step"),
        }
    }

    /// Unit of its coefficient.
    pub(super) fn unit(self, gyro: usize) -> String {
        match self {
            Self::Drift(term) => term.unit(gyro).to_owned(),
            Self::Turn(axis) if axis == gyro => "ppm".to_owned(),
            Self::Turn(_) => "mrad".to_owned(),
            Self::Temperature(1) | Self::Hysteresis(_) => "deg/h/K".to_owned(),
            Self::Temperature(power) => format!("deg/h/K^{power}"),
            Self::TemperatureRate => "deg/h/(K/min)".to_owned(),
            Self::Step { .. } => "deg/h".to_owned(),
        }
    }

    /// Whether two terms are one effect, but for a shape: steps at two instants, hysteresis of two plays.
    pub(super) fn is_of_kind(self, other: Self) -> bool {
        match (self, other) {
            (Self::Hysteresis(_), Self::Hysteresis(_)) => true,
            (one, other) => one == other,
        }
    }

    /// Output per unit of its coefficient at each block of all logs \[deg/h\]; `None` without the column of the
    /// logs that it needs.
    pub(super) fn column(self, gyro: usize, logs: &[Blocks]) -> Option<DVector<f64>> {
        match self {
            // Of the whole log: what changes within it is noise of the accelerometers.
            Self::Drift(Term::Nominal(power)) => {
                Some(each(logs, |log| log.mean_up[gyro].powi(power as i32)))
            }
            Self::Drift(Term::Cross(axis)) => Some(each(logs, |log| log.mean_up[axis])),
            Self::Drift(Term::Ramp) => Some(centred(times_days(logs))),
            Self::Drift(_) => None,
            Self::Turn(axis) => {
                let factor = if axis == gyro { 1e-6 } else { 1e-3 };
                // Errors of scale and axes act on the rate of the Earth as on that of the table.
                let rates = of_logs(logs, |log| {
                    let earth = log.vertical_deg_per_h * log.mean_up[axis];
                    let rates = log.table.as_ref()?.iter();
                    Some(
                        rates
                            .map(|rate| factor * (deg_per_h(rate[axis]) + earth))
                            .collect(),
                    )
                })?;
                Some(DVector::from_vec(rates))
            }
            Self::Temperature(power) => {
                let temperature = temperature(logs)?;
                Some(centred(temperature.map(|value| value.powi(power))))
            }
            Self::TemperatureRate => {
                let changes = of_logs(logs, |log| {
                    let temperature = log.temperature_c.as_ref()?;
                    Some(local_slopes(&log.time_s, temperature, 0.0))
                })?;
                Some(60.0 * DVector::from_vec(changes))
            }
            Self::Hysteresis(share) => {
                let all = temperature(logs)?;
                let half = share * (all.max() - all.min());
                let lagging = of_logs(logs, |log| {
                    Some(followed_with_play(log.temperature_c.as_ref()?, half))
                })?;
                let lagging = centred(DVector::from_vec(lagging));
                Some(all - lagging)
            }
            Self::Step { log: which, time_s } => {
                let mut values = Vec::new();
                for (number, log) in logs.iter().enumerate() {
                    // A change within a block shows in the mean of its rest.
                    let later = log.time_s.iter().map(|at| match number.cmp(&which) {
                        Ordering::Less => 0.0,
                        Ordering::Greater => 1.0,
                        Ordering::Equal => ((at - time_s) / log.block_s + 0.5).clamp(0.0, 1.0),
                    });
                    values.extend(later);
                }
                Some(centred(DVector::from_vec(values)))
            }
        }
    }
}

/// Time from the middle of each block to the beginning of its log in days; logs follow one another.
pub(super) fn times_days(logs: &[Blocks]) -> DVector<f64> {
    let mut values = Vec::new();
    let mut end_s = f64::NEG_INFINITY;
    for log in logs {
        let start_s = log.time_s[0] - 0.5 * log.block_s;
        // Clocks that begin anew are joined.
        let later_s = if start_s > end_s - log.block_s {
            0.0
        } else {
            end_s - start_s
        };
        values.extend(log.time_s.iter().map(|at| (at + later_s) / 86_400.0));
        end_s = log.time_s[log.len() - 1] + later_s + 0.5 * log.block_s;
    }
    DVector::from_vec(values)
}

/// Temperature about its mean.
pub(super) fn temperature(logs: &[Blocks]) -> Option<DVector<f64>> {
    let values = of_logs(logs, |log| log.temperature_c.clone())?;
    Some(centred(DVector::from_vec(values)))
}

/// Correlation of temperature and time; `None` without temperature or if it is constant.
pub(super) fn time_and_temperature(logs: &[Blocks]) -> Option<f64> {
    let temperature = temperature(logs)?;
    let time = centred(times_days(logs));
    let norms = temperature.norm() * time.norm();
    (norms > 0.0).then(|| temperature.dot(&time) / norms)
}

/// The same value for each block of a log.
fn each(logs: &[Blocks], value: impl Fn(&Blocks) -> f64) -> DVector<f64> {
    let values = logs
        .iter()
        .flat_map(|log| core::iter::repeat_n(value(log), log.len()));
    DVector::from_vec(values.collect())
}

/// Values of all logs in a row; `None` if one has none.
fn of_logs<T>(logs: &[Blocks], values: impl Fn(&Blocks) -> Option<Vec<T>>) -> Option<Vec<T>> {
    let of_each: Option<Vec<Vec<T>>> = logs.iter().map(values).collect();
    Some(of_each?.into_iter().flatten().collect())
}

fn centred(values: DVector<f64>) -> DVector<f64> {
    let mean = values.mean();
    values.add_scalar(-mean)
}
