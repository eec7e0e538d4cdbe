//! Logs without samples that no noise explains.

use gyrocal::generated::catalogue::RATES;
use serde::Serialize;

use super::Log;
use crate::bad_samples::{BadSample, WithoutBadSamples};
use crate::earth_rate::deg_per_h;

/// Samples of one gyro of a log that no noise explains: more than eight robust standard deviations from the median of
/// those about them, and at most one of a hundred. The median takes their place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BadSamples {
    /// Number of the log, from zero.
    pub log: usize,
    /// Name of the gyro.
    pub gyro: String,
    /// Number of these samples.
    pub count: usize,
    /// The first hundred of them.
    pub samples: Vec<BadSample>,
    /// Unit of their values: `deg/h`, or `counts` of a gyro without a scale.
    pub unit: String,
}

/// Samples in a row that no turn between stops is as short as.
const SHORTER_THAN_A_TURN: usize = 2;

impl Log {
    /// The log with the medians in the place of the samples of gyros that no noise explains; [`Self::bad_samples`] has
    /// them. Of a log that `turns` such are farther off than it ever turns, and only one or two in a row: more may be
    /// a short turn.
    #[must_use]
    pub fn without_bad_samples(mut self, turns: bool) -> Self {
        let in_counts = self.gyro_in_counts;
        let in_unit = |value: f64| if in_counts { value } else { deg_per_h(value) };
        let values = |log: &Self, gyro: usize| -> Vec<f64> {
            log.gyro.iter().map(|rate| in_unit(rate[gyro])).collect()
        };
        for (gyro, rate) in RATES.iter().enumerate().take(3) {
            let values = values(&self, gyro);
            let cleaned = match turns {
                true => WithoutBadSamples::beyond_turns(&values, SHORTER_THAN_A_TURN),
                false => WithoutBadSamples::of(&values),
            };
            if cleaned.places.is_empty() {
                continue;
            }
            let per_unit = in_unit(1.0);
            for place in &cleaned.places {
                self.gyro[*place][gyro] = cleaned.values[*place] / per_unit;
            }
            self.bad_samples.push(BadSamples {
                log: 0,
                gyro: rate.id.to_owned(),
                count: cleaned.places.len(),
                samples: cleaned.told(&values, self.interval_s),
                unit: match in_counts {
                    true => "counts".to_owned(),
                    false => "deg/h".to_owned(),
                },
            });
        }
        self
    }
}

/// Bad samples of several logs, each with the number of its log.
pub(crate) fn of_logs<'a>(logs: impl IntoIterator<Item = &'a Log>) -> Vec<BadSamples> {
    let logs = logs.into_iter().enumerate();
    let numbered = logs.flat_map(|(log, one)| {
        let own = one.bad_samples.iter().cloned();
        own.map(move |bad| BadSamples { log, ..bad })
    });
    numbered.collect()
}
