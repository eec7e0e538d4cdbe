//! Terms that bend where the catalogue does not say: a stop, a dead zone, an overflow. The knee is searched with the size.

use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::simulated::{Kind, Setting, Stream, simulate, with_strength};
use super::{Of, ROWS, holds, in_turn, prepared};
use crate::harness::{Context, Error, Figure, Row};

/// Seed of the records; no constant was tuned on them.
const KNEES: u64 = 700_000;

/// Plants, and the effects with a knee that their simulators have.
const PLANTS: [Kind; 2] = [Kind::Duffing, Kind::Tanks];
const EFFECTS: [&[&str]; 2] = [
    &["v_rate.above(x)", "v_rate.beyond(x)"],
    &["upper_rate.above(upper)"],
];

/// The usual sizes of their variables, as the simulators have them.
const USUAL: [f64; 2] = [1.0, 10.0];

/// Where the knee is, over the usual size of its variable, and the strength of the effect, standard deviations.
const PLACES: [f64; 2] = [0.25, 0.75];
const STRENGTHS: [f64; 2] = [8.0, 100.0];

/// Half of a 95 % interval over the standard deviation.
const NORMAL_95: f64 = 1.96;

/// What is said of a record.
#[derive(Clone, Serialize, Deserialize)]
struct Said {
    /// Whether the nominal model has a fit, and its effect acts where the knee is.
    fits: bool,
    /// Whether the set of a finding holds the effect.
    holds: bool,
    /// Whether a second effect is named beside it.
    another: bool,
    /// Whether the intervals of knee and size hold the truth, where the effect itself is named.
    knee: Option<bool>,
    size: Option<bool>,
}

/// Records of two plants, each with an effect whose knee is not where the search takes it to be.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let population = in_turn("knees", &PLANTS, [KNEES, 500, 5], |kind, seed| {
        said(kind, seed, &plants[kind as usize])
    });
    let fitted =
        |said: fn(&Said) -> bool| move |one: &Of<Said>| one.found.fits.then(|| said(&one.found));
    let rows = [
        Row::share(
            "any plant: a knee of d >= 8: in a set",
            fitted(|said| said.holds),
        )
        .at_least(0.93, "sets of 95 %"),
        Row::share(
            "... another effect named beside it",
            fitted(|said| said.another),
        ),
        Row::share("... its knee in the 95 % interval", |one: &Of<Said>| {
            one.found.knee
        }),
        Row::share("... its size in the 95 % interval", |one: &Of<Said>| {
            one.found.size
        }),
    ];
    context.measure(&population, &rows)
}

fn said(kind: Kind, seed: u64, plant: &LoadedPlant) -> Result<Said, Error> {
    let mut random = Stream::new(seed, 23);
    let mut setting = Setting::random(kind, seed, ROWS);
    let place = PLANTS.iter().position(|one| *one == kind).unwrap_or(0);
    let effects = EFFECTS[place];
    setting.hidden = (effects[seed as usize % effects.len()], -0.01);
    let [low, high] = PLACES;
    setting.knee = random.between(low, high);
    let [low, high] = STRENGTHS;
    setting = with_strength(&setting, random.log_between(low, high));
    let record = prepared(plant, simulate(&setting, None))?;
    let found = match diagnose(plant, record, None, &SearchOptions::default()) {
        Err(PlantError::NoFit { .. }) => None,
        found => Some(found?.answer),
    };
    let (effect, size) = setting.hidden;
    let findings = found.as_ref().map_or(&[][..], |found| &found.findings);
    let named = findings.iter().find(|one| one.effect == effect);
    let interval = |name: &str, truth: f64| {
        let own = named?.parameters.iter().find(|own| own.name == name)?;
        Some((own.estimate - truth).abs() <= NORMAL_95 * own.sigma?)
    };
    Ok(Said {
        fits: found.is_some(),
        holds: findings.iter().any(|one| holds(one, effect)),
        another: findings.len() > 1,
        knee: interval("knee", setting.knee * USUAL[place]),
        size: interval("size", size),
    })
}
