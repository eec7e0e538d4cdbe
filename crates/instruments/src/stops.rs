//! Detection of stops: intervals of a log at rest.

use core::ops::Range;

use gyrocal_statistics::upper_median;
use nalgebra::Vector3;

use crate::error::{InstrumentError, Unfit};
use crate::log::Log;

/// Settings of the detection of stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopSettings {
    /// Length of the windows whose variance is tested.
    pub window_s: f64,
    /// Largest variance of the gyros in a window at rest, over that of the quietest windows.
    pub gyro_factor: f64,
    /// The same of the accelerometers.
    pub accel_factor: f64,
    /// Time that is omitted at both ends of a stop.
    pub margin_s: f64,
    /// Least length of a stop without its margins.
    pub shortest_s: f64,
    /// Tremor of a hand-held stop that is tolerated in a log in physical units; `None` judges by the
    /// quietest windows alone, as do logs in raw counts.
    pub hand_held: Option<HandHeld>,
}

/// Tremor of a hand-held stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HandHeld {
    /// Largest standard deviation of the rate about one axis in a window, and largest difference of its
    /// mean from the mean of the quietest windows \[rad/s\].
    pub rate_rad_per_s: f64,
    /// Largest standard deviation of specific force along one axis in a window \[g\].
    pub force_g: f64,
}

impl Default for HandHeld {
    /// Twice what a hand that rests on something does (physiological tremor of 1 deg/s).
    fn default() -> Self {
        Self {
            rate_rad_per_s: 0.035,
            force_g: 0.03,
        }
    }
}

impl Default for StopSettings {
    fn default() -> Self {
        Self {
            window_s: 1.0,
            gyro_factor: 4.0,
            accel_factor: 6.0,
            margin_s: 0.5,
            shortest_s: 2.0,
            hand_held: Some(HandHeld::default()),
        }
    }
}

/// Fraction of the windows that is at rest in any log with stops.
const QUIETEST: f64 = 0.1;

/// Largest variance at rest over half the mean square of successive differences. At rest successive
/// samples differ about as much as distant ones, but for the filters of sensors, which halve the
/// bandwidth a few times; in motion they differ by far less.
const MOST_CORRELATED: f64 = 10.0;

/// Finds the stops of a log, as ranges of samples.
///
/// In physical units a window is at rest if it has no more than the tremor of a hand, and a stop is a run
/// of such windows over which specific force keeps its direction; a run over which it does not is searched
/// again with less tremor. In raw counts, or without a tremor, a window is at rest if its variance is
/// within a factor of that of the quietest windows of the log.
///
/// # Errors
///
/// [`Unfit::NeverStatic`] if the quietest windows are in motion too, or if no stop is long
/// enough; [`Unfit::TooShort`] if the log is shorter than a few windows; [`Unfit::NoAccelerometers`].
pub fn find_stops(
    log: &Log,
    settings: &StopSettings,
) -> Result<Vec<Range<usize>>, InstrumentError> {
    let force = log.force()?;
    let samples = |time_s: f64| (time_s / log.interval_s).round() as usize;
    let window = samples(settings.window_s).max(8);
    if log.len() < 4 * window {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} samples", log.len()),
            format!("at least four windows of {window}"),
            "record for longer, or judge by shorter windows",
        ));
    }
    let gyro = Windows::of(&log.gyro, window);
    let accel = Windows::of(force, window);
    let [gyro_limit, accel_limit] = [
        gyro.quietest() * settings.gyro_factor,
        accel.quietest() * settings.accel_factor,
    ];
    let search = Search {
        force,
        gyro: &gyro,
        accel: &accel,
        window,
        margin: samples(settings.margin_s),
        shortest: samples(settings.shortest_s),
    };
    let quietest = Limits {
        gyro: gyro_limit,
        accel: accel_limit,
        rate: f64::INFINITY,
    };
    let whole = 0..gyro.variance.len();
    let quiet = || search.runs(whole.clone(), quietest, |stop| is_at_rest(&log.gyro[stop]));
    let stops = match settings.hand_held {
        Some(tremor) if !log.gyro_in_counts && !log.accel_in_counts => {
            let limits = Limits {
                gyro: 3.0 * tremor.rate_rad_per_s.powi(2),
                accel: 3.0 * tremor.force_g.powi(2),
                rate: tremor.rate_rad_per_s,
            };
            let found = search.tolerant(whole.clone(), limits, quietest);
            // In a wrong unit nothing rests: the turns tell the unit.
            if found.is_empty() { quiet() } else { found }
        }
        _ => quiet(),
    };
    if stops.is_empty() {
        return Err(InstrumentError::unfit(
            Unfit::NeverStatic,
            format!(
                "no stretch at rest of {} s or more in {:.1} s",
                settings.shortest_s,
                log.time_s[log.len() - 1] - log.time_s[0]
            ),
            "static stops",
            "leave the instrument still for some seconds in each position; if it was, allow \
             shorter stops or a larger scatter",
        ));
    }
    Ok(stops)
}

