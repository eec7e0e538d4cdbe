//! The periodogram, and a search for lines up to half the sampling rate.

use core::f64::consts::TAU;

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex64;
use rustfft::{Fft as _, FftDirection};

use crate::error::StatisticsError;
use crate::math::{atan2, exp, exp_m1, ln, sin_cos};
use crate::probability::p_of_least;
use crate::sampling::median_interval_s;
use crate::whiteness::check_probability;

/// The transform is this many times longer than the record, so that a line between two of its own
/// frequencies loses no more than 10 % of its power before it is refined.
const OVERSAMPLING: usize = 4;
/// Fewer values than this have no spectrum.
const LEAST_VALUES: usize = 16;

/// Power over frequency of one series, normalised to exponential distribution of mean one.
#[derive(Debug, Clone, PartialEq)]
pub struct Periodogram {
    /// Frequencies, from one over four times the record's length to half the sampling rate \[Hz\].
    pub frequency_hz: Vec<f64>,
    /// Power at each; of white innovations 1 in the mean.
    pub power: Vec<f64>,
    /// Power that the largest one of white innovations exceeds with the false-alarm probability.
    pub level: f64,
    /// The largest line.
    pub line: SpectralLine,
}

/// The largest spectral line of a periodogram.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpectralLine {
    /// Its frequency, between those of the transform.
    pub frequency_hz: f64,
    /// Its power.
    pub power: f64,
    /// Its amplitude in standard deviations of the series.
    pub amplitude: f64,
    /// Phase of the cosine at time zero of the record's clock \[rad\].
    pub phase_rad: f64,
    /// Probability of as large a line anywhere from white innovations.
    pub p_value: f64,
}

/// The periodogram of a series of unit variance at given times; `NaN` is missing.
///
/// Rows are put on a regular grid of the median interval, zeros where there is none, and the power
/// is that of the values that exist: exact for gaps in regular sampling. Times that are not on the
/// grid are moved to it.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] with fewer than 16 values, [`StatisticsError::UnequalLengths`], and
/// [`StatisticsError::InvalidArgument`] for a probability that is none.
pub fn periodogram(
    time_s: &[f64],
    series: &[f64],
    false_alarm: f64,
) -> Result<Periodogram, StatisticsError> {
    check_probability(false_alarm)?;
    if time_s.len() != series.len() {
        return Err(StatisticsError::UnequalLengths {
            what: "a series",
            found: series.len(),
            expected: time_s.len(),
        });
    }
    let there: Vec<(f64, f64)> = time_s
        .iter()
        .copied()
        .zip(series.iter().copied())
        .filter(|(_, v)| !v.is_nan())
        .collect();
    if there.len() < LEAST_VALUES {
        return Err(StatisticsError::TooShort {
            test: "the periodogram",
            found: there.len(),
            expected: LEAST_VALUES,
        });
    }
    let Some((mut power, step_hz)) = fourier_powers(time_s, &there) else {
        return Err(StatisticsError::TooShort {
            test: "the periodogram",
            found: there.len(),
            expected: LEAST_VALUES,
        });
    };
    for power in &mut power {
        *power /= there.len() as f64;
    }
    let frequency_hz: Vec<f64> = (1..=power.len()).map(|k| k as f64 * step_hz).collect();
    let times = there.iter().map(|(time, _)| *time);
    let searched = FrequencySearch::new(times, 0.5 / median_interval_s(time_s));
    let largest = (0..power.len())
        .max_by(|a, b| power[*a].total_cmp(&power[*b]))
        .unwrap_or(0);
    Ok(Periodogram {
        level: searched.level(false_alarm),
        line: refine(&there, frequency_hz[largest], step_hz, &searched),
        frequency_hz,
        power,
    })
}

/// Squares of the Fourier sums of values at some of the times of a record, at multiples of a
/// frequency from that itself to half the sampling rate, and that frequency \[Hz\]. `None` without
/// values.
///
/// `there` holds times and values.
#[must_use]
pub fn fourier_powers(time_s: &[f64], there: &[(f64, f64)]) -> Option<(Vec<f64>, f64)> {
    let (first_s, last_s) = (*time_s.first()?, *time_s.last()?);
    there.first()?;
    let interval_s = median_interval_s(time_s);
    let place = |time: f64| ((time - first_s) / interval_s).round() as usize;
    let rows = place(last_s) + 1;
    let length = (OVERSAMPLING * rows).next_power_of_two();
    let mut grid = vec![Complex64::default(); length];
    for (time, value) in there {
        grid[place(*time)].re += value;
    }
    // The one algorithm that a power of two needs: a planner instantiates all of them.
    Radix4::new(length, FftDirection::Forward).process(&mut grid);
    let squares = grid[1..length / 2].iter().map(|c| c.norm_sqr());
    Some((squares.collect(), 1.0 / (length as f64 * interval_s)))
}

