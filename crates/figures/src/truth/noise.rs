//! Noise other than declared: random walks and flicker of the gyros, misdeclared, correlated and
//! heavy-tailed noise. No deterministic cause is in these records.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisResult, diagnose};
use gyrocal_evaluation::{EvaluationError, scenario};
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, Term, simulate, simulate_with};
use serde::{Deserialize, Serialize};

use super::interval_s;
use crate::error::Error;
use crate::figure::Figure;
use crate::harness::sources::{DIAGNOSIS, of};
use crate::harness::{COVERAGE, COVERAGE_REASON, Context, Population, Row};

/// Purposes of the streams of draws: of the noise levels, and of the series.
const LEVELS: u64 = 42;
const SERIES: u64 = 43;

/// Random walks, deg/h/√h, and levels of flicker, deg/h.
pub(super) const WALKS: [f64; 2] = [3e-5, 2e-3];
const FLICKER: [f64; 2] = [1e-4, 2e-3];

/// Ratio of the true standard deviation to the declared one.
pub(super) const MISDECLARED: [f64; 2] = [0.5, 2.0];

/// Largest correlation of neighbouring samples.
const CORRELATION: f64 = 0.3;

/// Time constants of the Gauss-Markov processes that flicker is the sum of, h: a factor of about
/// three apart, so that their spectrum follows 1/f within 5 % between the first and the last.
const FLICKER_H: [f64; 9] = [0.05, 0.15, 0.5, 1.5, 5.0, 15.0, 50.0, 150.0, 500.0];

/// A population of records with one kind of noise.
#[derive(Clone, Copy, Debug)]
enum Noise {
    /// Random walks on so many gyros.
    Walks(usize),
    /// Flicker on three gyros.
    Flicker,
    /// White, correlated and heavy-tailed noise.
    Clean,
}

/// A population of records with noise.
struct Noises {
    noise: Noise,
    cell: &'static str,
    name: &'static str,
    first_seed: u64,
    records: u64,
    /// Number of records in the small version; zero leaves the row out.
    small: u64,
    /// Largest share of false records at the upper 95 % bound, and why.
    limit: f64,
    reason: &'static str,
}

/// Reasons of the limits.
const LEVEL_REASON: &str =
    "the level is 1 %: twenty of 2000 are due, and 27 within the bound; of 1000 ten and 13";
const WALKING_REASON: &str =
    "the level of 1 % and one more for walks that look like causes: 21 of 1000 within the bound";

const WALKING: [Noises; 3] = [
    Noises {
        noise: Noise::Walks(1),
        cell: "walk-1",
        name: "random walk on one gyro: a deterministic cause named without a walk of its gyro",
        first_seed: 710_000,
        records: 1000,
        small: 4,
        limit: 0.03,
        reason: WALKING_REASON,
    },
    Noises {
        noise: Noise::Walks(2),
        cell: "walk-2",
        name: "random walks on two gyros: the same",
        first_seed: 720_000,
        records: 1000,
        small: 0,
        limit: 0.03,
        reason: WALKING_REASON,
    },
    Noises {
        noise: Noise::Walks(3),
        cell: "walk-3",
        name: "random walks on three gyros: the same",
        first_seed: 730_000,
        records: 1000,
        small: 6,
        limit: 0.03,
        reason: WALKING_REASON,
    },
];

const FLICKERING: Noises = Noises {
    noise: Noise::Flicker,
    cell: "flicker",
    name: "flicker on three gyros: a physical cause named without a noise process in its set",
    first_seed: 740_000,
    records: 1000,
    small: 4,
    limit: 0.02,
    reason: LEVEL_REASON,
};

const CLEAN: Noises = Noises {
    noise: Noise::Clean,
    cell: "clean-noise",
    name: "clean, noise declared 0.5 to 2 times, AR(1) to 0.3, t₄: physical cause or unexplained",
    first_seed: 750_000,
    records: 2000,
    small: 16,
    limit: 0.02,
    reason: LEVEL_REASON,
};

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Noisy {
    /// Deterministic causes without a random walk of their gyro, and whether the residuals are
    /// unexplained.
    causes: Vec<String>,
    unexplained: bool,
    /// Whether the 95 % interval of each named walk holds its size.
    covered: Vec<bool>,
}

pub(crate) fn of_walks(context: &Context) -> Result<Vec<Figure>, Error> {
    let all: Result<Vec<Vec<Figure>>, Error> =
        WALKING.iter().map(|row| of_row(row, context)).collect();
    Ok(all?.into_iter().flatten().collect())
}

pub(crate) fn of_flicker(context: &Context) -> Result<Vec<Figure>, Error> {
    of_row(&FLICKERING, context)
}

pub(crate) fn of_clean(context: &Context) -> Result<Vec<Figure>, Error> {
    of_row(&CLEAN, context)
}

fn of_row(row: &Noises, context: &Context) -> Result<Vec<Figure>, Error> {
    let noise = row.noise;
    let population = Population {
        name: row.cell.to_owned(),
        first: row.first_seed,
        full: row.records,
        small: row.small,
        sources: of(DIAGNOSIS, &[file!()]),
        job: Box::new(move |seed| Ok(record(noise, seed)?)),
    };
    let is_wrong = move |one: &Noisy| {
        !one.causes.is_empty() || (matches!(noise, Noise::Clean) && one.unexplained)
    };
    let mut rows = vec![Row::bound(row.name, is_wrong).at_most(row.limit, row.reason)];
    if matches!(noise, Noise::Walks(_)) {
        let name = format!(
            "{}: coverage of the 95 % interval of the size of a named walk",
            row.cell
        );
        let held = |one: &Noisy| one.covered.clone();
        rows.push(Row::each(name, held).between(COVERAGE, COVERAGE_REASON));
    }
    context.measure(&population, &rows)
}