/// Largest variances of a window at rest, summed over three axes, and largest change of its mean rate.
#[derive(Debug, Clone, Copy)]
struct Limits {
    gyro: f64,
    accel: f64,
    rate: f64,
}

/// Largest change of the direction of specific force over a stop \[rad\].
const LARGEST_DRIFT_RAD: f64 = 0.05;

struct Search<'a> {
    force: &'a [[f64; 3]],
    gyro: &'a Windows,
    accel: &'a Windows,
    window: usize,
    margin: usize,
    shortest: usize,
}

impl Search<'_> {
    /// Stops among windows that begin in a range, by limits.
    fn runs(
        &self,
        windows: Range<usize>,
        limits: Limits,
        is_stop: impl Fn(Range<usize>) -> bool,
    ) -> Vec<Range<usize>> {
        let bias = self.quiet_mean();
        let mut stops = Vec::new();
        let mut first = None;
        for start in windows.start..=windows.end {
            let quiet = start < windows.end
                && self.gyro.variance[start] <= limits.gyro
                && self.accel.variance[start] <= limits.accel
                && (0..3)
                    .all(|axis| (self.gyro.mean[start][axis] - bias[axis]).abs() <= limits.rate);
            match (quiet, first) {
                (true, None) => first = Some(start),
                (false, Some(from)) => {
                    // The last quiet window began one sample before.
                    let end = (start - 1 + self.window).saturating_sub(self.margin);
                    let stop = from + self.margin..end;
                    if stop.len() >= self.shortest && is_stop(stop.clone()) {
                        stops.push(stop);
                    }
                    first = None;
                }
                _ => {}
            }
        }
        stops
    }

    /// Stops with tremor; runs over which gravity turns are searched again with half of it, down to the
    /// noise of the quietest windows.
    fn tolerant(&self, windows: Range<usize>, limits: Limits, least: Limits) -> Vec<Range<usize>> {
        let mut found = Vec::new();
        for stop in self.runs(windows, limits, |_| true) {
            if self.drift_rad(&stop) <= LARGEST_DRIFT_RAD {
                found.push(stop);
            } else if limits.gyro > least.gyro && limits.accel > least.accel {
                let half = Limits {
                    gyro: (0.25 * limits.gyro).max(least.gyro),
                    accel: (0.25 * limits.accel).max(least.accel),
                    rate: 0.5 * limits.rate,
                };
                let first = stop.start - self.margin;
                let last = (stop.end + self.margin).saturating_sub(self.window);
                found.extend(self.tolerant(first..last + 1, half, least));
            }
        }
        found
    }

    /// Angle between specific force in the first and in the last third of a stop.
    fn drift_rad(&self, stop: &Range<usize>) -> f64 {
        let third = (stop.len() / 3).max(1);
        let mean = |samples: Range<usize>| {
            let sum = self.force[samples].iter().fold([0.0; 3], |sum, force| {
                core::array::from_fn(|axis| sum[axis] + force[axis])
            });
            Vector3::from(sum)
        };
        mean(stop.start..stop.start + third).angle(&mean(stop.end - third..stop.end))
    }

    /// Mean rate of the quietest windows: the bias of the gyros.
    fn quiet_mean(&self) -> [f64; 3] {
        let limit = self.gyro.quietest();
        let quiet = || (0..self.gyro.variance.len()).filter(|w| self.gyro.variance[*w] <= limit);
        core::array::from_fn(|axis| {
            let mut means: Vec<f64> = quiet().map(|w| self.gyro.mean[w][axis]).collect();
            upper_median(&mut means).unwrap_or(0.0)
        })
    }
}

