//! Clocks of logs: time stamps as they are, a steady clock behind stamps that jitter, samples at equal
//! intervals.

use gyrocal_statistics::{median, quantile};
use serde::Serialize;

/// Origin of the times of a log.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Clock {
    /// The time stamps of the file.
    #[default]
    Stamps,
    /// A rate.
    Rate,
    /// A steady clock fitted to time stamps that jitter.
    Steady {
        /// Rms deviation of the stamps from it \[s\].
        jitter_s: f64,
    },
    /// Time stamps that jitter, with the samples interpolated at equal intervals.
    Resampled {
        /// Rms deviation of the intervals from their median \[s\].
        jitter_s: f64,
    },
}

impl Clock {
    /// A sentence for the user; `None` if there is nothing to tell.
    #[must_use]
    pub fn note(self) -> Option<String> {
        match self {
            Self::Stamps | Self::Rate => None,
            Self::Steady { jitter_s } => Some(format!(
                "Time stamps jitter by {:.2} ms rms about a steady clock and no sample is missing: \
                 samples are taken at equal intervals.",
                1e3 * jitter_s
            )),
            Self::Resampled { jitter_s } => Some(format!(
                "Intervals between samples scatter by {:.2} ms rms: samples are interpolated at equal \
                 intervals.",
                1e3 * jitter_s
            )),
        }
    }
}

/// Times of a steady clock.
#[derive(Debug)]
pub(crate) struct SteadyClock {
    pub(crate) time_s: Vec<f64>,
    pub(crate) jitter_s: f64,
}

/// Change of the delay of stamps, in samples, that a lost sample causes and jitter does not.
const LOST: f64 = 0.6;

/// Part of the spread of the delays that block medians may vary by: samples that arrive in packets.
const PACKETS: f64 = 0.15;

/// The steady clock of samples whose stamps never fall; the numbers of the samples between which some are
/// missing if there is none.
///
/// Lost samples delay all stamps after them, jitter and packets only some: medians over blocks tell.
pub(crate) fn steady_clock(stamps: &[f64]) -> Result<SteadyClock, [usize; 2]> {
    let count = stamps.len();
    // Even, for stamps that are late by turns.
    let block = 2 * (count / 16).clamp(1, 32);
    if count < 8 {
        return Err([0, count.saturating_sub(1)]);
    }
    if Rounded::of(stamps).is_some_and(|rounded| rounded.is_whole()) {
        return Ok(fitted(stamps));
    }
    let rough = fitted(stamps);
    let rough_s = (rough.time_s[count - 1] - rough.time_s[0]) / (count - 1) as f64;
    if rough_s.is_nan() || rough_s <= 0.0 {
        return Err([0, count - 1]);
    }
    // Delays against the line, in samples: without their trend medians over blocks do not depend on packets.
    let delays: Vec<f64> = stamps
        .iter()
        .zip(&rough.time_s)
        .map(|(stamp, time)| (stamp - time) / rough_s)
        .collect();
    let medians: Vec<f64> = delays.chunks_exact(block).map(median).collect();
    let steps: Vec<f64> = medians.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // What lost samples add to the slope of the line.
    let slope = median(&steps);
    let spreads: Vec<f64> = delays.chunks_exact(block).map(spread).collect();
    let limit = LOST + PACKETS * median(&spreads);
    for (number, three) in medians.windows(3).enumerate() {
        let change = three[2] - three[0] - 2.0 * slope;
        if change.abs() > limit {
            return Err([number * block, ((number + 3) * block).min(count) - 1]);
        }
    }
    Ok(fitted(stamps))
}

/// Stamps in steps, each of several samples, as those of whole seconds.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounded {
    /// Usual step \[s\].
    pub(crate) step_s: f64,
    /// Shortest and longest step \[s\].
    steps_s: [f64; 2],
    /// Fewest and most samples of a step, but for the first and the last.
    pub(crate) samples: [usize; 2],
    /// Their mean.
    pub(crate) mean: f64,
    /// Range of the number of samples up to a step about that of equal steps.
    drift: f64,
}

impl Rounded {
    /// The steps of stamps that never fall; `None` if most do not repeat the one before.
    pub(crate) fn of(stamps: &[f64]) -> Option<Self> {
        const FEWEST_SAMPLES: f64 = 2.5;
        const FEWEST_STEPS: usize = 3;
        let groups: Vec<&[f64]> = stamps.chunk_by(|one, next| one == next).collect();
        let inner = groups.get(1..groups.len().checked_sub(1)?)?;
        let lengths = || inner.iter().map(|group| group.len());
        let mean = lengths().sum::<usize>() as f64 / inner.len() as f64;
        let mut sum = 0.0;
        let drifts: Vec<f64> = lengths()
            .map(|length| {
                sum += length as f64 - mean;
                sum
            })
            .collect();
        if inner.len() < FEWEST_STEPS || mean < FEWEST_SAMPLES {
            return None;
        }
        let steps: Vec<f64> = groups
            .windows(2)
            .map(|pair| pair[1][0] - pair[0][0])
            .collect();
        Some(Self {
            step_s: median(&steps),
            steps_s: [quantile(&steps, 0.0), quantile(&steps, 1.0)],
            samples: [lengths().min()?, lengths().max()?],
            mean,
            drift: quantile(&drifts, 1.0) - quantile(&drifts, 0.0),
        })
    }

