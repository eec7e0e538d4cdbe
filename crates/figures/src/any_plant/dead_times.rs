//! Inputs that act late, by any part of a row up to twenty rows.

use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::simulated::{Kind, Setting, Stream, simulate};
use super::{Of, ROWS, holds, in_turn, prepared};
use crate::harness::{Context, Error, Figure, Row};

/// Seed of the records; no constant was tuned on them.
const DEAD_TIMES: u64 = 710_000;

/// Plants whose simulators have a dead time, the effect, and the longest, rows: the servo's own loop bears no more.
const PLANTS: [Kind; 2] = [Kind::Duffing, Kind::Servo];
const EFFECTS: [&str; 2] = ["u.delay", "drive.delay"];
const MOST_ROWS: [f64; 2] = [20.0, 1.8];
const LEAST_ROWS: f64 = 0.1;

/// Half of a 95 % interval over the standard deviation.
const NORMAL_95: f64 = 1.96;

/// What is said of a record.
#[derive(Clone, Serialize, Deserialize)]
struct Said {
    /// Whether the nominal model has a fit.
    fits: bool,
    holds: bool,
    /// Whether a second effect is named beside it.
    another: bool,
    /// Whether the interval of the dead time holds the truth, where the effect itself is named.
    covers: Option<bool>,
}

/// Records of two plants with a hidden dead time.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let population = in_turn("dead-times", &PLANTS, [DEAD_TIMES, 500, 5], |kind, seed| {
        said(kind, seed, &plants[kind as usize])
    });
    let fitted =
        |said: fn(&Said) -> bool| move |one: &Of<Said>| one.found.fits.then(|| said(&one.found));
    let rows = [
        Row::share(
            "any plant: a dead time of 0.1 to 20 rows: in a set",
            fitted(|said| said.holds),
        )
        .at_least(0.93, "sets of 95 %"),
        Row::share(
            "... another effect named beside the dead time",
            fitted(|said| said.another),
        ),
        Row::share(
            "... the dead time in its 95 % interval",
            |one: &Of<Said>| one.found.covers,
        ),
    ];
    context.measure(&population, &rows)
}

fn said(kind: Kind, seed: u64, plant: &LoadedPlant) -> Result<Said, Error> {
    let place = PLANTS.iter().position(|one| *one == kind).unwrap_or(0);
    let mut random = Stream::new(seed, 24);
    let mut setting = Setting::random(kind, seed, ROWS);
    let rows_late = random.log_between(LEAST_ROWS, MOST_ROWS[place]);
    setting.hidden = ("drive.late_rows", rows_late);
    let record = prepared(plant, simulate(&setting, None))?;
    let found = match diagnose(plant, record, None, &SearchOptions::default()) {
        Err(PlantError::NoFit { .. }) => None,
        found => Some(found?.answer),
    };
    let effect = EFFECTS[place];
    let findings = found.as_ref().map_or(&[][..], |found| &found.findings);
    let named = findings.iter().find(|one| one.effect == effect);
    let size = named.and_then(|named| named.parameters.first());
    let truth = rows_late * kind.facts().step_s;
    Ok(Said {
        fits: found.is_some(),
        holds: findings.iter().any(|one| holds(one, effect)),
        another: findings.len() > 1,
        covers: size
            .and_then(|size| Some((size.estimate - truth).abs() <= NORMAL_95 * size.sigma?)),
    })
}