/// Converts stops given as times to ranges of samples.
///
/// # Errors
///
/// [`Unfit::Setting`] for a stop that is empty or outside the log.
pub fn given_stops(log: &Log, stops_s: &[[f64; 2]]) -> Result<Vec<Range<usize>>, InstrumentError> {
    stops_s
        .iter()
        .map(|[from_s, to_s]| {
            let first = log.time_s.partition_point(|time_s| time_s < from_s);
            let end = log.time_s.partition_point(|time_s| time_s < to_s);
            if first + 2 > end {
                return Err(InstrumentError::unfit(
                    Unfit::Setting,
                    format!("a stop from {from_s} to {to_s} s without samples"),
                    format!(
                        "stops between {} and {} s",
                        log.time_s[0],
                        log.time_s[log.len() - 1]
                    ),
                    "give the times as the log has them",
                ));
            }
            Ok(first..end)
        })
        .collect()
}

/// The variance, summed over three axes, and the mean of each window.
struct Windows {
    variance: Vec<f64>,
    mean: Vec<[f64; 3]>,
}

impl Windows {
    fn of(samples: &[[f64; 3]], window: usize) -> Self {
        let mut variance = vec![0.0; samples.len() + 1 - window];
        let mut means = vec![[0.0; 3]; variance.len()];
        for axis in 0..3 {
            let mean = samples.iter().map(|s| s[axis]).sum::<f64>() / samples.len() as f64;
            // Sums from the start, of deviations from the mean of the log.
            let mut sums = Vec::with_capacity(samples.len() + 1);
            let (mut sum, mut square) = (0.0, 0.0);
            sums.push((sum, square));
            for sample in samples {
                let deviation = sample[axis] - mean;
                sum += deviation;
                square += deviation * deviation;
                sums.push((sum, square));
            }
            let n = window as f64;
            for (start, variance) in variance.iter_mut().enumerate() {
                let (first, last) = (sums[start], sums[start + window]);
                let (sum, square) = (last.0 - first.0, last.1 - first.1);
                *variance += (square - sum * sum / n) / (n - 1.0);
                means[start][axis] = mean + sum / n;
            }
        }
        Self {
            variance,
            mean: means,
        }
    }

    fn quietest(&self) -> f64 {
        let mut sorted = self.variance.clone();
        let place = (sorted.len() as f64 * QUIETEST) as usize;
        *sorted.select_nth_unstable_by(place, f64::total_cmp).1
    }
}

/// Compares the variance of samples with that of their successive differences (von Neumann).
fn is_at_rest(samples: &[[f64; 3]]) -> bool {
    let (mut variance, mut difference) = (0.0, 0.0);
    for axis in 0..3 {
        let n = samples.len() as f64;
        let mean = samples.iter().map(|s| s[axis]).sum::<f64>() / n;
        let squares = samples.iter().map(|s| (s[axis] - mean).powi(2));
        variance += squares.sum::<f64>() / (n - 1.0);
        let squares = samples
            .windows(2)
            .map(|w| (w[1][axis] - w[0][axis]).powi(2));
        difference += squares.sum::<f64>() / (2.0 * (n - 1.0));
    }
    variance <= MOST_CORRELATED * difference
}
