use gyrocal::ControllerError;
use gyrocal::watch::Grid;
use serde::{Deserialize, Serialize};

use crate::lane::{Injected, Lane};
use crate::noise::Noise;
use crate::platform::Platform;
use crate::sizes::EFFECTS;

/// Steps before the knock, at least.
const SETTLED: usize = 5 * 1440;

/// A knocked platform.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Knocked {
    /// Steps from the knock to an alarm of the jumps.
    pub steps: Option<usize>,
    /// Whether the axis is the most likely cause.
    pub axis: bool,
    /// The size, rad.
    pub size: f64,
}

/// Platforms of one number with a knock whose whole information has the root `z`, `lanes` of them.
///
/// # Errors
/// If the filter fails.
pub fn knocks(
    population: u64,
    number: u64,
    z: f64,
    lanes: usize,
) -> Result<Vec<Knocked>, ControllerError> {
    let onset = SETTLED + (number as usize * 17) % 120;
    let axis = number as usize % 3;
    let (walk, effect) = (1e-5, Injected::Knock(axis));
    let mut unit = [Lane {
        injected: Some((effect, 1.0, onset)),
        ..Lane::silent()
    }];
    Platform::new(population, number, onset + 1440, walk)?.run(&mut unit, |_, _| false)?;
    let size = z / unit[0].information[0].sqrt();
    let seed = population.wrapping_mul(1_000_003).wrapping_add(number);
    let mut all: Vec<Lane> = (0..lanes as u64)
        .map(|stream| Lane {
            injected: Some((effect, size, onset)),
            ..Lane::noisy(seed, stream, Noise::Declared, walk)
        })
        .collect();
    Platform::new(population, number, onset + 240, walk)?.run(&mut all, |_, _| false)?;
    let of_lane = |lane: &Lane| Knocked {
        steps: lane
            .alarm
            .filter(|(row, grid)| *row > onset && *grid == Grid::Jumps)
            .map(|(row, _)| row - onset),
        axis: lane.set.first() == Some(&(EFFECTS + axis)),
        size,
    };
    Ok(all.iter().map(of_lane).collect())
}
