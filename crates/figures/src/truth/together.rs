//! One cause of the catalogue beside random walks of some gyros, the noise misdeclared in half of the
//! records.

use gyrocal_evaluation::{diagnosed, inject_any, set_holds};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, misdeclare, plain, walk};
use super::judged::{self, coefficient_rows, coefficients, surely_not_walks};
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the records.
const SOURCES: Sources = of(DIAGNOSIS, &[file!(), drawn::FILE, judged::FILE]);

/// Purpose of the stream of draws.
const PURPOSE: u64 = 48;

/// Strength of the cause in white noise, in sigmas of its own bound.
const STRENGTH: [f64; 2] = [10.0, 100.0];

/// Probability that a gyro walks; where none does by it, one is chosen.
const WALKING: f64 = 0.5;

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Mixed {
    /// Deterministic causes whose sets hold neither the true one nor a random walk of their gyro.
    wrong: Vec<String>,
    /// Whether the gyro of the cause walks.
    walks_itself: bool,
    /// Whether the set of a cause holds the true one.
    in_set: bool,
    /// Whether the interval of each coefficient holds it.
    covered: Vec<bool>,
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let population = Population::new("together", [795_000, 500, 3], SOURCES, record);
    let wrong = "a cause beside walks: one named that is not there, without a walk of its gyro";
    let level =
        "the limit of walks alone, and two more for a second cause: 16 of 500 within the bound";
    let held = |gyro: &str, walks: bool| {
        let name = format!("a cause beside walks: a set holds it, its own gyro {gyro}");
        Row::share(name, move |one: &Mixed| {
            (one.walks_itself == walks).then_some(one.in_set)
        })
    };
    let mut rows = vec![
        Row::bound(wrong, |one: &Mixed| !one.wrong.is_empty()).at_most(0.05, level),
        held("not walking", false),
        held("walking", true),
    ];
    let covered = "a cause beside walks: coefficients in their 95 % intervals";
    rows.extend(coefficient_rows(covered, |one: &Mixed| &one.covered));
    context.measure(&population, &rows)
}

fn record(seed: u64) -> Result<Mixed, Error> {
    let mut random = Draw::new(seed, PURPOSE);
    let plain = Scenario {
        interval_s: 120.0,
        ..plain(seed)
    };
    let strength = random.log_uniform(STRENGTH);
    let (mut with, cause) = inject_any(plain, strength, &mut random)?;
    let mut walking: Vec<usize> = (0..3).filter(|_| random.uniform() < WALKING).collect();
    if walking.is_empty() {
        walking.push((3.0 * random.uniform()) as usize);
    }
    for gyro in &walking {
        with.hidden.push(walk(*gyro, &mut random)?);
    }
    misdeclare(&mut with, 0.5, &mut random)?;
    let simulation = simulate(&with)?;
    let found = diagnosed(&simulation)?.result;
    let id = cause.effect.id;
    let wrong = surely_not_walks(&found).filter(|one| !set_holds(one, id));
    let own = cause.effect.rate();
    let covered = coefficients(&found, &simulation).into_iter();
    Ok(Mixed {
        wrong: wrong.map(|one| one.effect.clone()).collect(),
        walks_itself: own.is_some_and(|rate| walking.contains(&rate)),
        in_set: found.causes().any(|one| set_holds(one, id)),
        covered: covered.map(|one| one.covered).collect(),
    })
}
