//! Gross errors of the set-up: told right, false alarms, cost.

use std::time::Instant;

use gyrocal_calibration::Options;
use gyrocal_diagnosis::{DiagnosisError, Gate};
use gyrocal_evaluation::{Statistic, diagnosed, inject_any, run_of};
use gyrocal_setup::{PlatformKind, check_setup};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Proportion, median};
use gyrocal_truth::faults::{BREAKAGES, leave_angles_out, varied_record, varied_scenario};
use gyrocal_truth::{InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, coefficients};
use crate::harness::{Context, Error, Figure, Population, Row, Sources, in_turn, of};

const SOURCES: Sources = of(
    &["crates/diagnosis", "crates/evaluation"],
    &[file!(), drawn::FILE],
);

/// Strength of the effects in every other sound record, in sigmas of their own bound.
const STRENGTHS: [f64; 2] = [5.0, 100.0];

/// Timed runs, of which the median counts.
const TIMED_RUNS: usize = 9;

/// Rows of the timed records: three days of minutes, and ten times as many.
const DAYS: f64 = 3.0;
const MORE: f64 = 10.0;

/// Largest share of false alarms, and why.
const FALSE: f64 = 0.005;
const FALSE_REASON: &str = "half of the level of the diagnosis, which the gate precedes";

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    in_turn(context, &[broken, sound, undecided, time])
}

/// What was told of one broken record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Told {
    breakage: String,
    is_right: bool,
}

/// Pairs of records, the second without angles where they may be left out, have one kind in turn.
fn tell(seed: u64) -> Result<Told, Error> {
    let breakage = &BREAKAGES[(seed / 2) as usize % BREAKAGES.len()];
    let broken = breakage.record(seed)?;
    let found = check_setup(&broken.record, &broken.bench).findings;
    let is_named = |kind: &str| breakage.kinds.contains(&kind);
    let is_right = !found.is_empty()
        && found.iter().all(|finding| {
            let mut others = finding.equivalent_kinds.iter();
            is_named(finding.kind.as_str()) || others.any(|kind| is_named(kind.as_str()))
        });
    Ok(Told {
        breakage: breakage.name.to_owned(),
        is_right,
    })
}

fn broken(context: &Context) -> Result<Vec<Figure>, Error> {
    let kinds = BREAKAGES.len() as u64;
    let seeds = [3_000_000, 20 * kinds, 2 * kinds];
    let population = Population::new("gross errors", seeds, SOURCES, tell);
    let named = |what: &str| format!("gross errors, {kinds} kinds: {what}");
    let worst = |all: &[Told]| {
        let shares = by_kind(all).map(|(_, share)| share);
        let worst = shares.min_by(|one, other| one.share().total_cmp(&other.share()));
        Statistic::Share(worst.unwrap_or(Proportion::of([])))
    };
    let wrong = |all: &[Told]| {
        let wrong = by_kind(all).filter(|(_, right)| right.hits < right.trials);
        let words = wrong.map(|(kind, right)| format!("{kind} {}", right.trials - right.hits));
        words.collect::<Vec<_>>().join(", ")
    };
    let rows = [
        Row::share(named("right kind or class, over all"), |one: &Told| {
            Some(one.is_right)
        })
        .at_least(0.98, "one of fifty is so short or still that others fit"),
        Row::new(named("worst kind"), worst)
            .at_least(0.85, "17 of 20 has the worst of 44 kinds of 98 %"),
        Row::words(named("told wrong, of each kind"), wrong),
    ];
    context.measure(&population, &rows)
}

/// Shares that are told right, by kind.
fn by_kind(all: &[Told]) -> impl Iterator<Item = (&'static str, Proportion)> {
    BREAKAGES.iter().map(|kind| {
        let own = all.iter().filter(|one| one.breakage == kind.name);
        (kind.name, Proportion::of(own.map(|one| one.is_right)))
    })
}

/// A sound record of a seed; every other one has an effect.
fn sound_record(seed: u64) -> Result<Simulation, Error> {
    let mut scenario = varied_scenario(seed)?;
    if seed % 2 == 1 {
        let mut random = Draw::new(seed, 4);
        let strength = random.log_uniform(STRENGTHS);
        // The strength is that in rows of a minute: the gyros' noise, which bounds it, is the same.
        let slow = Scenario {
            interval_s: scenario.interval_s.max(60.0),
            hidden: Vec::new(),
            ..scenario.clone()
        };
        let (with, _) = inject_any(slow, strength, &mut random)?;
        scenario.hidden.extend(with.hidden);
    }
    Ok(varied_record(seed, &scenario)?)
}

fn sound(context: &Context) -> Result<Vec<Figure>, Error> {
    let job = |seed| Ok(told(&sound_record(seed)?));
    let population = Population::new("sound", [3_100_000, 1000, 60], SOURCES, job);
    let alarms = Row::share("false alarms of the gate: sound records", is_alarm);
    context.measure(&population, &[alarms.at_most(FALSE, FALSE_REASON)])
}

