//! Samples that hold more than any noise would.

use gyrocal_statistics::{median, robust_sigma, upper_median};
use serde::Serialize;

/// Samples of the running median that a sample is held against: it follows noise as slow as that of a gyro, and a step,
/// and five wild samples of eleven do not move it.
const WINDOW: usize = 11;

/// Deviation from it beyond which a sample is no noise, in robust standard deviations. Beside a step the median is the
/// outermost of six samples, and filtered noise is near its median: six would take one log of sixty for wrong.
const FAR: f64 = 8.0;

/// Deviation beyond which it stands out of the samples about it, in their own robust standard deviations: of motion, the
/// samples at the height of a bump deviate by one to two of these.
const BESIDE: f64 = 4.0;

/// Share of the samples above which wild values are the noise of this sensor.
const LARGEST_SHARE: f64 = 0.01;

/// Samples that are told one by one.
const TOLD: usize = 100;

/// A sample that no noise explains.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BadSample {
    /// Its number in the log, from one.
    pub sample: usize,
    /// Its time after the first sample \[s\].
    pub time_s: f64,
    /// Its value, in the unit of the answer.
    pub value: f64,
}

/// Samples that no noise explains, each with the running median in its place.
pub(crate) struct WithoutBadSamples {
    pub(crate) values: Vec<f64>,
    /// Places of the samples; empty if there are none, or so many that they are the noise.
    pub(crate) places: Vec<usize>,
}

impl WithoutBadSamples {
    pub(crate) fn of(values: &[f64]) -> Self {
        Self::among(values, values.len(), false)
    }

    /// The same of an instrument that turns between stops: those that are farther off than it ever turns, and no more than
    /// so many in a row, which may be a short turn. A turn that shakes has lesser ones.
    pub(crate) fn beyond_turns(values: &[f64], most_in_a_row: usize) -> Self {
        Self::among(values, most_in_a_row, true)
    }

    fn among(values: &[f64], most: usize, turns: bool) -> Self {
        let medians = running_median(values);
        let off = |place: usize| (values[place] - medians[place]).abs();
        let mut sizes: Vec<f64> = (0..values.len()).map(off).collect();
        let limit = FAR * robust_sigma(&mut sizes);
        let rest = if turns { median(&medians) } else { 0.0 };
        let of_turns = medians.iter().map(|own| (own - rest).abs());
        let fastest = if turns {
            of_turns.fold(0.0, f64::max)
        } else {
            0.0
        };
        let mut found: Vec<usize> = (0..values.len())
            .filter(|place| off(*place) > limit.max(fastest))
            .collect();
        let far = found.len();
        found.retain(|place| off(*place) > BESIDE * scale_about(values, *place, medians[*place]));
        let rows = found.chunk_by(|one, next| one + 1 == *next);
        let mut places: Vec<usize> = rows
            .filter(|row| row.len() <= most)
            .flatten()
            .copied()
            .collect();
        // Short turns are far off and no noise.
        let wild = if turns { places.len() } else { far };
        // A sensor whose values hardly ever change has no scale that could tell.
        if limit == 0.0 || wild as f64 > (LARGEST_SHARE * values.len() as f64).max(1.0) {
            places.clear();
        }
        let mut cleaned = values.to_vec();
        for place in &places {
            cleaned[*place] = medians[*place];
        }
        Self {
            values: cleaned,
            places,
        }
    }

    /// The first of them.
    pub(crate) fn told(&self, values: &[f64], interval_s: f64) -> Vec<BadSample> {
        let first = self.places.iter().take(TOLD);
        first
            .map(|place| BadSample {
                sample: place + 1,
                time_s: *place as f64 * interval_s,
                value: values[*place],
            })
            .collect()
    }
}

/// Robust standard deviation about `median` of the samples about one.
fn scale_about(values: &[f64], place: usize, median: f64) -> f64 {
    let about = place.saturating_sub(WINDOW / 2)..values.len().min(place + WINDOW / 2 + 1);
    let others = about.filter(|other| *other != place);
    robust_sigma(
        &mut others
            .map(|other| (values[other] - median).abs())
            .collect::<Vec<f64>>(),
    )
}

/// Median of the samples about each.
fn running_median(values: &[f64]) -> Vec<f64> {
    let half = WINDOW / 2;
    let mut window = Vec::with_capacity(WINDOW);
    let mut of_place = |place: usize| {
        window.clear();
        let to = values.len().min(place + half + 1);
        window.extend_from_slice(&values[place.saturating_sub(half)..to]);
        upper_median(&mut window).unwrap_or(values[place])
    };
    (0..values.len()).map(&mut of_place).collect()
}

#[cfg(test)]
mod tests {
    use gyrocal_truth::units::sensor_noise::{Filter, SensorNoise};

    use super::*;

    fn bad(values: &[f64]) -> usize {
        WithoutBadSamples::of(values).places.len()
    }

    #[test]
    fn sound_logs_keep_all_samples() {
        for seed in 0..200 {
            let noise = SensorNoise {
                random_walk: 30.0,
                bias_instability: 5.0,
                filter: [Filter::None, Filter::Lag(3.0), Filter::MovingMean(5)][seed as usize % 3],
                ..SensorNoise::default()
            };
            // A step is slow noise.
            let mut values = noise.rates(4000, seed);
            values[2000..].iter_mut().for_each(|rate| *rate += 500.0);
            assert_eq!(bad(&values), 0, "{seed}");
            // Coarse steps leave no scale, or one of a step.
            let step = [20.0, 45.0, 100.0][seed as usize / 3 % 3];
            let coarse: Vec<f64> = values
                .iter()
                .map(|rate| (rate / step).round() * step)
                .collect();
            assert_eq!(bad(&coarse), 0, "{seed}");
        }
    }

    #[test]
    fn turns_are_no_bad_samples() {
        let noise = SensorNoise {
            random_walk: 30.0,
            ..SensorNoise::default()
        };
        // Turns that last 6 to 40 samples, in the sine of half a period or of a whole one.
        for samples in 6..40 {
            let mut values = noise.rates(4000, samples as u64);
            for first in (100..3900).step_by(300) {
                for at in 0..samples {
                    let phase = core::f64::consts::PI * at as f64 / samples as f64;
                    let rate = [phase.sin(), (2.0 * phase).sin()][samples % 2];
                    values[first + at] += 1e5 * rate;
                }
            }
            let mut wild = values.clone();
            let bad = |values: &[f64]| WithoutBadSamples::beyond_turns(values, 2).places;
            assert!(bad(&values).is_empty(), "{samples}");
            // At rest, and at the height of a turn: of one that the median does not follow it is told where it is long.
            let both = [60, 700 + samples / 2];
            both.iter().for_each(|place| wild[*place] += 1e6);
            let found = bad(&wild);
            assert_eq!(found[0], 60, "{samples}");
            assert!(found.iter().all(|place| both.contains(place)), "{samples}");
        }
    }

    #[test]
    fn what_one_sample_of_fifty_does_is_noise() {
        let mut values = SensorNoise {
            random_walk: 30.0,
            ..SensorNoise::default()
        }
        .rates(4000, 1);
        values
            .iter_mut()
            .step_by(500)
            .for_each(|rate| *rate += 900.0);
        assert_eq!(bad(&values), 8);
        values
            .iter_mut()
            .step_by(50)
            .for_each(|rate| *rate += 900.0);
        assert_eq!(bad(&values), 0);
    }
}
