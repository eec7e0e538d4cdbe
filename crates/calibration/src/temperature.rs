//! What effects depend on that follows from the logged temperature of a record.

use core::ops::Range;

use gyrocal::Regressors;
use gyrocal_record::Record;
use gyrocal_statistics::{PLAY_OF_HYSTERESIS, followed_with_play, local_lines, local_slopes};

/// Number of regressors of the platform: temperature, then what derives from it.
pub const REGRESSORS: usize = 3;

/// Half width of the window whose slope is the rate of change at a row, s. With rows of a minute, noise of
/// 0.01 K gives a rate with a standard deviation of 0.008 K/h; a wave of six hours keeps 99 % of its rate.
const RATE_HALF_WIDTH_S: f64 = 1200.0;

/// Half width of the window whose straight line gives the temperature that a play follows, s: noise of
/// single rows would push the play, and always outwards. With rows of a minute a fifth of it is left, and a
/// half in the first and last rows; a wave of six hours with an amplitude of 1 K is off by at most 6 mK. In
/// records with a row each five minutes or fewer nothing is taken in the first and last ones.
const SMOOTHING_HALF_WIDTH_S: f64 = 600.0;

const HOUR_S: f64 = 3600.0;

/// What temperatures of a record, or of several together, are related to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TemperatureScale {
    /// Their mean.
    mean_c: f64,
    /// Play of the hysteresis to either side, from the largest range of one record.
    half_play_k: f64,
    /// Mean of what a play does not follow.
    mean_hysteresis_k: f64,
}

/// The regressors at each row of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct TemperatureCourse {
    pub(crate) temperature_k: Vec<f64>,
    pub(crate) rate_k_per_h: Vec<f64>,
    pub(crate) hysteresis_k: Vec<f64>,
}

impl TemperatureScale {
    /// Of all rows of a record, or of several with the first rows of the later ones, with each of which a
    /// play begins anew; `None` without temperature.
    pub(crate) fn of(record: &Record, starts: &[usize]) -> Option<Self> {
        Self::with_play(record, starts, half_play_k(record, starts)?)
    }

    /// The same of a record with the play of another record of the same platform.
    pub(crate) fn with_play_of(record: &Record, other: &Record) -> Option<Self> {
        let play_k = half_play_k(other, &[]).or(half_play_k(record, &[]))?;
        Self::with_play(record, &[], play_k)
    }

    fn with_play(record: &Record, starts: &[usize], half_play_k: f64) -> Option<Self> {
        let logged = record.temperature_c.as_ref()?;
        let mean = |sum: f64| sum / logged.len().max(1) as f64;
        let sum_of_hysteresis = smooth(record, starts)?
            .iter()
            .map(|rows| hysteresis(rows, half_play_k).sum::<f64>())
            .sum();
        Some(Self {
            mean_c: mean(logged.iter().sum()),
            half_play_k,
            mean_hysteresis_k: mean(sum_of_hysteresis),
        })
    }
}

impl TemperatureCourse {
    /// Of rows that follow each other in one turn-on.
    pub(crate) fn of_rows(
        record: &Record,
        rows: Range<usize>,
        scale: TemperatureScale,
    ) -> Option<Self> {
        let logged = record.temperature_c.as_ref()?.get(rows.clone())?;
        let time_s = &record.time_s[rows];
        let slopes = local_slopes(time_s, logged, RATE_HALF_WIDTH_S);
        let smooth = local_lines(time_s, logged, SMOOTHING_HALF_WIDTH_S);
        Some(Self {
            temperature_k: logged.iter().map(|value| value - scale.mean_c).collect(),
            rate_k_per_h: slopes.into_iter().map(|slope| HOUR_S * slope).collect(),
            hysteresis_k: hysteresis(&smooth, scale.half_play_k)
                .map(|value| value - scale.mean_hysteresis_k)
                .collect(),
        })
    }

