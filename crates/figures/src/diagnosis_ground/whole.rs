//! The whole diagnosis of noise other than declared: there must be no physical finding.

use std::collections::BTreeMap;

use gyrocal_diagnosis::result::FindingKind;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_statistics::Proportion;
use serde::{Deserialize, Serialize};

use super::records::{KINDS, POPULATION, record, three_days};
use super::{Error, campaign};
use crate::figure::Figure;

/// Records of each kind; each takes some seconds of one core.
const RUNS: u64 = 40;
const SMALL_RUNS: u64 = 4;

/// First number of the records, above those of the cells of the audit.
const FIRST: u64 = 10_000;

/// Family-wise false-alarm probability of the diagnosis, its default.
const NOMINAL: f64 = 0.01;

/// Result of the diagnosis of one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Diagnosed {
    physical: Vec<String>,
    noise: Vec<String>,
}

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let runs = if small { SMALL_RUNS } else { RUNS };
    let mut figures = Vec::new();
    let mut every = Vec::new();
    let seeds = format!("population {POPULATION}, {FIRST} to {}", FIRST + runs - 1);
    for kind in KINDS {
        let job = |number: u64| -> Result<Diagnosed, Error> {
            let case = record(number, kind.fault);
            let bench = three_days().scenario(number).bench();
            let found = diagnose(&case.record, &bench, &DiagnoseOptions::default())?;
            let found = found.result;
            let ids = |kind: FindingKind| -> Vec<String> {
                found.of_kind(kind).map(|f| f.effect.clone()).collect()
            };
            let mut noise = ids(FindingKind::Noise);
            noise.sort_unstable();
            Ok(Diagnosed {
                physical: ids(FindingKind::Cause),
                noise,
            })
        };
        let cell = format!("whole {}", kind.name);
        let outcome = campaign(&cell, FIRST..FIRST + runs, small)?.run(job, |progress| {
            eprintln!("{cell}: {} of {}", progress.done, progress.total);
        })?;
        let failed = outcome.failures().count();
        let all: Vec<&Diagnosed> = outcome.successes().map(|(_, one)| one).collect();
        let alarms = all.iter().map(|one| !one.physical.is_empty());
        let alarms: Vec<bool> = alarms.collect();
        figures.push(
            Figure::note(
                &format!("{}: whole diagnoses with a physical finding", kind.name),
                told(&all, &alarms, failed),
            )
            .over(all.len(), seeds.clone()),
        );
        figures.push(
            Figure::note(
                &format!("{}: whole diagnoses with other noise findings", kind.name),
                others(&all, &kind.expected()),
            )
            .over(all.len(), seeds.clone()),
        );
        every.extend(alarms);
    }
    // All kinds together, for forty records of one show little of 1 %. A rate that is the nominal
    // one passes in 98 % of all full populations, one of 5 % in 6 % of them.
    let alarms = Proportion::of(every);
    let mut figure = Figure::truth(
        "all five: physical findings not shown (95 %) to exceed the 1 % that is promised",
        alarms.lower_bound(0.95) <= NOMINAL,
    );
    figure.measured = format!(
        "{}, {} of {}; 95 % upper bound {:.2} %",
        figure.measured,
        alarms.hits,
        alarms.trials,
        100.0 * alarms.upper_bound(0.95)
    );
    if small {
        figure = figure.judged(alarms.at_most(NOMINAL));
    }
    figures.push(figure.over(alarms.trials as usize, seeds));
    Ok(figures)
}

/// Records with other noise findings than expected, with the missing or additional effects.
fn others(all: &[&Diagnosed], expected: &[&str]) -> String {
    let wrong = |one: &&&Diagnosed| one.noise != expected;
    let mut effects: BTreeMap<String, usize> = BTreeMap::new();
    for one in all.iter().filter(wrong) {
        let more = one.noise.iter().map(String::as_str);
        let more = more.filter(|effect| !expected.contains(effect));
        for effect in more {
            *effects.entry(effect.to_owned()).or_default() += 1;
        }
        let fewer = expected
            .iter()
            .filter(|effect| !one.noise.iter().any(|n| n == **effect));
        for effect in fewer {
            *effects.entry(format!("no {effect}")).or_default() += 1;
        }
    }
    let effects: Vec<String> = effects
        .into_iter()
        .map(|(effect, count)| format!("{effect} {count}"))
        .collect();
    let told = format!("{} of {}", all.iter().filter(wrong).count(), all.len());
    if effects.is_empty() {
        told
    } else {
        format!("{told} ({})", effects.join(", "))
    }
}

fn told(all: &[&Diagnosed], alarms: &[bool], failed: usize) -> String {
    let share = Proportion::of(alarms.iter().copied());
    let mut told = format!(
        "{} of {}, 95 % upper bound {:.1} %",
        share.hits,
        share.trials,
        100.0 * share.upper_bound(0.95)
    );
    let effects: Vec<&str> = all
        .iter()
        .flat_map(|one| one.physical.iter().map(String::as_str))
        .collect();
    if !effects.is_empty() {
        told.push_str(&format!(" ({})", effects.join(", ")));
    }
    if failed > 0 {
        told.push_str(&format!("; {failed} could not be diagnosed"));
    }
    told
}
