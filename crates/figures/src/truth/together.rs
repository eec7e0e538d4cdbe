//! One cause of the catalogue beside random walks of some gyros, the noise misdeclared in half of the
//! records.

use gyrocal_diagnosis::result::Finding;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_evaluation::{EvaluationError, inject_any, scenario};
use gyrocal_record::AXES;
use gyrocal_statistics::Proportion;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, simulate};
use serde::{Deserialize, Serialize};

use super::Extent;
use super::causes::{covered, holds};
use super::coverage::of_coefficients;
use super::noise::{MISDECLARED, WALKS, false_causes};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// Purpose of the stream of draws.
const PURPOSE: u64 = 48;

/// Strength of the cause in white noise, in sigmas of its own bound.
const STRENGTH: [f64; 2] = [10.0, 100.0];

/// Probability that a gyro walks; where none does by it, one is chosen.
const WALKING: f64 = 0.5;

const FIRST_SEED: u64 = 795_000;
const RECORDS: u64 = 500;
const SMALL: u64 = 3;

/// Largest share of records with a cause that neither is there nor may be a walk.
const FALSE: f64 = 0.05;

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

pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let seeds = FIRST_SEED..FIRST_SEED + extent.records(RECORDS, SMALL);
    let campaign = resumable::campaign("truth", "together", seeds.clone(), extent.small)?;
    let outcome = campaign.run(record, |_| ())?;
    let records: Vec<&Mixed> = outcome.successes().map(|(_, record)| record).collect();
    let seeds = format!("{seeds:?}");
    let wrong = Proportion::of(records.iter().map(|one| !one.wrong.is_empty()));
    let bound = wrong.upper_bound(0.95);
    let name = "a cause beside walks: one named that is not there, without a walk of its gyro";
    let mut first = Figure::within(name, [0.0, FALSE], bound).of_share(wrong);
    first.target = format!("<= {FALSE} (upper 95 % bound)");
    first.measured = format!("{:.3}, bound {bound:.3}", wrong.share());
    let covered: Vec<&[bool]> = records.iter().map(|one| one.covered.as_slice()).collect();
    let name = "a cause beside walks: coefficients in their 95 % intervals";
    if extent.small {
        first = first.judged(wrong.at_most(FALSE));
    }
    let held = |walks_itself: bool| {
        let of = records
            .iter()
            .filter(|one| one.walks_itself == walks_itself);
        let held: Vec<bool> = of.map(|one| one.in_set).collect();
        let count = held.len();
        let name = format!(
            "a cause beside walks: a set holds it, its own gyro {}",
            if walks_itself {
                "walking"
            } else {
                "not walking"
            }
        );
        Figure::note(&name, format!("{:.3}", Proportion::of(held).share())).over(count, &*seeds)
    };
    let mut figures = vec![first.over(records.len(), &*seeds), held(false), held(true)];
    figures.extend(of_coefficients(name, &covered, &seeds, extent.small));
    Ok(figures)
}

fn record(seed: u64) -> Result<Mixed, EvaluationError> {
    let mut random = Draw::new(seed, PURPOSE);
    let plain = Scenario {
        interval_s: 120.0,
        ..scenario(seed)
    };
    let [least, most] = STRENGTH;
    let strength = random.log_uniform([least, most]);
    let (mut with, cause) = inject_any(plain, strength, &mut random)?;
    let mut walking: Vec<usize> = (0..3).filter(|_| random.uniform() < WALKING).collect();
    if walking.is_empty() {
        walking.push((3.0 * random.uniform()) as usize % 3);
    }
    let axes = AXES;
    for gyro in &walking {
        let size = random.log_uniform(WALKS);
        let id = format!("gyro_{}.random_walk", axes[*gyro]);
        with.hidden.push(Hidden::new(&id, &[("size", size)])?);
    }
    if random.uniform() < 0.5 {
        for axis in axes {
            for instrument in ["gyro", "accel"] {
                let ratio = random.log_uniform(MISDECLARED);
                let id = format!("{instrument}_{axis}.noise");
                with.hidden.push(Hidden::new(&id, &[("ratio", ratio)])?);
            }
        }
    }
    let simulation = simulate(&with)?;
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options)?.result;
    let id = cause.effect.id;
    let held: Vec<&Finding> = found.causes().filter(|one| holds(one, id)).collect();
    let mut wrong = false_causes(&found);
    wrong.retain(|name| held.iter().all(|one| one.effect != *name));
    let own = cause.effect.rate();
    Ok(Mixed {
        walks_itself: own.is_some_and(|rate| walking.contains(&rate)),
        in_set: !held.is_empty(),
        covered: covered(&found, &simulation),
        wrong,
    })
}
