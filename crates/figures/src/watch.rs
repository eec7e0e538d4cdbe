//! The watch: false alarms in platform-years, delays beside the e-process of one effect, jumps, sets, and
//! records of the nonlinear simulator.
//!
//! The gains of a filter do not depend on the noise. So one run of the real filter over a record
//! without noise gives the closed loop of a platform (`platform.rs`), through which errors of many
//! realisations of the noise go in linear simulation (`lane.rs`); each has the scores of its own
//! innovations beside the signatures that all share. Effects enter by the specific force of the
//! simulator and not by the courses that the watch foretells.

mod delays;
mod knocks;
mod lane;
mod noise;
mod nonlinear;
mod platform;
mod sound;

use crate::error::Error;
use crate::figure::Figure;
use crate::truth::Extent;

/// Realisations of the noise of each platform.
const LANES: usize = 25;

/// Sizes of the watch and of its filter.
const STATES: usize = gyrocal::Platform::STATES;
const COLUMNS: usize = 6;
const EFFECTS: usize = gyrocal::watch::EFFECTS_BY_DEFAULT.len();
const ONSETS: usize = 10;
const JUMPS: usize = 12;

/// Time between samples, s, and how many a day has.
const INTERVAL_S: f64 = 60.0;
const DAY: usize = 1440;

/// Standard deviations of the declared noise of a sample: drift, deg/h, and specific force, g.
const DRIFT_NOISE: f64 = 0.002;
const ACCEL_NOISE_G: f64 = 1e-5;

/// All figures. The small version has a few platforms over weeks.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = sound::false_alarms(extent)?;
    figures.extend(sound::undeclared_walks(extent)?);
    figures.extend(delays::information(extent)?);
    figures.extend(delays::figures(extent)?);
    figures.extend(knocks::figures(extent)?);
    figures.extend(nonlinear::figures(extent)?);
    Ok(figures)
}
