//! Clean records whose noise is not what the plant declares: correlated readings, noise of a rate, a noisy log of an
//! input.

use gyrocal_answer::Verdict;
use gyrocal_plant::{LoadedPlant, SearchOptions, diagnose};
use serde::{Deserialize, Serialize};

use super::simulated::{Kind, Run, Setting, Stream, simulate};
use super::{Of, ROWS, in_turn, prepared};
use crate::cost::on_one_core;
use crate::harness::{Context, Error, Figure, Row};

/// Seed of the records; no constant was tuned on them.
const COLOURED: u64 = 670_000;

/// Correlation of readings from row to row.
const CORRELATION: [f64; 2] = [0.3, 0.95];

/// What noise of a rate does to the readings, over their noise, and its size in the run that this is measured in.
const SHAKEN: [f64; 2] = [0.5, 4.0];
const PROBE: f64 = 1e-3;

/// Why so few names are allowed.
const LEVEL: &str = "levels of 1 % of names, and what linearised noise leaves";

/// Noise of a log over the swing of its input.
const LOG: f64 = 0.1;

/// What the noise is.
#[derive(Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
enum Noise {
    Correlated,
    OfRate,
    OfLog,
}

const ALL: [Noise; 3] = [Noise::Correlated, Noise::OfRate, Noise::OfLog];

/// What is said of a record.
#[derive(Clone, Serialize, Deserialize)]
struct Said {
    noise: Noise,
    /// Whether an effect or an unlisted term is named.
    names: bool,
    /// Whether noise that the plant does not declare is told, or the answer is not settled.
    told: bool,
    /// Processor time, s.
    seconds: f64,
}

/// Records of all plants, the three noises in turn.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let population = in_turn(
        "other noise",
        &Kind::ALL,
        [COLOURED, 600, 3],
        |kind, seed| {
            let noise = ALL[(seed % 3) as usize];
            let plant = &plants[kind as usize];
            let record = prepared(plant, run(kind, seed, noise))?;
            let (found, seconds) =
                on_one_core(|| diagnose(plant, record, None, &SearchOptions::default()));
            let answer = found?.answer;
            Ok(Said {
                noise,
                names: answer.has_findings() || !answer.remainder.unmodelled.is_empty(),
                told: !answer.undeclared_noise.is_empty()
                    || matches!(answer.verdict, Verdict::NotSettled | Verdict::Unexplained),
                seconds,
            })
        },
    );
    // The quadrotor has too many states and outputs for noise beyond the declared.
    let is_judged = |one: &Of<Said>| one.plant != Kind::Quadrotor as usize;
    let of = |noise: Noise| {
        move |one: &Of<Said>| {
            let is_own = is_judged(one) && one.found.noise == noise;
            is_own.then_some(one.found.names)
        }
    };
    let rows = [
        Row::share(
            "any plant: clean records with readings of correlation 0.3 to 0.95: anything but noise named",
            of(Noise::Correlated),
        )
        .at_most(0.028, LEVEL),
        Row::share(
            "any plant: clean records with noise of a rate that is not declared: anything but noise named",
            of(Noise::OfRate),
        )
        .at_most(0.028, LEVEL),
        Row::share(
            "any plant: clean records with a log of the input that has noise of a tenth: anything but noise named",
            of(Noise::OfLog),
        )
        .at_most(0.06, "noise of an input is not in the model"),
        Row::share(
            "... of the first two: noise told that the plant does not declare",
            |one: &Of<Said>| {
                let is_own = is_judged(one) && one.found.noise != Noise::OfLog;
                is_own.then_some(one.found.told)
            },
        ),
        Row::share(
            "... of the quadrotor, which is judged in white noise alone: anything but noise named",
            |one: &Of<Said>| (!is_judged(one)).then_some(one.found.names),
        ),
        Row::mean(
            "... processor time of a diagnosis, s, mean",
            |one: &Of<Said>| Some(one.found.seconds),
        ),
    ];
    context.measure(&population, &rows)
}

fn run(kind: Kind, seed: u64, noise: Noise) -> Run {
    let mut random = Stream::new(seed, 13);
    let plain = Setting::random(kind, seed, ROWS);
    let with = |hidden| Setting {
        hidden,
        ..plain.clone()
    };
    match noise {
        Noise::Correlated => {
            let correlation = random.between(CORRELATION[0], CORRELATION[1]);
            simulate(&with(("noise.correlation", correlation)), None)
        }
        Noise::OfRate => {
            let quiet = |hidden| {
                let setting = Setting {
                    noise: 0.0,
                    ..with(hidden)
                };
                simulate(&setting, None).outputs
            };
            let (without, shaken) = (quiet(("", 0.0)), quiet(("rate.noise", PROBE)));
            let sigmas = kind.facts().sigmas;
            let rows = without.iter().zip(&shaken);
            let squares = rows.flat_map(|(one, other)| {
                let values = one.iter().zip(other).zip(sigmas);
                values.map(|((one, other), sigma)| ((one - other) / sigma).powi(2))
            });
            let moved = (squares.sum::<f64>() / (ROWS * sigmas.len()) as f64).sqrt();
            let wanted = random.log_between(SHAKEN[0], SHAKEN[1]);
            simulate(&with(("rate.noise", PROBE * wanted / moved)), None)
        }
        Noise::OfLog => {
            let mut run = simulate(&plain, None);
            let inputs = run.inputs.first().map_or(0, Vec::len);
            let rows = run.inputs.len() as f64;
            for input in 0..inputs {
                let mean = run.inputs.iter().map(|row| row[input]).sum::<f64>() / rows;
                let squares = run.inputs.iter().map(|row| (row[input] - mean).powi(2));
                let swing = (squares.sum::<f64>() / rows).sqrt();
                for row in &mut run.inputs {
                    row[input] += LOG * swing * random.normal();
                }
            }
            run
        }
    }
}
