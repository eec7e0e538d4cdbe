//! Noise other than declared: random walks and flicker of the gyros, misdeclared, correlated and
//! heavy-tailed noise. No deterministic cause is in these records.

use gyrocal_answer::Answer;
use gyrocal_calibration::NoiseModel;
use gyrocal_evaluation::diagnosed;
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::noise::{flickering, student, with_noise};
use gyrocal_truth::{Hidden, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, misdeclare, plain, walk};
use super::judged::{self, surely_not_walks, within};
use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the records.
const SOURCES: Sources = of(DIAGNOSIS, &[file!(), drawn::FILE, judged::FILE]);

/// Purposes of the streams of draws: of the noise levels, and of the series.
const LEVELS: u64 = 42;
const SERIES: u64 = 43;

/// Levels of flicker, deg/h.
const FLICKER: [f64; 2] = [1e-4, 2e-3];

/// Largest correlation of neighbouring samples.
const CORRELATION: f64 = 0.3;

/// A population of records with one kind of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Noise {
    /// Random walks on so many gyros.
    Walks(usize),
    /// Flicker on three gyros.
    Flicker,
    /// White, correlated and heavy-tailed noise.
    Clean,
}

/// Populations with random walks: number of gyros, first seed, records of the small version, name of the row.
const WALKING: [(usize, u64, u64, &str); 3] = [
    (1, 710_000, 4, ONE_WALK),
    (2, 720_000, 0, "random walks on two gyros: the same"),
    (3, 730_000, 6, "random walks on three gyros: the same"),
];
const ONE_WALK: &str =
    "random walk on one gyro: a deterministic cause named without a walk of its gyro";

/// Reasons of the limits.
const LEVEL_REASON: &str =
    "the level is 1 %: twenty of 2000 are due, and 27 within the bound; of 1000 ten and 13";
const WALKING_REASON: &str =
    "the level of 1 % and one more for walks that look like causes: 21 of 1000 within the bound";

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Noisy {
    /// Deterministic causes without a random walk of their gyro, and whether the residuals are
    /// unexplained.
    causes: Vec<String>,
    unexplained: bool,
    /// Whether the 95 % interval of each named walk holds its size.
    covered: Vec<bool>,
    /// Whether the 95 % interval of the noise of each gyro and then of each accelerometer holds its level, of a record
    /// with white normal noise that is left to the fit whole.
    levels: Vec<bool>,
}

impl Noisy {
    fn is_named(&self) -> bool {
        !self.causes.is_empty()
    }
}

pub(crate) fn of_walks(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (gyros, first, small, name) in WALKING {
        let cell = format!("walk-{gyros}");
        let covered = format!("{cell}: coverage of the 95 % interval of a walk's size");
        let rows = [
            Row::bound(name, Noisy::is_named).at_most(0.03, WALKING_REASON),
            Row::each(covered, |one: &Noisy| one.covered.clone()).of_coverage(),
        ];
        let walks = population(Noise::Walks(gyros), &cell, [first, 1000, small]);
        figures.extend(context.measure(&walks, &rows)?);
    }
    Ok(figures)
}

pub(crate) fn of_flicker(context: &Context) -> Result<Vec<Figure>, Error> {
    let flicker = population(Noise::Flicker, "flicker", [740_000, 1000, 4]);
    let name = "flicker on three gyros: a physical cause named without a noise process in its set";
    let row = Row::bound(name, Noisy::is_named);
    context.measure(&flicker, &[row.at_most(0.02, LEVEL_REASON)])
}