fn record(noise: Noise, seed: u64) -> Result<Noisy, EvaluationError> {
    let mut random = Draw::new(seed, LEVELS);
    let plain = Scenario {
        interval_s: interval_s(seed),
        ..scenario(seed)
    };
    let mut hidden = Vec::new();
    let mut walks: Vec<(String, f64)> = Vec::new();
    if random.uniform() < 0.5 || matches!(noise, Noise::Clean) {
        for axis in AXES {
            for instrument in ["gyro", "accel"] {
                let ratio = random.log_uniform(MISDECLARED);
                let id = format!("{instrument}_{axis}.noise");
                hidden.push(Hidden::new(&id, &[("ratio", ratio)])?);
            }
        }
    }
    let simulation = match noise {
        Noise::Walks(count) => {
            let first = (3.0 * random.uniform()) as usize;
            for gyro in 0..count {
                let axis = AXES[(first + gyro) % 3];
                let size = random.log_uniform(WALKS);
                let id = format!("gyro_{axis}.random_walk");
                hidden.push(Hidden::new(&id, &[("size", size)])?);
                walks.push((id, size));
            }
            simulate(&Scenario { hidden, ..plain })?
        }
        Noise::Flicker => {
            let levels = [(); 3].map(|()| random.log_uniform(FLICKER));
            let term = flicker(&plain, levels, seed);
            simulate_with(&Scenario { hidden, ..plain }, &[term])?
        }
        Noise::Clean => {
            if random.uniform() < 1.0 / 3.0 {
                let correlation = CORRELATION * random.uniform();
                let parameters = [("correlation", correlation)];
                hidden.push(Hidden::new("accel.coloured_noise", &parameters)?);
                simulate(&Scenario { hidden, ..plain })?
            } else if random.uniform() < 0.5 {
                heavy_tailed(&Scenario { hidden, ..plain }, seed)?
            } else {
                simulate(&Scenario { hidden, ..plain })?
            }
        }
    };
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options)?.result;
    Ok(Noisy {
        causes: false_causes(&found),
        unexplained: found.is_unexplained(),
        covered: walks
            .iter()
            .filter_map(|(id, size)| holds_size(&found, id, *size))
            .collect(),
    })
}

/// Whether the interval of a named walk holds its size.
fn holds_size(found: &DiagnosisResult, id: &str, size: f64) -> Option<bool> {
    let finding = found.causes().find(|cause| cause.effect == id)?;
    let pieces = finding.parameter("size")?.interval.as_ref()?;
    Some(
        pieces
            .iter()
            .any(|[low, high]| (*low..=*high).contains(&size)),
    )
}

/// Causes of kinds other than noise without a random walk of their own gyro in the set; those that
/// enter no gyro count without any walk in the set.
pub(super) fn false_causes(found: &DiagnosisResult) -> Vec<String> {
    let effect = |id: &str| EFFECTS.iter().find(|effect| effect.id == id);
    let is_walk = |id: &str| effect(id).is_some_and(|e| e.kind == EffectKind::RandomWalk);
    found
        .causes()
        .filter(|cause| !is_walk(&cause.effect))
        .filter(|cause| {
            let own = effect(&cause.effect).and_then(gyrocal::Effect::rate);
            !cause.alternatives.iter().any(|other| {
                let Some(other) = effect(&other.effect) else {
                    return false;
                };
                other.kind == EffectKind::RandomWalk
                    && own.is_none_or(|own| other.rate() == Some(own))
            })
        })
        .map(|cause| cause.effect.clone())
        .collect()
}

/// Flicker of the drifts, deg/h: sums of Gauss-Markov processes of equal variance.
fn flicker(scenario: &Scenario, levels: [f64; 3], seed: u64) -> Term {
    let step_s = scenario.interval_s;
    let rows = (scenario.duration_s / step_s) as usize + 2;
    let mut random = Draw::new(seed, SERIES);
    let series = levels.map(|level| {
        let mut values = vec![0.0; rows];
        for time_h in FLICKER_H {
            let kept = (-step_s / 3600.0 / time_h).exp();
            let mut state = random.normal();
            for value in &mut values {
                *value += level * state;
                state = kept * state + (1.0 - kept * kept).sqrt() * random.normal();
            }
        }
        values
    });
    Term::Drift(Box::new(move |moment| {
        let row = ((moment.time_s / step_s) as usize).min(rows - 1);
        core::array::from_fn(|gyro| series[gyro][row])
    }))
}

/// Student's t with four degrees of freedom for the accelerometers, of the declared variance.
fn heavy_tailed(scenario: &Scenario, seed: u64) -> Result<Simulation, EvaluationError> {
    let quiet = Scenario {
        accel_noise_g: 0.0,
        ..scenario.clone()
    };
    let mut simulation = simulate(&quiet)?;
    simulation.bench = scenario.bench();
    let mut random = Draw::new(seed, SERIES);
    for row in &mut simulation.record.accel_g {
        for value in row {
            let squares: f64 = (0..4).map(|_| random.normal().powi(2)).sum();
            // The variance of t₄ is two.
            let deviate = random.normal() / (squares / 4.0).sqrt() / 2.0_f64.sqrt();
            *value += scenario.accel_noise_g * deviate;
        }
    }
    Ok(simulation)
}