/// Kinds that the gate tells, fits included.
fn told(simulation: &Simulation) -> Vec<String> {
    let kind = PlatformKind::Stabilised;
    let found = Gate::new(kind, &run_of(simulation), &Options::default());
    found.problems.into_iter().map(|one| one.kind).collect()
}

#[expect(clippy::ptr_arg, reason = "rows call it so")]
fn is_alarm(kinds: &Vec<String>) -> Option<bool> {
    Some(!kinds.is_empty())
}

/// A record without angles whose sign of the latitude only fits decide: at 10 to 15 degrees over a day
/// or two, or over 7 to 12 hours at 20 to 70 degrees; coefficients from the prior of 1 deg/h.
fn undecided_record(seed: u64) -> Result<Simulation, Error> {
    let mut random = Draw::new(seed, 5);
    let mut between = |[from, to]: [f64; 2]| from + (to - from) * random.uniform();
    let (size_deg, hours) = if seed % 4 < 2 {
        (between([10.0, 15.0]), between([24.0, 48.0]))
    } else {
        (between([20.0, 70.0]), between([7.0, 12.0]))
    };
    let scenario = Scenario {
        seed,
        latitude_deg: random.sign() * size_deg,
        initial: InitialAttitude::Random,
        duration_s: 3600.0 * hours,
        coefficients: coefficients([1.0; 3], &mut random),
        ..Scenario::default()
    };
    let mut simulation = simulate(&scenario)?;
    leave_angles_out(&mut simulation.bench);
    Ok(simulation)
}

/// Every other record has the wrong sign.
fn undecided(context: &Context) -> Result<Vec<Figure>, Error> {
    let job = |seed: u64| {
        let mut simulation = undecided_record(seed)?;
        let is_wrong = seed % 2 == 1;
        if is_wrong {
            simulation.bench.latitude_deg *= -1.0;
        }
        Ok((is_wrong, told(&simulation)))
    };
    let population = Population::new("undecided", [3_210_000, 400, 16], SOURCES, job);
    let name = "sign of the latitude by fits, below 15 deg or 12 h:";
    let is_told =
        |(is_wrong, kinds): &(bool, Vec<String>)| is_wrong.then(|| kinds.iter().eq(["handedness"]));
    let is_false = |(is_wrong, kinds): &(bool, Vec<String>)| is_alarm(kinds).filter(|_| !is_wrong);
    let rows = [
        Row::share(format!("{name} told"), is_told).at_least(
            0.95,
            "the least record that fits decide misses one of twenty",
        ),
        Row::share(format!("{name} false"), is_false).at_most(FALSE, FALSE_REASON),
    ];
    context.measure(&population, &rows)
}

fn simulated(days: f64) -> Result<Simulation, Error> {
    Ok(simulate(&Scenario {
        seed: 3_100_000,
        latitude_deg: 48.2,
        initial: InitialAttitude::Random,
        // The last row begins the next day.
        duration_s: days * 86_400.0 - 60.0,
        ..Scenario::default()
    })?)
}

/// Median time of a job, ms.
fn timed_ms(mut job: impl FnMut()) -> f64 {
    let times: [f64; TIMED_RUNS] = core::array::from_fn(|_| {
        let start = Instant::now();
        job();
        1e3 * start.elapsed().as_secs_f64()
    });
    median(&times)
}

fn time(context: &Context) -> Result<Vec<Figure>, Error> {
    let of_gate = |simulation: &Simulation| {
        timed_ms(|| {
            std::hint::black_box(check_setup(&simulation.record, &simulation.bench));
        })
    };
    let mut reversed = simulated(DAYS)?;
    let rows = reversed.record.len();
    let (once, more) = (of_gate(&reversed), of_gate(&simulated(MORE * DAYS)?));
    reversed.bench.latitude_deg *= -1.0;
    let mut left_out = reversed.clone();
    leave_angles_out(&mut left_out.bench);
    let mut is_told = true;
    let slowest = [reversed, left_out].map(|simulation| {
        timed_ms(|| {
            is_told &= matches!(diagnosed(&simulation), Err(DiagnosisError::Setup { .. }));
        })
    });
    let name = |what: &str| format!("time of the gate at {rows} rows, {what}");
    let with = name("with a refit as given and corrected");
    let ratio = format!("time of the gate at {MORE} times the rows over {MORE} times the time");
    let timed = |figure: Figure, runs| figure.timed(context.is_small()).over(runs, "");
    let without = Figure::at_most(&name("without a refit"), 100.0, once, "ms");
    let with = Figure::at_most(&with, 500.0, slowest[0].max(slowest[1]), "ms");
    let ratio = Figure::within(&ratio, [0.0, 1.5], more / once / MORE);
    Ok(vec![
        timed(without, TIMED_RUNS),
        timed(with, 2 * TIMED_RUNS),
        Figure::truth("the latitude's sign stops the diagnosis", is_told),
        timed(ratio, TIMED_RUNS),
    ])
}
