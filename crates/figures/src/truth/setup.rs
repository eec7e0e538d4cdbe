//! Gross errors of the set-up: told right, false alarms, cost.

use std::time::Instant;

use gyrocal_calibration::{Options, Run};
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisError, Gate, diagnose};
use gyrocal_evaluation::{Outcome, inject_any};
use gyrocal_setup::{PlatformKind, check_setup};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{Proportion, median};
use gyrocal_testkit::broken_setups::{
    BREAKAGES, Breakage, leave_angles_out, varied_record, varied_scenario,
};
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// First seed of the broken records, and records of each kind; of the small version.
const BROKEN: u64 = 3_000_000;
const OF_EACH: u64 = 20;
const SMALL_OF_EACH: u64 = 3;

/// First seed and number of the sound records; of the small version.
const SOUND: u64 = 3_100_000;
const SOUND_RECORDS: u64 = 1_000;
const SMALL_SOUND_RECORDS: u64 = 60;

/// First seed and number of the records whose sign of the latitude fits decide; of the small version.
const UNDECIDED: u64 = 3_210_000;
const UNDECIDED_RECORDS: u64 = 400;
const SMALL_UNDECIDED_RECORDS: u64 = 16;

/// Strength of the effects in every other sound record, in sigmas of their own bound.
const STRENGTHS: [f64; 2] = [5.0, 100.0];

/// Timed runs, of which the median counts.
const TIMED_RUNS: usize = 9;

/// Rows of the timed records: three days of minutes, and ten times as many.
const DAYS: f64 = 3.0;
const MORE: f64 = 10.0;

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = broken(small)?;
    figures.extend(sound(small)?);
    figures.extend(undecided(small)?);
    figures.extend(time()?);
    Ok(figures)
}

/// What was told of one broken record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Told {
    breakage: String,
    findings: Vec<String>,
    is_right: bool,
}

fn tell(breakage: &Breakage, seed: u64) -> Told {
    let broken = breakage.record(seed);
    let found = check_setup(&broken.record, &broken.bench).findings;
    let is_named = |kind: &str| breakage.kinds.contains(&kind);
    let is_right = !found.is_empty()
        && found.iter().all(|finding| {
            let others = finding.equivalent_kinds.iter();
            is_named(finding.kind.as_str())
                || others.into_iter().any(|kind| is_named(kind.as_str()))
        });
    Told {
        breakage: breakage.name.to_owned(),
        findings: found.iter().map(|f| f.kind.as_str().to_owned()).collect(),
        is_right,
    }
}

fn broken(small: bool) -> Result<Vec<Figure>, Error> {
    let each = if small { SMALL_OF_EACH } else { OF_EACH };
    let seeds = BROKEN..BROKEN + each * BREAKAGES.len() as u64;
    let campaign = resumable::campaign("truth", "gross errors", seeds.clone(), small)?;
    let job = |seed: u64| {
        let breakage = &BREAKAGES[((seed - BROKEN) / each) as usize];
        Ok::<_, Error>(tell(breakage, seed))
    };
    let outcome: Outcome<Told> = campaign.run(job, |_| ())?;
    let all: Vec<&Told> = outcome.successes().map(|(_, told)| told).collect();
    let right = Proportion::of(all.iter().map(|told| told.is_right));
    let mut worst = (each, "none");
    for breakage in BREAKAGES {
        let of_it = all.iter().filter(|told| told.breakage == breakage.name);
        let hits = of_it.filter(|told| told.is_right).count() as u64;
        if hits < worst.0 {
            worst = (hits, breakage.name);
        }
    }
    let name = format!("gross errors, {} kinds:", BREAKAGES.len());
    let seeds = format!("{seeds:?}");
    let mut over_all = Figure::within(
        &format!("{name} right kind or class, over all"),
        [0.98, f64::INFINITY],
        right.share(),
    )
    .of_share(right);
    if small {
        over_all = over_all.judged(right.at_least(0.98));
    }
    let least = if small { 1 } else { 17 };
    let mut worst_kind = Figure::note(
        &format!("{name} worst kind"),
        format!("{} of {each} ({})", worst.0, worst.1),
    );
    worst_kind.target = format!(">= {least} of {each}");
    worst_kind.holds = Some(worst.0 >= least);
    Ok(vec![
        over_all.over(all.len(), seeds.clone()),
        worst_kind.over(all.len(), seeds),
    ])
}

/// A sound record of a seed; every other one has an effect.
fn sound_record(seed: u64) -> Result<Simulation, Error> {
    let mut scenario = varied_scenario(seed);
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
    Ok(varied_record(seed, &scenario))
}

fn sound(small: bool) -> Result<Vec<Figure>, Error> {
    let records = if small {
        SMALL_SOUND_RECORDS
    } else {
        SOUND_RECORDS
    };
    let seeds = SOUND..SOUND + records;
    let campaign = resumable::campaign("truth", "sound", seeds.clone(), small)?;
    let job = |seed: u64| Ok::<_, Error>(told(&sound_record(seed)?));
    let outcome: Outcome<Vec<String>> = campaign.run(job, |_| ())?;
    let alarms = Proportion::of(outcome.successes().map(|(_, kinds)| !kinds.is_empty()));
    let mut figure = Figure::within(
        "false alarms of the gate: sound records",
        [f64::NEG_INFINITY, 0.005],
        alarms.share(),
    )
    .of_share(alarms);
    if small {
        figure = figure.judged(alarms.at_most(0.005));
    }
    let failed = outcome.failures().count();
    let mut figures = vec![figure.over(alarms.trials as usize, format!("{seeds:?}"))];
    if failed > 0 {
        figures.push(Figure::note(
            "false alarms of the gate: records in which no effect reaches the strength",
            failed.to_string(),
        ));
    }
    Ok(figures)
}

