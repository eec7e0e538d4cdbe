//! Records in which the offset of a sensor changes as no function of the catalogue does, alone and beside an effect: left-out
//! parts judge what is named.

use gyrocal_answer::Finding;
use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::second::{Second, is_better};
use super::simulated::{Kind, Run, Setting, Stream, simulate, with_strength};
use super::{Of, ROWS, holds, in_turn, prepared};
use crate::harness::{Context, Error, Figure, Row};

/// Seed of the records; no constant was tuned on them.
const OFFSETS: u64 = 690_000;

/// Plants whose noise is estimated beyond the declared one.
const PLANTS: [Kind; 4] = [Kind::Duffing, Kind::Tanks, Kind::Servo, Kind::CartPole];

/// Changes of the offset, and their largest size over the noise of the sensor.
const CHANGES: [u64; 2] = [3, 7];
const LARGEST: f64 = 6.0;

/// Most rows between an onset and the change of the offset that it tells: noise hides the row of a small change by as many.
const NEAR: usize = 10;

/// Strength of the effect, standard deviations of white noise: large beside what the offsets hide.
const STRENGTHS: [f64; 2] = [100.0, 300.0];

/// What is said of a record.
#[derive(Clone, Default, Serialize, Deserialize)]
struct Said {
    hidden: bool,
    /// Whether the nominal model has a fit: an effect of hundreds of standard deviations may leave it none, which the
    /// command tells as an error.
    fits: bool,
    /// Whether a function of time is named that is none of the changes.
    of_time: bool,
    /// Whether any effect is.
    names: bool,
    /// Whether a set holds the hidden effect.
    holds: bool,
    /// Whether a later record without offsets is simulated better with what was found, where anything was.
    better: Option<bool>,
}

/// Records of four plants, each second one with an effect.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let population = in_turn("offsets", &PLANTS, [OFFSETS, 200, 2], |kind, seed| {
        said(kind, seed, &plants[kind as usize])
    });
    let of = |hidden: bool, said: fn(&Said) -> bool| {
        move |one: &Of<Said>| (one.found.hidden == hidden).then_some(said(&one.found))
    };
    let fitted = |said: fn(&Said) -> bool| {
        move |one: &Of<Said>| (one.found.hidden && one.found.fits).then_some(said(&one.found))
    };
    let rows = [
        Row::share(
            "any plant: an offset that changes as no function of time does: a function of time named that is none of its changes",
            of(false, |said| said.of_time),
        ),
        Row::share("... any effect named", of(false, |said| said.names)),
        Row::share(
            "any plant: an effect beside such offsets: the nominal model has a fit",
            of(true, |said| said.fits),
        ),
        Row::share("... in a set", fitted(|said| said.holds)),
        Row::share(
            "... a function of time named that is none of the changes",
            fitted(|said| said.of_time),
        ),
        Row::share(
            "... a later record without offsets simulated better, where anything is named",
            |one: &Of<Said>| one.found.better.filter(|_| one.found.hidden),
        ),
    ];
    context.measure(&population, &rows)
}

fn said(kind: Kind, seed: u64, plant: &LoadedPlant) -> Result<Said, Error> {
    let mut random = Stream::new(seed, 21);
    let hidden = seed % 2 == 1;
    let mut setting = Setting::random(kind, seed, ROWS);
    let catalogue = &plant.description().effects;
    let is_of_time = |id: &str| {
        let mut own = catalogue.iter();
        own.any(|own| own.id == id && own.kind.is_of_time())
    };
    if hidden {
        let lasting = kind.facts().effects.iter();
        let lasting: Vec<_> = lasting.filter(|(id, _)| !is_of_time(id)).collect();
        setting.hidden = *lasting[seed as usize / 2 % lasting.len()];
        let [low, high] = STRENGTHS;
        setting = with_strength(&setting, random.log_between(low, high));
    }
    let later = Setting {
        seed: seed + 10_000_000,
        ..setting.clone()
    };
    let later = Second::new(plant, &later)?.record;
    let mut run = simulate(&setting, None);
    let changes = add_offsets(&mut run, kind.facts().sigmas[0], &mut random);
    let changes_s: Vec<f64> = changes.iter().map(|row| run.time_s[*row]).collect();
    let near_s = NEAR as f64 * (run.time_s[1] - run.time_s[0]);
    let step = format!("{}.step", plant.description().outputs[0].id);
    let is_a_change = |one: &Finding| {
        let mut onsets = one.parameters.iter().filter(|own| own.name == "onset_s");
        let is_near = |onset: f64| changes_s.iter().any(|at| (at - onset).abs() <= near_s);
        one.effect == step && onsets.all(|own| is_near(own.estimate))
    };
    let options = SearchOptions::default();
    let found = match diagnose(plant, prepared(plant, run)?, Some(later), &options) {
        Err(PlantError::NoFit { .. }) => {
            return Ok(Said {
                hidden,
                ..Said::default()
            });
        }
        found => found?,
    };
    let answer = found.answer;
    let gain = answer.gain.as_ref();
    Ok(Said {
        hidden,
        fits: true,
        of_time: answer
            .findings
            .iter()
            .any(|one| is_of_time(&one.effect) && !is_a_change(one)),
        names: answer.has_findings(),
        holds: answer
            .findings
            .iter()
            .any(|one| holds(one, setting.hidden.0)),
        better: gain
            .and_then(|gain| gain.validation.as_ref())
            .map(is_better),
    })
}

/// Adds an offset of the first output that changes at random times, each time by a random size; gives the rows of its
/// changes.
fn add_offsets(run: &mut Run, sigma: f64, random: &mut Stream) -> Vec<usize> {
    let rows = run.outputs.len();
    let [fewest, most] = CHANGES;
    let count = fewest + (random.uniform() * (most - fewest + 1) as f64) as u64;
    let change = |_| {
        let first = (random.uniform() * rows as f64) as usize;
        let change = LARGEST * (2.0 * random.uniform() - 1.0) * sigma;
        for outputs in &mut run.outputs[first..] {
            outputs[0] += change;
        }
        first
    };
    (0..count).map(change).collect()
}
