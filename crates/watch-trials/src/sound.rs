use gyrocal::ControllerError;
use gyrocal::watch::{EFFECTS_BY_DEFAULT, Grid};
use serde::{Deserialize, Serialize};

use crate::lane::Lane;
use crate::noise::Noise;
use crate::platform::Platform;

/// Steps that an onset of jumps lives.
const JUMP_LIFE: usize = 48;
/// Days of a year.
const YEAR_DAYS: f64 = 365.25;

/// Alarms among platforms without an effect.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Sound {
    /// Platforms, each over the same time.
    pub platforms: usize,
    /// Those with an alarm.
    pub alarms: usize,
    /// Those whose first alarm was one of jumps.
    pub by_jumps: usize,
    /// Sizes of the outliers of gyros, sigma, that alarms followed within the life of a jump's onset;
    /// one for each such alarm.
    pub outliers: Vec<f64>,
    /// Days until each alarm.
    pub days: Vec<f64>,
    /// Whether the set of each alarm holds a random walk of a gyro.
    pub walks: Vec<bool>,
}

/// Platforms of one number of the population, `lanes` for each noise, over `years`; `declared` is the
/// walk that filter and watch expect, and each noise comes with the walk that there is, deg/h/√h.
///
/// # Errors
/// If the filter fails.
pub fn sound(
    population: u64,
    number: u64,
    years: f64,
    declared: f64,
    noises: &[(Noise, f64)],
    lanes: usize,
) -> Result<Vec<Sound>, ControllerError> {
    let steps = (years * YEAR_DAYS * 1440.0) as usize;
    let platform = Platform::new(population, number, steps, declared)?;
    let mut all: Vec<Lane> = Vec::new();
    for (noise, walk) in noises {
        for _ in 0..lanes {
            let stream = all.len() as u64;
            let seed = population.wrapping_mul(1_000_003).wrapping_add(number);
            all.push(Lane::noisy(seed, stream, *noise, *walk));
        }
    }
    platform.run(&mut all, |_, lanes| {
        lanes.iter().all(|lane| lane.alarm.is_some())
    })?;
    let of_noise = |lanes: &[Lane]| Sound {
        platforms: lanes.len(),
        alarms: lanes.iter().filter(|lane| lane.alarm.is_some()).count(),
        by_jumps: lanes
            .iter()
            .filter(|lane| lane.alarm.is_some_and(|(_, grid)| grid == Grid::Jumps))
            .count(),
        outliers: lanes.iter().filter_map(followed).collect(),
        days: lanes
            .iter()
            .filter_map(|lane| Some(lane.alarm?.0 as f64 / 1440.0))
            .collect(),
        walks: lanes
            .iter()
            .filter(|lane| lane.alarm.is_some())
            .map(may_walk)
            .collect(),
    };
    Ok(all.chunks(lanes.max(1)).map(of_noise).collect())
}

/// The outlier of a gyro that an alarm followed, sigma.
fn followed(lane: &Lane) -> Option<f64> {
    let ((alarm, _), (row, size)) = (lane.alarm?, lane.outlier?);
    (row <= alarm && alarm - row <= JUMP_LIFE).then_some(size)
}

/// Whether the alarm may be one of a walk that is larger than declared.
fn may_walk(lane: &Lane) -> bool {
    let mut effects = lane
        .set
        .iter()
        .filter_map(|index| EFFECTS_BY_DEFAULT.get(*index));
    effects.any(|effect| effect.walking_gyro().is_some())
}
