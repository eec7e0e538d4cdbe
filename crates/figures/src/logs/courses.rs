//! Steps and hysteresis in logs whose temperature rises and falls once.

use gyrocal_instruments::InstrumentError;
use gyrocal_instruments::rates::{RateEffect, RateSettings, evaluate_rates};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, followed_with_play};
use gyrocal_truth::units::position_test::vector;
use serde::{Deserialize, Serialize};

use super::unit::{DEG_PER_H, Unit};
use super::{described, logs};
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const COURSES: u64 = 1807;

/// Samples in a second.
const RATE_HZ: usize = 2;

/// Range of temperature \[K\].
const RANGE_K: f64 = 15.0;

/// Sizes in the standard deviations of a change half way.
const SIZES: [f64; 2] = [10.0, 20.0];

/// Blocks of a log, in which an evaluation looks for effects.
const BLOCKS: f64 = 64.0;

/// Change of the output over the range of temperature, and flicker, of units with hysteresis, over the noise of a
/// block.
const OVER_RANGE: f64 = 40.0;
const FLICKER: f64 = 0.3;

/// Half the play over the range.
const HALF_PLAYS: [f64; 2] = [0.06, 0.4];

/// Result of one log, whose first gyro has the effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Course {
    kind: Kind,
    /// Names that were found of the first gyro, of a sound log of any, each with its alternatives.
    found: Vec<Vec<String>>,
    /// Whether the interval of the size of a step holds the truth; `None` where it is not found.
    size: Option<bool>,
    /// Distance of its instant from the truth in blocks.
    blocks_off: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Kind {
    Sound,
    Step,
    Hysteresis,
}

impl Course {
    fn has(&self, name: &str) -> bool {
        self.found.iter().any(|names| is_of(names, name))
    }
}

fn is_of(names: &[String], end: &str) -> bool {
    names.iter().any(|one| one.ends_with(end))
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let population = logs("rates-courses", [880_000, 2000, 48], course);
    context.measure(&population, &rows())
}

fn rows() -> [Row<'static, Course>; 6] {
    let of = |what: &str| format!("logs with a course of temperature: {what}");
    let share = |what: &str, kind: Kind, is: fn(&Course) -> bool| {
        Row::share(of(what), move |log: &Course| {
            (log.kind == kind).then(|| is(log))
        })
    };
    let any = "1 % for each of three gyros, and as much again for noise that is estimated";
    let sets = "sets of 95 %, and two of a hundred that are not found";
    let second = "a second name that the first one does not explain, at 1 % a gyro";
    let step_alone = |log: &Course| {
        let alone = |set: &Vec<String>| is_of(set, ".step") && !is_of(set, "_hysteresis");
        log.found.iter().any(alone)
    };
    let play = "hysteresis of half a play of 0.06 to 0.4 in a set";
    let beside = "a step beside hysteresis without it in the set";
    [
        share("an effect in a sound log", Kind::Sound, |log| {
            !log.found.is_empty()
        })
        .at_most(0.04, any),
        share("a step of 10 to 20 sigma in a set", Kind::Step, |log| {
            log.has(".step")
        })
        .at_least(0.93, sets),
        Row::share(
            of("the size of the step in its interval"),
            |log: &Course| log.size,
        )
        .of_coverage(),
        Row::median(of("its instant off, in blocks"), |log: &Course| {
            log.blocks_off
        })
        .at_most(0.5, "a block or more if steps were at the ends of blocks"),
        share(play, Kind::Hysteresis, |log| log.has("_hysteresis")).at_least(0.93, sets),
        share(beside, Kind::Hysteresis, step_alone).at_most(0.03, second),
    ]
}

/// A unit of any grade at rest while its temperature rises and falls.
fn course(seed: u64) -> Result<Course, InstrumentError> {
    let kind = [Kind::Sound, Kind::Sound, Kind::Step, Kind::Hysteresis][(seed % 4) as usize];
    let mut draw = Draw::new(seed, COURSES);
    let seconds = draw.log_uniform([1200.0, 7200.0]) as usize;
    let white = draw.log_uniform([1.0, 100.0]);
    // Noise of the mean of a block.
    let of_block = white / (seconds as f64 / BLOCKS).sqrt();
    let mut unit = Unit {
        bias: 50.0 * vector(&mut draw),
        ..Unit::of_any_grade(white, &mut draw)
    };
    if kind == Kind::Hysteresis {
        // One rise and fall is within what a walk does: with one, temperature itself is told in half of the logs.
        (unit.flicker, unit.walk) = (FLICKER * of_block, 0.0);
    }
    let up = vector(&mut draw).normalize();
    let made = unit.log(up, [seconds, RATE_HZ], |_| 0.0, &mut draw, seed);
    let mut log = made.log;
    let samples = log.len();
    let share = |sample: usize| sample as f64 / samples as f64;
    let swing = 0.1 * draw.normal();
    let celsius = |sample| {
        let angle = core::f64::consts::PI * share(sample);
        20.0 + RANGE_K * (angle.sin() + swing * (3.0 * angle).sin())
    };
    let temperature: Vec<f64> = (0..samples).map(celsius).collect();
    let duration_s = seconds as f64;
    let root_s = duration_s.sqrt();
    let sigma = (2.0 * white / root_s)
        .hypot(unit.flicker)
        .hypot(unit.walk * root_s);
    let sign = draw.sign();
    let size = sign * (SIZES[0] + (SIZES[1] - SIZES[0]) * draw.uniform()) * sigma;
    let at = 0.2 + 0.6 * draw.uniform();
    let half = draw.log_uniform(HALF_PLAYS) * RANGE_K;
    let lagging = followed_with_play(&temperature, half);
    for (sample, (rate, lagging)) in log.gyro.iter_mut().zip(&lagging).enumerate() {
        let error = match kind {
            Kind::Sound => 0.0,
            Kind::Step if share(sample) < at => 0.0,
            Kind::Step => size,
            Kind::Hysteresis => sign * OVER_RANGE * of_block / RANGE_K * lagging,
        };
        rate[0] += DEG_PER_H * error;
    }
    log.temperature_c = Some(temperature);
    let description = described(RATE_HZ as f64, unit.latitude_deg, "")?;
    let report = evaluate_rates(&[log], &description, &RateSettings::default())?;
    // Of a sound log what any gyro has is false.
    let gyros = match kind {
        Kind::Sound => report.gyros.len(),
        Kind::Step | Kind::Hysteresis => 1,
    };
    let all = report.gyros[..gyros].iter().flat_map(|gyro| &gyro.effects);
    let names = |effect: &RateEffect| -> Vec<String> {
        let all = core::iter::once(&effect.name).chain(&effect.alternatives);
        all.cloned().collect()
    };
    let mut effects = report.gyros[0].effects();
    let step = effects.find(|(effect, _)| effect.step.is_some());
    let step = step.filter(|_| kind == Kind::Step);
    Ok(Course {
        kind,
        found: all.map(names).collect(),
        size: step.map(|(_, one)| (one.estimate - size).abs() <= NORMAL_97_5 * one.sigma),
        blocks_off: step.and_then(|(effect, _)| {
            let (time_s, _) = effect.step?;
            Some((time_s - at * duration_s).abs() / (duration_s / BLOCKS))
        }),
    })
}
