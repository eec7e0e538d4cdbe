//! Records of the nonlinear simulator, which shares no equation with filter and watch, replayed as
//! `gyrocal watch` does.

use gyrocal::watch::WatchedEffect;
use gyrocal::{FilterSettings, Site};
use gyrocal_diagnosis::{WatchAlarm, WatchCause, WatchOptions, watch_record};
use gyrocal_statistics::median;
use gyrocal_truth::{Hidden, Population, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::{DAY_S, platforms};
use crate::harness::{Context, Error, Figure, Row};

/// A population that no constant was tuned on.
const RECORDS: u64 = 20_261_234;
const DAYS: f64 = 14.0;
/// An effect begins when the filter has settled.
const ONSET_DAYS: f64 = 6.0;
/// Turn of a knock, rad: one and a half of those that are looked for.
const KNOCK_RAD: f64 = 6e-5;
const STEP: &str = "gyro_x.step";
const KNOCK: &str = "platform.knock";

/// What is hidden in the records of a cell, and its words.
const CELLS: [(Option<&str>, &str); 3] = [
    (None, "clean"),
    (Some(STEP), "a step of 8 sigma a day"),
    (Some(KNOCK), "a knock"),
];

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

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (id, words) in CELLS {
        let population = platforms(&format!("nonlinear {words}"), [60, 3], |number| {
            run(id, number)
        });
        figures.extend(context.measure(&population, &rows(id, words))?);
    }
    Ok(figures)
}

fn rows(id: Option<&str>, words: &str) -> Vec<Row<'static, Run>> {
    let name = |what: &str| format!("nonlinear, {words}: {what}");
    let alarms = match id {
        None => format!("nonlinear records of {DAYS} days, clean: alarms"),
        Some(_) => name("alarms before it"),
    };
    let before = |run: &Run| usize::from(run.before);
    let mut rows = vec![Row::count(alarms, before).at_most(
        0.0,
        "two years of them at 1 % a year: one of fifty populations has an alarm",
    )];
    if id.is_some() {
        let delay = |all: &[Run]| {
            let days = all.iter().filter_map(|run| Some(run.alarm.as_ref()?.days));
            format!("{:.2} days", median(&days.collect::<Vec<_>>()))
        };
        let left = DAYS - ONSET_DAYS;
        const REASON: &str = "sets of 95 %";
        rows.extend([
            Row::share(name(&format!("found within {left} days")), |run: &Run| {
                Some(run.alarm.is_some())
            }),
            Row::words(name("median delay"), delay),
            Row::share(name("set at the alarm holds it"), |run: &Run| {
                Some(run.alarm.as_ref()?.held)
            })
            .at_least(0.95, REASON),
            Row::share(name("refined set holds it"), |run: &Run| {
                Some(run.alarm.as_ref()?.refined)
            })
            .at_least(0.95, REASON),
        ]);
    }
    rows
}

/// Simulates a record and replays it.
fn run(id: Option<&str>, number: u64) -> Result<Run, Error> {
    let population = Population {
        duration_days: [DAYS; 2],
        ..Population::new(RECORDS)
    };
    let mut scenario = population.scenario(number);
    let onset_s = ONSET_DAYS * DAY_S;
    let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(scenario.latitude_deg));
    let of_a_day = WatchedEffect::of(STEP).information_of_a_day(&settings);
    if let Some(id) = id {
        let size = match id {
            STEP => ("size", 8.0 / of_a_day.sqrt()),
            _ => ("x_deg", KNOCK_RAD.to_degrees()),
        };
        let hidden = Hidden::new(id, &[size, ("onset_s", onset_s)])?;
        scenario.hidden.push(hidden);
    }
    let Simulation { record, bench, .. } = simulate(&scenario)?;
    let replay = watch_record(&record, &bench, &WatchOptions::default())?;
    let late = |alarm: &&WatchAlarm| id.is_some() && alarm.time_s > onset_s;
    let holds = |set: &[WatchCause]| {
        set.iter().any(|cause| match id {
            Some(KNOCK) => cause.jump_axis.is_some(),
            _ => cause.id == STEP,
        })
    };
    Ok(Run {
        before: replay.alarms.iter().any(|alarm| !late(&alarm)),
        alarm: replay.alarms.iter().find(late).map(|alarm| Found {
            days: (alarm.time_s - onset_s) / DAY_S,
            held: holds(&alarm.at_alarm),
            refined: holds(&alarm.refined),
        }),
    })
}