pub(crate) fn of_clean(context: &Context) -> Result<Vec<Figure>, Error> {
    let clean = population(Noise::Clean, "clean-noise", [750_000, 2000, 16]);
    let name =
        "clean, noise declared 0.5 to 2 times, AR(1) to 0.3, t₄: physical cause or unexplained";
    let row = Row::bound(name, |one: &Noisy| one.is_named() || one.unexplained);
    let levels = |name, half: usize| {
        let own = move |one: &Noisy| {
            let halves = one.levels.chunks(AXES.len());
            halves
                .skip(half)
                .take(1)
                .flatten()
                .copied()
                .collect::<Vec<_>>()
        };
        Row::each(name, own).of_coverage()
    };
    let gyros = "clean, white normal noise: coverage of the 95 % interval of a gyro's noise";
    let rows = [
        row.at_most(0.02, LEVEL_REASON),
        levels(gyros, 0),
        levels("... of an accelerometer's noise", 1),
    ];
    context.measure(&clean, &rows)
}

fn population(noise: Noise, name: &str, seeds: [u64; 3]) -> Population<'static, Noisy> {
    Population::new(name, seeds, SOURCES, move |seed| record(noise, seed))
}

fn record(noise: Noise, seed: u64) -> Result<Noisy, Error> {
    let mut random = Draw::new(seed, LEVELS);
    let mut series = Draw::new(seed, SERIES);
    let mut scenario = plain(seed);
    let share = if noise == Noise::Clean { 1.0 } else { 0.5 };
    let levels = misdeclare(&mut scenario, share, &mut random)?;
    let mut is_white = false;
    let mut walks = Vec::new();
    let simulation = match noise {
        Noise::Walks(count) => {
            let first = (3.0 * random.uniform()) as usize;
            for gyro in first..first + count {
                walks.push(walk(gyro % 3, &mut random)?);
            }
            scenario.hidden.extend(walks.clone());
            simulate(&scenario)?
        }
        Noise::Flicker => {
            let levels = core::array::from_fn(|_| random.log_uniform(FLICKER));
            flickering(&scenario, levels, &mut series)?
        }
        Noise::Clean if random.uniform() < 1.0 / 3.0 => {
            let parameters = [("correlation", CORRELATION * random.uniform())];
            let coloured = Hidden::new("accel.coloured_noise", &parameters)?;
            scenario.hidden.push(coloured);
            simulate(&scenario)?
        }
        // The variance of t₄ is two.
        Noise::Clean if random.uniform() < 0.5 => {
            with_noise(&scenario, |_| student(&mut series, 4) / 2.0_f64.sqrt())?
        }
        Noise::Clean => {
            is_white = true;
            simulate(&scenario)?
        }
    };
    let found = diagnosed(&simulation)?.result;
    let causes = surely_not_walks(&found).map(|cause| cause.effect.clone());
    let covered = walks.iter().filter_map(|walk| holds_size(&found, walk));
    Ok(Noisy {
        causes: causes.collect(),
        unexplained: found.is_unexplained(),
        covered: covered.collect(),
        levels: match is_white {
            true => hold_levels(&found, &levels),
            false => Vec::new(),
        },
    })
}

/// Whether the interval of the noise of each gyro, then of each accelerometer holds its level over the declared.
fn hold_levels(found: &Answer, truth: &NoiseModel) -> Vec<bool> {
    let both = [("gyro", truth.gyro_ratio), ("accel", truth.accel_ratio)];
    let levels = both.into_iter().flat_map(|(instrument, ratios)| {
        let named = AXES.iter().zip(ratios);
        named.map(move |(axis, ratio)| (format!("{instrument}_{axis}"), ratio))
    });
    let holds = |(channel, ratio): (String, f64)| {
        let own = found.noise.iter().find(|one| one.channel == channel)?;
        Some(within(&[own.interval], ratio))
    };
    levels.filter_map(holds).collect()
}

/// Whether the interval of a walk holds its size; `None` unless it is named.
fn holds_size(found: &Answer, walk: &Hidden) -> Option<bool> {
    let finding = found.causes().find(|cause| cause.effect == walk.id())?;
    let pieces = finding.parameter("size")?.interval.as_ref()?;
    let (_, size, _) = *walk.parameters().first()?;
    Some(within(pieces, size))
}
