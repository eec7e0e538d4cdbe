//! The watch: false alarms in platform-years, delays beside the test of one effect, jumps, sets, and records of the
//! nonlinear simulator.
//!
//! The gains of a filter do not depend on the noise. So one run of the real filter over a record without noise gives
//! the closed loop of a platform (`platform.rs`), through which errors of many realisations of the noise go in linear
//! simulation (`lane.rs`), each with a watch of its own. Effects enter by the specific force of the simulator and not
//! by the courses that the watch foretells.

mod delays;
mod lane;
mod noise;
mod nonlinear;
mod platform;
mod sound;

use gyrocal::watch::EFFECTS_BY_DEFAULT;

use crate::harness::{Context, Error, Figure, Population, Sources, in_turn, of};

/// Sizes of the watch and of its filter.
const STATES: usize = gyrocal::Platform::STATES;
const COLUMNS: usize = 6;
const EFFECTS: usize = EFFECTS_BY_DEFAULT.len();

/// Time between samples, s, and how many a day has.
const INTERVAL_S: f64 = 60.0;
const DAY: usize = 1440;
const DAY_S: f64 = 86_400.0;

/// Standard deviations of the declared noise of a sample: drift, deg/h, and specific force, g.
const DRIFT_NOISE: f64 = 0.002;
const ACCEL_NOISE_G: f64 = 1e-5;

/// Realisations of the noise of each platform, and of the small version.
const LANES: usize = 10;
const FEW_LANES: usize = 3;

/// What can move the results.
const SOURCES: Sources = of(
    &["", "crates/diagnosis", "crates/truth"],
    &["crates/figures/src/watch.rs", "crates/figures/src/watch"],
);

/// All figures of the part.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    in_turn(
        context,
        &[sound::figures, delays::figures, nonlinear::figures],
    )
}

/// Platforms of the usual population, by their numbers.
fn platforms<'a, R>(
    name: &str,
    [full, small]: [u64; 2],
    job: impl Fn(u64) -> Result<R, Error> + Sync + 'a,
) -> Population<'a, R> {
    Population::new(format!("watch {name}"), [0, full, small], SOURCES, job)
}

fn lanes(context: &Context) -> usize {
    if context.is_small() { FEW_LANES } else { LANES }
}