    /// The regressors at a row.
    pub(crate) fn at(&self, row: usize) -> Regressors<f64> {
        Regressors {
            temperature_k: self.temperature_k[row],
            temperature_rate_k_per_h: self.rate_k_per_h[row],
            temperature_hysteresis_k: self.hysteresis_k[row],
        }
    }

    /// The regressors between a row and the next, on straight lines.
    pub(crate) fn between(&self, row: usize, share: f64) -> Regressors<f64> {
        let (before, after) = (self.at(row).to_array(), self.at(row + 1).to_array());
        Regressors::from_array(core::array::from_fn(|place| {
            (1.0 - share) * before[place] + share * after[place]
        }))
    }

    /// Adds the rows of a later record.
    pub(crate) fn append(&mut self, later: Self) {
        self.temperature_k.extend(later.temperature_k);
        self.rate_k_per_h.extend(later.rate_k_per_h);
        self.hysteresis_k.extend(later.hysteresis_k);
    }
}

/// What is subtracted from each regressor of a record, with the play of another record of the same platform
/// or its own; `None` without temperature.
#[must_use]
pub fn regressor_means(record: &Record, play_of: &Record) -> Option<[f64; REGRESSORS]> {
    let scale = TemperatureScale::with_play_of(record, play_of)?;
    Some([scale.mean_c, 0.0, scale.mean_hysteresis_k])
}

/// Play to either side of a record, or of several with the first rows of the later ones.
fn half_play_k(record: &Record, starts: &[usize]) -> Option<f64> {
    let smooth = smooth(record, starts)?;
    let ranges = smooth.iter().map(|rows| {
        let least = rows.iter().copied().fold(f64::INFINITY, f64::min);
        rows.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
    });
    Some(0.5 * PLAY_OF_HYSTERESIS * ranges.fold(0.0, f64::max))
}

/// The temperature of each record without most of its noise, with the first rows of the later ones.
fn smooth(record: &Record, starts: &[usize]) -> Option<Vec<Vec<f64>>> {
    let logged = record.temperature_c.as_ref()?;
    let rows = each(logged, starts).zip(each(&record.time_s, starts));
    Some(
        rows.map(|(logged, time_s)| local_lines(time_s, logged, SMOOTHING_HALF_WIDTH_S))
            .collect(),
    )
}

/// The values of each record, with the first rows of the later ones.
fn each<'a>(values: &'a [f64], starts: &'a [usize]) -> impl Iterator<Item = &'a [f64]> {
    let firsts = core::iter::once(&0).chain(starts);
    let ends = starts.iter().copied().chain([values.len()]);
    firsts
        .zip(ends)
        .filter_map(|(first, end)| values.get(*first..end))
}