/// Kinds that the gate tells, fits included.
fn told(simulation: &Simulation) -> Vec<String> {
    let (record, bench) = (&simulation.record, &simulation.bench);
    let run = Run { record, bench };
    let found = Gate::new(PlatformKind::Stabilised, &run, &Options::default());
    found.problems.into_iter().map(|one| one.kind).collect()
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
    let sign = random.sign();
    let mut three = || core::array::from_fn(|_| random.normal());
    let scenario = Scenario {
        seed,
        latitude_deg: sign * size_deg,
        initial: InitialAttitude::Random,
        duration_s: 3600.0 * hours,
        coefficients: Coefficients {
            bias_deg_per_h: three(),
            g_deg_per_h_per_g: three(),
            gg_deg_per_h_per_g2: three(),
        },
        ..Scenario::default()
    };
    let mut simulation = simulate(&scenario)?;
    leave_angles_out(&mut simulation.bench);
    Ok(simulation)
}

fn undecided(small: bool) -> Result<Vec<Figure>, Error> {
    let records = if small {
        SMALL_UNDECIDED_RECORDS
    } else {
        UNDECIDED_RECORDS
    };
    let seeds = UNDECIDED..UNDECIDED + records;
    let campaign = resumable::campaign("truth", "undecided", seeds.clone(), small)?;
    let job = |seed: u64| {
        let mut simulation = undecided_record(seed)?;
        // Every other one has the wrong sign.
        if seed % 2 == 1 {
            simulation.bench.latitude_deg *= -1.0;
        }
        Ok::<_, Error>(told(&simulation))
    };
    let outcome: Outcome<Vec<String>> = campaign.run(job, |_| ())?;
    let of = |wrong: u64| {
        outcome
            .successes()
            .filter(move |(seed, _)| *seed % 2 == wrong)
    };
    let right = Proportion::of(of(1).map(|(_, kinds)| *kinds == ["handedness"]));
    let alarms = Proportion::of(of(0).map(|(_, kinds)| !kinds.is_empty()));
    let name = "sign of the latitude by fits, below 15 deg or 12 h:";
    let mut first = Figure::within(
        &format!("{name} told"),
        [0.95, f64::INFINITY],
        right.share(),
    )
    .of_share(right);
    let mut second = Figure::within(
        &format!("{name} false"),
        [f64::NEG_INFINITY, 0.005],
        alarms.share(),
    )
    .of_share(alarms);
    if small {
        first = first.judged(right.at_least(0.95));
        second = second.judged(alarms.at_most(0.005));
    }
    let seeds = format!("{seeds:?}");
    Ok(vec![
        first.over(right.trials as usize, seeds.clone()),
        second.over(alarms.trials as usize, seeds),
    ])
}

fn simulated(days: f64) -> Result<Simulation, Error> {
    Ok(simulate(&Scenario {
        seed: SOUND,
        latitude_deg: 48.2,
        initial: InitialAttitude::Random,
        // The last row begins the next day.
        duration_s: days * 86_400.0 - 60.0,
        ..Scenario::default()
    })?)
}

/// Median time of a job, s.
fn timed(mut job: impl FnMut()) -> f64 {
    let times: Vec<f64> = (0..TIMED_RUNS)
        .map(|_| {
            let start = Instant::now();
            job();
            start.elapsed().as_secs_f64()
        })
        .collect();
    median(&times)
}

fn time() -> Result<Vec<Figure>, Error> {
    let of_gate = |simulation: &Simulation| {
        timed(|| {
            std::hint::black_box(check_setup(&simulation.record, &simulation.bench));
        })
    };
    let first = simulated(DAYS)?;
    let rows = first.record.len();
    let (once, more) = (of_gate(&first), of_gate(&simulated(MORE * DAYS)?));
    let mut reversed = first;
    reversed.bench.latitude_deg *= -1.0;
    let mut slowest = 0.0_f64;
    let mut is_told = true;
    for angles in [true, false] {
        if !angles {
            leave_angles_out(&mut reversed.bench);
        }
        slowest = slowest.max(timed(|| {
            let options = DiagnoseOptions::default();
            let found = diagnose(&reversed.record, &reversed.bench, &options);
            is_told &= matches!(found, Err(DiagnosisError::Setup { .. }));
        }));
    }
    let name = |what: &str| format!("time of the gate at {rows} rows, {what}");
    Ok(vec![
        Figure::at_most(&name("without a refit"), 100.0, 1e3 * once, "ms").over(TIMED_RUNS, ""),
        Figure::at_most(
            &name("with a refit as given and corrected"),
            500.0,
            1e3 * slowest,
            "ms",
        )
        .over(2 * TIMED_RUNS, ""),
        Figure::truth("the latitude's sign stops the diagnosis", is_told),
        Figure::within(
            &format!("time of the gate at {MORE} times the rows over {MORE} times the time"),
            [0.0, 1.5],
            more / once / MORE,
        )
        .over(TIMED_RUNS, ""),
    ])
}
