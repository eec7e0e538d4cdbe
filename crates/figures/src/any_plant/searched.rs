//! Effects with a parameter that a fit moves by a derivative, and the search does not know: a knee (a stop, a dead zone,
//! an overflow) that is not where it is declared, and an input that acts late.

use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::simulated::{Kind, Setting, Stream, simulate, strength, with_strength};
use super::{Of, ROWS, holds, in_turn, prepared};
use crate::harness::{Context, Error, Figure, Row};

/// Seeds of the records; no constant was tuned on them.
const KNEES: u64 = 700_000;
const DEAD_TIMES: u64 = 710_000;

/// Where a knee is, over the usual size of its variable, and the strength of the effect, standard deviations.
const PLACES: [f64; 2] = [0.25, 0.75];
const STRENGTHS: [f64; 2] = [8.0, 100.0];

/// The shortest dead time, rows.
const LEAST_ROWS: f64 = 0.1;

/// Half of a 95 % interval over the standard deviation.
const NORMAL_95: f64 = 1.96;

/// An effect that a record has: what is hidden, the name of the effect, whether it acts in the record, and the true
/// values of its parameters.
struct Hidden {
    setting: Setting,
    effect: &'static str,
    acts: bool,
    truth: Vec<(&'static str, f64)>,
}

/// What is said of a record.
#[derive(Clone, Serialize, Deserialize)]
struct Said {
    /// Whether the nominal model has a fit, and the effect acts in the record.
    fits: bool,
    /// Whether the set of a finding holds the effect.
    holds: bool,
    /// Whether a second effect is named beside it.
    another: bool,
    /// Whether the intervals of its parameters hold the truth, where the effect itself is named.
    covers: Vec<Option<bool>>,
}

/// Records of the plants whose simulators have such effects.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let knees = in_turn(
        "knees",
        &[Kind::Duffing, Kind::Tanks],
        [KNEES, 500, 5],
        |kind, seed| said(knee(kind, seed), &plants[kind as usize]),
    );
    let dead_times = in_turn(
        "dead-times",
        &[Kind::Duffing, Kind::Servo],
        [DEAD_TIMES, 500, 5],
        |kind, seed| said(dead_time(kind, seed), &plants[kind as usize]),
    );
    let name = "any plant: a knee of d >= 8: in a set";
    let own = [
        "... its size in the 95 % interval",
        "... its knee in the 95 % interval",
    ];
    let another = "... another effect named beside it";
    let mut figures = context.measure(&knees, &rows(name, another, &own))?;
    let name = "any plant: a dead time of 0.1 to 20 rows: in a set";
    let own = ["... the dead time in its 95 % interval"];
    let another = "... another effect named beside the dead time";
    figures.extend(context.measure(&dead_times, &rows(name, another, &own))?);
    Ok(figures)
}

fn rows(
    name: &'static str,
    another: &'static str,
    own: &[&'static str],
) -> Vec<Row<'static, Of<Said>>> {
    let fitted =
        |said: fn(&Said) -> bool| move |one: &Of<Said>| one.found.fits.then(|| said(&one.found));
    let mut rows = vec![
        Row::share(name, fitted(|said| said.holds)).at_least(0.93, "sets of 95 %"),
        Row::share(another, fitted(|said| said.another)),
    ];
    rows.extend(own.iter().enumerate().map(|(place, name)| {
        Row::share(*name, move |one: &Of<Said>| {
            one.found.covers.get(place).copied().flatten()
        })
    }));
    rows
}

/// An oscillator with a stop or a dead zone, or tanks with an overflow.
fn knee(kind: Kind, seed: u64) -> Hidden {
    let mut random = Stream::new(seed, 23);
    let effects: &[_] = match kind {
        Kind::Tanks => &["upper_rate.above(upper)"],
        _ => &["v_rate.above(x)", "v_rate.beyond(x)"],
    };
    let effect = effects[seed as usize % effects.len()];
    let setting = Setting {
        hidden: (effect, -0.01),
        knee: random.between(PLACES[0], PLACES[1]),
        ..Setting::random(kind, seed, ROWS)
    };
    let setting = with_strength(&setting, random.log_between(STRENGTHS[0], STRENGTHS[1]));
    let mut truth = vec![("size", setting.hidden.1)];
    // No record of the lower level tells the scale of the upper one, which the place of the overflow is on.
    if kind != Kind::Tanks {
        truth.push(("knee", setting.knee));
    }
    Hidden {
        effect,
        // A level that never reaches its knee has no size that makes it act.
        acts: strength(&setting) >= STRENGTHS[0],
        truth,
        setting,
    }
}

/// An input that acts late by any part of a row; the servo's own loop bears no more than 1.8 rows.
fn dead_time(kind: Kind, seed: u64) -> Hidden {
    let (effect, most) = match kind {
        Kind::Servo => ("drive.delay", 1.8),
        _ => ("u.delay", 20.0),
    };
    let rows = Stream::new(seed, 24).log_between(LEAST_ROWS, most);
    let setting = Setting {
        hidden: ("drive.late_rows", rows),
        ..Setting::random(kind, seed, ROWS)
    };
    Hidden {
        setting,
        effect,
        acts: true,
        truth: vec![("size", rows * kind.facts().step_s)],
    }
}

fn said(hidden: Hidden, plant: &LoadedPlant) -> Result<Said, Error> {
    let record = prepared(plant, simulate(&hidden.setting, None))?;
    let found = match diagnose(plant, record, None, &SearchOptions::default()) {
        Err(PlantError::NoFit { .. }) => None,
        found => Some(found?.answer),
    };
    let findings = found.as_ref().map_or(&[][..], |found| &found.findings);
    let named = findings.iter().find(|one| one.effect == hidden.effect);
    let covers = hidden.truth.iter().map(|(name, truth)| {
        let own = named?.parameters.iter().find(|own| own.name == *name)?;
        match own.interval.as_deref() {
            Some(pieces) => Some(
                pieces
                    .iter()
                    .any(|[low, high]| low <= truth && truth <= high),
            ),
            None => Some((own.estimate - truth).abs() <= NORMAL_95 * own.sigma?),
        }
    });
    Ok(Said {
        fits: found.is_some() && hidden.acts,
        holds: findings.iter().any(|one| holds(one, hidden.effect)),
        another: findings.len() > 1,
        covers: covers.collect(),
    })
}