    /// Whether no sample is missing: steps are equal, and rounding alone tells how many samples each has.
    fn is_whole(&self) -> bool {
        const EQUAL: f64 = 0.01;
        // One sample at either end of a step may be rounded either way.
        const ROUNDING: f64 = 2.001;
        let [shortest_s, longest_s] = self.steps_s;
        longest_s - shortest_s <= EQUAL * self.step_s && self.drift <= ROUNDING
    }
}

fn spread(delays: &[f64]) -> f64 {
    quantile(delays, 0.9) - quantile(delays, 0.1)
}

/// Least-squares line through the stamps.
fn fitted(stamps: &[f64]) -> SteadyClock {
    let count = stamps.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = stamps.iter().sum::<f64>() / count;
    let (mut products, mut squares) = (0.0, 0.0);
    for (sample, stamp) in stamps.iter().enumerate() {
        let from_middle = sample as f64 - middle;
        products += from_middle * (stamp - mean);
        squares += from_middle * from_middle;
    }
    let interval_s = products / squares;
    let time_s: Vec<f64> = (0..stamps.len())
        .map(|sample| mean + (sample as f64 - middle) * interval_s)
        .collect();
    let deviations = stamps
        .iter()
        .zip(&time_s)
        .map(|(stamp, time)| (stamp - time).powi(2));
    SteadyClock {
        jitter_s: (deviations.sum::<f64>() / count).sqrt(),
        time_s,
    }
}

/// Samples interpolated linearly at times between those of the samples.
pub(crate) fn resampled(time_s: &[f64], samples: &[[f64; 3]], at_s: &[f64]) -> Vec<[f64; 3]> {
    let mut later = 1;
    at_s.iter()
        .map(|at| {
            while later + 1 < time_s.len() && time_s[later] < *at {
                later += 1;
            }
            let (before, after) = (&samples[later - 1], &samples[later]);
            let share = (at - time_s[later - 1]) / (time_s[later] - time_s[later - 1]);
            core::array::from_fn(|axis| before[axis] + share * (after[axis] - before[axis]))
        })
        .collect()
}

/// Interpolates missing values between their neighbours; before the first and after the last they are as
/// those.
pub(crate) fn fill(time_s: &[f64], column: &mut [f64]) {
    let known: Vec<usize> = (0..column.len())
        .filter(|row| !column[*row].is_nan())
        .collect();
    let (Some(first), Some(last)) = (known.first(), known.last()) else {
        return;
    };
    let (at_first, at_last) = (column[*first], column[*last]);
    column[..*first].fill(at_first);
    column[*last..].fill(at_last);
    for pair in known.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let length_s = time_s[to] - time_s[from];
        for row in from + 1..to {
            // Samples of a packet may share a stamp.
            let share = match length_s > 0.0 {
                true => (time_s[row] - time_s[from]) / length_s,
                false => 0.0,
            };
            column[row] = column[from] + share * (column[to] - column[from]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Stamps of a clock of 104 Hz in whole milliseconds, delayed by up to eight of them.
    fn stamps(lost: Option<usize>) -> Vec<f64> {
        let mut state = 7_u64;
        (0..2000)
            .map(|sample| {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                let delay = (state >> 33) as f64 / f64::from(1_u32 << 31) * 8e-3;
                let passed = sample + usize::from(lost.is_some_and(|lost| sample >= lost));
                ((passed as f64 / 104.0 + delay) * 1e3).round() * 1e-3
            })
            .collect()
    }

    #[test]
    fn jitter_is_no_gap_and_a_lost_sample_is_one() {
        let steady = steady_clock(&stamps(None)).expect("no sample is missing");
        let interval_s = steady.time_s[1] - steady.time_s[0];
        // A delay of 2.3 ms rms over the root of 2000 and over 19 s.
        assert!((interval_s * 104.0 - 1.0).abs() < 1e-4, "{interval_s}");
        assert!(
            (2e-3..3e-3).contains(&steady.jitter_s),
            "{}",
            steady.jitter_s
        );
        for lost in [300, 1000, 1031, 1701] {
            let [from, to] = steady_clock(&stamps(Some(lost))).expect_err("a gap");
            assert!(from <= lost && lost <= to, "{lost}: {from} to {to}");
        }
    }

    #[test]
    fn packets_are_no_gaps() {
        // Ten samples arrive together.
        let packets: Vec<f64> = (0..1000).map(|sample| 0.1 * (sample / 10) as f64).collect();
        let steady = steady_clock(&packets).expect("no sample is missing");
        assert!((steady.time_s[999] - steady.time_s[0] - 9.99).abs() < 0.05);
    }

    #[test]
    fn samples_are_interpolated() {
        let found = resampled(
            &[0.0, 1.0, 3.0],
            &[[0.0; 3], [1.0; 3], [5.0; 3]],
            &[0.5, 2.0, 3.0],
        );
        assert_eq!(found, [[0.5; 3], [3.0; 3], [5.0; 3]]);
    }
}
