//! Detection of stops: intervals of a log at rest.

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
}

impl Default for StopSettings {
    fn default() -> Self {
        Self {
            window_s: 1.0,
            gyro_factor: 4.0,
            accel_factor: 6.0,
            margin_s: 0.5,
            shortest_s: 2.0,
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
/// A window is at rest if its variance is within a factor of that of the quietest windows of the
/// log, for gyros and accelerometers; a stop is a run of such windows.
///
/// # Errors
///
/// [`Unfit::NeverStatic`] if the quietest windows are in motion too, or if no stop is long
/// enough; [`Unfit::TooShort`] if the log is shorter than a few windows.
pub fn find_stops(
    log: &Log,
    settings: &StopSettings,
) -> Result<Vec<core::ops::Range<usize>>, InstrumentError> {
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
    let accel = Windows::of(&log.accel, window);
    let [gyro_limit, accel_limit] = [
        gyro.quietest() * settings.gyro_factor,
        accel.quietest() * settings.accel_factor,
    ];
    let (margin, shortest) = (samples(settings.margin_s), samples(settings.shortest_s));
    let mut stops = Vec::new();
    let mut first = None;
    for start in 0..=gyro.variance.len() {
        let quiet = start < gyro.variance.len()
            && gyro.variance[start] <= gyro_limit
            && accel.variance[start] <= accel_limit;
        match (quiet, first) {
            (true, None) => first = Some(start),
            (false, Some(from)) => {
                // The last quiet window began one sample before.
                let stop = from + margin..(start - 1 + window).saturating_sub(margin);
                if stop.len() >= shortest && is_at_rest(&log.gyro[stop.clone()]) {
                    stops.push(stop);
                }
                first = None;
            }
            _ => {}
        }
    }
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

/// Converts stops given as times to ranges of samples.
///
/// # Errors
///
/// [`Unfit::Setting`] for a stop that is empty or outside the log.
pub fn given_stops(
    log: &Log,
    stops_s: &[[f64; 2]],
) -> Result<Vec<core::ops::Range<usize>>, InstrumentError> {
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

/// The variance, summed over three axes, of each window.
struct Windows {
    variance: Vec<f64>,
}

impl Windows {
    fn of(samples: &[[f64; 3]], window: usize) -> Self {
        let mut variance = vec![0.0; samples.len() + 1 - window];
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
            }
        }
        Self { variance }
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
