//! Turns between stops in which a gyro is at the end of its range.

use core::ops::Range;

use serde::Serialize;

use crate::error::{InstrumentError, Unfit};
use crate::log::Log;
use crate::stop_means::StopMeans;

/// A turn that is left out of the calibration of the gyros: one of them is at the end of its range in it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SaturatedTurn {
    /// Time of the last sample of the stop before \[s\].
    pub from_s: f64,
    /// Time of the first sample of the stop after \[s\].
    pub to_s: f64,
    /// Column of the gyro.
    pub column: String,
    /// End of its range, in the unit of the column.
    pub end: f64,
    /// Samples there.
    pub samples: usize,
    /// Number of the first of them in the log, from one.
    pub first_sample: usize,
}

/// The saturated turns of a log between its stops.
pub(super) fn saturated_turns(log: &Log, stops: &[StopMeans]) -> Vec<SaturatedTurn> {
    let mut turns: Vec<SaturatedTurn> = Vec::new();
    for pair in stops.windows(2) {
        let turn = pair[0].samples.end..pair[1].samples.start;
        let before = turns.len();
        let inside = log.saturated.iter();
        for stretch in inside.filter(|one| has_common(&one.samples, &turn)) {
            let mut of_turn = turns[before..].iter_mut();
            let is_same =
                |one: &&mut SaturatedTurn| one.column == stretch.column && one.end == stretch.end;
            if let Some(told) = of_turn.find(is_same) {
                told.samples += stretch.samples.len();
            } else {
                turns.push(SaturatedTurn {
                    from_s: pair[0].to_s,
                    to_s: pair[1].from_s,
                    column: stretch.column.clone(),
                    end: stretch.end,
                    samples: stretch.samples.len(),
                    first_sample: stretch.samples.start + 1,
                });
            }
        }
    }
    turns
}

/// Refuses a stop in which a gyro is at the end of its range: its mean is none.
pub(super) fn refuse_saturated_stops(
    log: &Log,
    stops: &[Range<usize>],
) -> Result<(), InstrumentError> {
    let inside = log.saturated.iter().find_map(|stretch| {
        let is_in = |stop: &&Range<usize>| has_common(&stretch.samples, stop);
        Some((stretch, stops.iter().find(is_in)?))
    });
    let Some((stretch, stop)) = inside else {
        return Ok(());
    };
    Err(InstrumentError::unfit(
        Unfit::Saturated,
        format!(
            "{} samples of `{}` at the end of its range, {}, from sample {} at {} s on, in the stop from {} to {} s",
            stretch.samples.len(),
            stretch.column,
            stretch.end,
            stretch.samples.start + 1,
            log.time_s[stretch.samples.start],
            log.time_s[stop.start],
            log.time_s[stop.end - 1]
        ),
        "rates within the range of the gyro at each stop",
        "leave this stop out by giving the others with --stop, or cut the log there; samples that repeat at the end of a \
         log may be padding",
    ))
}

fn has_common(one: &Range<usize>, other: &Range<usize>) -> bool {
    one.start < other.end && other.start < one.end
}