/// What a play does not follow.
fn hysteresis(values: &[f64], half_play: f64) -> impl Iterator<Item = f64> {
    let followed = followed_with_play(values, half_play);
    values
        .iter()
        .zip(followed)
        .map(|(value, followed)| value - followed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(temperature_c: Vec<f64>) -> Record {
        let rows = temperature_c.len();
        Record {
            time_s: (0..rows).map(|row| 600.0 * row as f64).collect(),
            accel_g: vec![[0.0, 0.0, 1.0]; rows],
            temperature_c: Some(temperature_c),
        }
    }

    fn course(record: &Record) -> Option<TemperatureCourse> {
        let scale = TemperatureScale::of(record, &[])?;
        TemperatureCourse::of_rows(record, 0..record.len(), scale)
    }

    #[test]
    fn regressors_of_a_rise_and_a_fall() {
        // Four kelvin up and down, so that the play is half a kelvin to either side.
        let up = (0..=8).map(|row| 20.0 + 0.5 * f64::from(row));
        let down = (0..8).rev().map(|row| 20.0 + 0.5 * f64::from(row));
        let course = course(&record(up.chain(down).collect())).unwrap_or_default();
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        assert!(mean(&course.temperature_k).abs() < 1e-12);
        assert!(mean(&course.hysteresis_k).abs() < 1e-12);
        // Half a kelvin in ten minutes; five rows in the window.
        for (row, expected) in [(0, 3.0), (4, 3.0), (8, 0.0), (12, -3.0), (16, -3.0)] {
            assert!((course.rate_k_per_h[row] - expected).abs() < 1e-9, "{row}");
        }
        // Up and down differ by the play.
        let (up, down) = (course.hysteresis_k[4], course.hysteresis_k[12]);
        assert!((up - down - 1.0).abs() < 1e-12, "{up} {down}");
    }

    #[test]
    fn several_records_have_one_scale_and_their_own_plays() {
        // Ranges of four and two kelvin; nine over both.
        let both = record(vec![20.0, 22.0, 24.0, 29.0, 28.0, 27.0]);
        let scale = TemperatureScale::of(&both, &[3]).unwrap_or(TemperatureScale {
            mean_c: 0.0,
            half_play_k: 0.0,
            mean_hysteresis_k: 0.0,
        });
        assert_eq!((scale.mean_c, scale.half_play_k), (25.0, 0.5));
        // Raw: 0, 1/2, 1/2 and 0, -1/2, -1/2.
        assert_eq!(scale.mean_hysteresis_k, 0.0);
        let later = TemperatureCourse::of_rows(&both, 3..6, scale).unwrap_or_default();
        assert_eq!(later.hysteresis_k, [0.0, -0.5, -0.5]);
        assert_eq!(later.temperature_k, [4.0, 3.0, 2.0]);
        assert!(
            later
                .rate_k_per_h
                .iter()
                .all(|rate| (rate + 6.0).abs() < 1e-9)
        );
        let without = Record {
            temperature_c: None,
            ..both
        };
        assert_eq!(course(&without), None);
        assert_eq!(regressor_means(&without, &without), None);
    }

    #[test]
    fn noise_of_single_rows_is_taken_in_each_record_by_itself() {
        // Two records of rows of a minute, ten kelvin apart, up and down, with alternating noise.
        let course = |row: usize| 2.0 - (2.0 - 4.0 * row as f64 / 240.0).abs();
        let noise = |row: usize| if row.is_multiple_of(2) { 0.05 } else { -0.05 };
        let of_record = |first_c: f64, noise_over: f64| -> Vec<f64> {
            let rows = 0..240;
            rows.map(|row| first_c + course(row) + noise_over * noise(row))
                .collect()
        };
        let both = |noise_over: f64| Record {
            time_s: (0..480)
                .map(|row| 60.0 * row as f64 + if row < 240 { 0.0 } else { 9e4 })
                .collect(),
            accel_g: vec![[0.0, 0.0, 1.0]; 480],
            temperature_c: Some(
                [of_record(20.0, noise_over), of_record(30.0, noise_over)].concat(),
            ),
        };
        let hysteresis = |record: &Record| -> Option<Vec<f64>> {
            let scale = TemperatureScale::of(record, &[240])?;
            let mut course = TemperatureCourse::of_rows(record, 0..240, scale)?;
            course.append(TemperatureCourse::of_rows(record, 240..480, scale)?);
            Some(course.hysteresis_k)
        };
        let [noisy, smooth] = [1.0, 0.0].map(|over| hysteresis(&both(over)).unwrap_or_default());
        assert_eq!((noisy.len(), smooth.len()), (480, 480));
        let mean = noisy.iter().sum::<f64>() / 480.0;
        assert!(mean.abs() < 1e-12, "{mean}");
        for (row, (noisy, smooth)) in noisy.iter().zip(&smooth).enumerate() {
            // A twenty-first of the noise inside, a third at the ends, where a play begins with it.
            assert!(
                (noisy - smooth).abs() < 0.05 / 3.0,
                "{row}: {noisy} {smooth}"
            );
        }
    }
}
