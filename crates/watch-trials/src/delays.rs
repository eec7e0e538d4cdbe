use gyrocal::ControllerError;
use gyrocal::watch::EFFECTS_BY_DEFAULT;
use serde::{Deserialize, Serialize};

use crate::lane::{Injected, Lane};
use crate::noise::Noise;
use crate::platform::Platform;

/// Steps of a day.
const DAY: usize = 1440;
/// Steps before the effect begins, at least: a filter that has settled.
const SETTLED: usize = 10 * DAY;

/// An effect whose delay is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The effect.
    pub effect: Injected,
    /// Its id in the catalogue.
    pub id: &'static str,
    /// Root of the information in the first day.
    pub sigmas_a_day: f64,
}

/// A run with an effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Delay {
    /// Days from the onset to the alarm; `None` if there was none. Negative: before the onset.
    pub days: Option<f64>,
    /// The same of the e-process with that effect alone.
    pub alone_days: Option<f64>,
    /// Whether the set at the alarm holds the effect.
    pub held: bool,
    /// Effects in that set.
    pub set: usize,
    /// Whether the effect is the first of it.
    pub first: bool,
    /// Information on a unit of the effect in its first day.
    pub information_of_a_day: f64,
}

/// Runs of one platform with each trial, `lanes` of each, for at most `days` from the onset. `walk` is
/// declared and there, deg/h/√h.
///
/// # Errors
/// If the filter fails.
pub fn delays(
    population: u64,
    number: u64,
    trials: &[Trial],
    lanes: usize,
    days: usize,
    walk: f64,
) -> Result<Vec<Vec<Delay>>, ControllerError> {
    let onset = SETTLED + (number as usize * 37) % 120;
    // What a unit of each effect shows in a day.
    let mut units: Vec<Lane> = trials
        .iter()
        .map(|trial| Lane {
            injected: Some((trial.effect, 1.0, onset)),
            ..Lane::silent()
        })
        .collect();
    let platform = Platform::new(population, number, onset + DAY + 1, walk)?;
    platform.run(&mut units, |_, _| false)?;
    let mut all = Vec::new();
    for (trial, unit) in trials.iter().zip(&units) {
        let size = trial.sigmas_a_day / unit.information[1].sqrt();
        let index = EFFECTS_BY_DEFAULT
            .iter()
            .position(|effect| effect.id == trial.id)
            .unwrap_or(usize::MAX);
        for _ in 0..lanes {
            let seed = population.wrapping_mul(1_000_003).wrapping_add(number);
            let mut lane = Lane::noisy(seed, all.len() as u64, Noise::Declared, walk);
            lane.injected = Some((trial.effect, size, onset));
            lane.alone = Some((index, None));
            all.push(lane);
        }
    }
    let platform = Platform::new(population, number, onset + days * DAY, walk)?;
    platform.run(&mut all, |_, lanes| {
        lanes.iter().all(|lane| {
            lane.alarm.is_some() && lane.alone.is_some_and(|(_, alarm)| alarm.is_some())
        })
    })?;
    let since = |row: usize| (row as f64 - onset as f64) / DAY as f64;
    let of_trial = |(lanes, unit): (&[Lane], &Lane)| {
        let of_lane = |lane: &Lane| {
            let index = lane.alone.map_or(usize::MAX, |(index, _)| index);
            Delay {
                days: lane.alarm.map(|(row, _)| since(row)),
                alone_days: lane.alone.and_then(|(_, row)| row).map(since),
                held: lane.set.contains(&index),
                set: lane.set.len(),
                first: lane.set.first() == Some(&index),
                information_of_a_day: unit.information[1],
            }
        };
        lanes.iter().map(of_lane).collect()
    };
    Ok(all.chunks(lanes.max(1)).zip(&units).map(of_trial).collect())
}