/// The line near a frequency of the transform: its maximum by golden section, at the true times.
fn refine(
    there: &[(f64, f64)],
    near_hz: f64,
    step_hz: f64,
    searched: &FrequencySearch,
) -> SpectralLine {
    let first_s = there[0].0;
    let sums = |frequency_hz: f64| {
        there.iter().fold([0.0; 2], |[c, s], (time, value)| {
            let (sin, cos) = sin_cos(TAU * frequency_hz * (time - first_s));
            [c + value * cos, s + value * sin]
        })
    };
    let count = there.len() as f64;
    let power =
        |frequency_hz: f64| sums(frequency_hz).iter().map(|sum| sum * sum).sum::<f64>() / count;
    let frequency_hz = highest_near(power, near_hz, step_hz);
    let [cosine, sine] = sums(frequency_hz);
    let power = (cosine * cosine + sine * sine) / count;
    let phase_at_first = atan2(-sine, cosine);
    SpectralLine {
        frequency_hz,
        power,
        amplitude: 2.0 * (power / count).sqrt(),
        phase_rad: (phase_at_first - TAU * frequency_hz * first_s).rem_euclid(TAU),
        p_value: searched.probability(power),
    }
}

/// The frequency of most power within a step of one, by golden section.
pub(crate) fn highest_near(power: impl Fn(f64) -> f64, near: f64, step: f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = (near - step, near + step);
    // Twenty sections narrow the bracket by 1.5e4, far below the sigma of any frequency.
    for _ in 0..20 {
        let width = GOLDEN * (high - low);
        if power(high - width) > power(low + width) {
            high = low + width;
        } else {
            low = high - width;
        }
    }
    0.5 * (low + high)
}

/// The axis with the strongest line of three, and the probability of as strong a one in any of
/// them.
#[must_use]
pub fn strongest_line(lines: &[SpectralLine; 3]) -> (usize, f64) {
    let weaker = |a: &usize, b: &usize| lines[*a].p_value.total_cmp(&lines[*b].p_value);
    let axis = (0..3).min_by(weaker).unwrap_or(0);
    (axis, p_of_least(lines[axis].p_value, 3.0))
}

/// Extent of a search for the largest power: frequency range times effective duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrequencySearch(f64);

impl FrequencySearch {
    fn new(times_s: impl Iterator<Item = f64> + Clone, largest_hz: f64) -> Self {
        let count = times_s.clone().count() as f64;
        let mean = times_s.clone().sum::<f64>() / count;
        let variance = times_s.map(|time| (time - mean).powi(2)).sum::<f64>() / count;
        Self(largest_hz * (2.0 * TAU * variance).sqrt())
    }

    /// The search over all rows of a record, to half the sampling rate.
    #[must_use]
    pub fn of_times(time_s: &[f64]) -> Self {
        Self::new(time_s.iter().copied(), 0.5 / median_interval_s(time_s))
    }

    /// Natural logarithm of the probability that white noise exceeds a power anywhere, where that
    /// is small.
    #[must_use]
    pub fn ln_probability(&self, power: f64) -> f64 {
        ln(1.0 + self.0 * power.sqrt()) - power
    }

    /// Probability that white noise exceeds a power anywhere (Baluev, MNRAS 385, 1279, 2008,
    /// equations 5 and 6, for known variance): an upper bound that is close where it is small.
    fn probability(&self, power: f64) -> f64 {
        let single = exp(-power);
        let crossings = self.0 * single * power.sqrt();
        // 1 - (1 - single) exp(-crossings), without losing digits where both are small.
        single * exp(-crossings) - exp_m1(-crossings)
    }

    /// The power that belongs to a probability.
    fn level(&self, probability: f64) -> f64 {
        let (mut low, mut high) = (0.5, 700.0);
        // Sixty halvings leave less than rounding.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.probability(middle) > probability {
                low = middle
            } else {
                high = middle
            }
        }
        high
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Periodic, of unit variance, and with no line: every frequency of its length has the same
    /// power (a quadratic phase), so all else is known.
    fn chirp(rows: usize) -> Vec<f64> {
        let phase = |k: usize| core::f64::consts::PI * (k * k) as f64 / rows as f64;
        (0..rows)
            .map(|k| core::f64::consts::SQRT_2 * phase(k).cos())
            .collect()
    }

    #[test]
    fn a_line_between_frequencies_is_found_with_its_size() -> Result<(), StatisticsError> {
        let (frequency_hz, amplitude, phase) = (1.0 / 437.3, 0.25, 1.1);
        let time_s: Vec<f64> = (0..3000)
            .filter(|k| !(700..900).contains(k))
            .map(|k| 500.0 + 60.0 * f64::from(k))
            .collect();
        let white = chirp(3000);
        let series: Vec<f64> = time_s
            .iter()
            .zip(&white)
            .map(|(t, w)| w + amplitude * (TAU * frequency_hz * t + phase).cos())
            .collect();
        let found = periodogram(&time_s, &series, 0.01)?.line;
        // Sigma of amplitude is sqrt(2 / n) = 0.027, of phase that over amplitude (0.1 rad at the
        // middle, twice that at time zero), of frequency sqrt(6 / n) / (pi A T) = 3e-7 Hz.
        assert!(
            (found.frequency_hz - frequency_hz).abs() < 1e-6,
            "{found:?}"
        );
        assert!((found.amplitude - amplitude).abs() < 0.08, "{found:?}");
        assert!((found.phase_rad - phase).abs() < 0.6, "{found:?}");
        assert!(found.p_value < 1e-6, "{found:?}");
        Ok(())
    }

    #[test]
    fn the_level_belongs_to_its_probability() {
        let searched = FrequencySearch(2000.0);
        for probability in [0.3, 0.01, 1e-6] {
            let back = searched.probability(searched.level(probability));
            assert!((back / probability - 1.0).abs() < 1e-9);
        }
    }
}
