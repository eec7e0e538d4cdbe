//! Records of the nonlinear simulator, which shares no equation with filter and watch, replayed as
//! `gyrocal watch` does.

use gyrocal::watch::WatchedEffect;
use gyrocal::{FilterSettings, Site};
use gyrocal_diagnosis::{WatchAlarm, WatchOptions, WatchReplay, watch_record};
use gyrocal_statistics::Proportion;
use gyrocal_truth::{Hidden, Population, simulate};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// A population that no constant was tuned on.
const RECORDS: u64 = 20_261_234;
const DAYS: f64 = 14.0;
/// An effect begins when the filter has settled.
const ONSET_DAYS: f64 = 6.0;
const DAY_S: f64 = 86_400.0;
/// Turn of a knock, rad: one and a half of those that are looked for.
const KNOCK_RAD: f64 = 6e-5;
const STEP: &str = "gyro_x.step";
const KNOCK: &str = "platform.knock";

/// A record: its first alarm after the onset, and whether there was one before.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Run {
    before: bool,
    alarm: Option<Found>,
}

/// An alarm after the onset.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Found {
    days: f64,
    held: bool,
    refined: bool,
}

/// What is hidden in the records of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Cell {
    Clean,
    Step,
    Knock,
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for cell in [Cell::Clean, Cell::Step, Cell::Knock] {
        let seeds = 0..extent.records(60, 3);
        let name = format!("nonlinear {cell:?}");
        let campaign = resumable::campaign("watch", &name, seeds.clone(), extent.small)?;
        let outcome = campaign.run(|number| run(cell, number), |_| ())?;
        let runs: Vec<Run> = outcome.successes().map(|(_, run)| run.clone()).collect();
        let lost = Figure::within("nonlinear records without an answer", [0.0, 0.0], {
            outcome.failures().count() as f64
        });
        let seeds = format!("{RECORDS}, {seeds:?}");
        let add = |figure: Figure| figure.over(runs.len(), seeds.as_str());
        figures.extend(of_cell(cell, &runs, extent.small).into_iter().map(add));
        if outcome.failures().count() > 0 {
            figures.push(add(lost));
        }
    }
    Ok(figures)
}

fn of_cell(cell: Cell, runs: &[Run], small: bool) -> Vec<Figure> {
    let false_alarms = runs.iter().filter(|run| run.before).count();
    let within = |name: &str, value: usize| Figure::within(name, [0.0, 0.0], value as f64);
    let what = match cell {
        Cell::Clean => {
            let name = format!("nonlinear records of {DAYS} days, clean: alarms");
            return vec![within(&name, false_alarms)];
        }
        Cell::Step => "a step of 8 sigma a day",
        Cell::Knock => "a knock",
    };
    let found: Vec<&Found> = runs.iter().filter_map(|run| run.alarm.as_ref()).collect();
    let share = |name: String, share: Proportion| {
        let figure = Figure::within(&name, [0.95, f64::INFINITY], share.share()).of_share(share);
        match small {
            true => figure.judged(share.at_least(0.95)),
            false => figure,
        }
    };
    let alarmed = Proportion {
        hits: found.len() as u64,
        trials: runs.len() as u64,
    };
    let mut days: Vec<f64> = found.iter().map(|found| found.days).collect();
    days.sort_by(f64::total_cmp);
    let median = days.get(days.len() / 2).copied().unwrap_or(f64::INFINITY);
    let held = Proportion::of(found.iter().map(|found| found.held));
    let refined = Proportion::of(found.iter().map(|found| found.refined));
    let left = DAYS - ONSET_DAYS;
    vec![
        within(
            &format!("nonlinear, {what}: alarms before it"),
            false_alarms,
        ),
        Figure::note_share(
            &format!("nonlinear, {what}: found within {left} days"),
            alarmed,
            "",
        ),
        Figure::note(
            &format!("nonlinear, {what}: median delay"),
            format!("{median:.2} days"),
        ),
        share(
            format!("nonlinear, {what}: set at the alarm holds it"),
            held,
        ),
        share(format!("nonlinear, {what}: refined set holds it"), refined),
    ]
}

/// Simulates a record and replays it.
fn run(cell: Cell, number: u64) -> Result<Run, Error> {
    let population = Population {
        duration_days: [DAYS; 2],
        ..Population::new(RECORDS)
    };
    let mut scenario = population.scenario(number);
    let onset_s = ONSET_DAYS * DAY_S;
    let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(scenario.latitude_deg));
    let effect = WatchedEffect::of(STEP);
    let step = 8.0 / effect.information_of_a_day(&settings).sqrt();
    let hidden = match cell {
        Cell::Clean => None,
        Cell::Step => Some(Hidden::new(STEP, &[("size", step), ("onset_s", onset_s)])?),
        Cell::Knock => {
            let turn = KNOCK_RAD.to_degrees();
            Some(Hidden::new(
                KNOCK,
                &[("x_deg", turn), ("onset_s", onset_s)],
            )?)
        }
    };
    scenario.hidden.extend(hidden);
    let simulation = simulate(&scenario)?;
    let replay = watch_record(
        &simulation.record,
        &simulation.bench,
        &WatchOptions::default(),
    )?;
    Ok(judged(cell, &replay, onset_s))
}

fn judged(cell: Cell, replay: &WatchReplay, onset_s: f64) -> Run {
    let late = |alarm: &&WatchAlarm| cell != Cell::Clean && alarm.time_s > onset_s;
    let holds = |set: &[gyrocal_diagnosis::WatchCause]| {
        set.iter().any(|cause| match cell {
            Cell::Knock => cause.jump_axis.is_some(),
            _ => cause.id == STEP,
        })
    };
    Run {
        before: replay.alarms.iter().any(|alarm| !late(&alarm)),
        alarm: replay.alarms.iter().find(late).map(|alarm| Found {
            days: (alarm.time_s - onset_s) / DAY_S,
            held: holds(&alarm.at_alarm),
            refined: holds(&alarm.refined),
        }),
    }
}
