//! The figures of each cell.

use core::ops::Range;
use std::collections::BTreeMap;

use gyrocal_campaign::Outcome;
use gyrocal_statistics::{Proportion, quantile};

use crate::case::Case;
use crate::cell::Cell;
use crate::characteristic::{Characteristic, Gathered};
use crate::family::families;

/// Two signatures are of one class if the cosine of the angle between them is at least this.
pub const NEAR_PARALLEL: f64 = 0.9;

/// A stricter one that only informs.
const NEARER: f64 = 0.97;

/// What is asked of single effects by size: detection on average and of the worst family, class
/// of the first name.
const SINGLES: [(u32, [f64; 2], Option<f64>); 4] = [
    (5, [0.86, 0.80], None),
    (6, [0.97, 0.95], None),
    (8, [0.995, 0.99], Some(0.91)),
    (12, [0.995, 0.99], Some(0.97)),
];

/// The one effect that may be at any place of a record by itself.
const KNOCK: &str = "platform.knock";

/// Lengths beside named causes that count as the 10 sigmas that are asked for.
const BEYOND: Range<f64> = 9.0..11.5;

/// The figures of a cell, in the order of the table.
#[must_use]
pub fn characteristics(
    cell: Cell,
    outcome: &Outcome<Case>,
    seeds: &Range<u64>,
) -> Vec<Characteristic> {
    let cases: Vec<&Case> = outcome.successes().map(|(_, case)| case).collect();
    let mut gathered = Gathered {
        cell: cell.name(),
        seeds: seeds.clone(),
        full: seeds.end - seeds.start >= cell.full_runs(),
        all: Vec::new(),
    };
    match cell {
        Cell::Clean => clean(&mut gathered, &cases),
        Cell::Single(strength) => {
            let asked = SINGLES.iter().find(|(of, ..)| *of == strength);
            if let Some((_, detected, first)) = asked {
                single(&mut gathered, &cases, Some(*detected), *first);
            }
        }
        Cell::LogUniform => single(&mut gathered, &cases, None, None),
        Cell::Pair => pair(&mut gathered, &cases),
        Cell::Beyond => beyond(&mut gathered, &cases),
        Cell::Step => step(&mut gathered, &cases),
        Cell::Cubic => {
            let silent = share(&cases, |case| Some(case.verdict == "clean"));
            gathered.at_least("silent", 0.75, silent);
        }
        Cell::Azimuth => {
            let first = share(&cases, |case| {
                let first = case.findings.first();
                Some(first.is_some_and(|first| first.effect == "platform.initial_attitude"))
            });
            gathered.at_least("named `platform.initial_attitude`", 0.95, first);
            gathered.mean("its mean size in sigmas", &strengths(&cases));
        }
    }
    let alone = cases.iter().flat_map(|case| &case.findings);
    let alone = alone.filter(|finding| finding.alone).count();
    if cell != Cell::Clean && cell != Cell::Cubic {
        gathered.none(
            "single names for exact equivalents",
            alone,
            cases.len() as u64,
        );
    }
    let failed = outcome.failures().count();
    if failed > 0 {
        let runs = seeds.end - seeds.start;
        gathered.none("records that could not be examined", failed, runs);
    }
    gathered.all
}

fn share(cases: &[&Case], of: impl Fn(&Case) -> Option<bool>) -> Proportion {
    Proportion::of(cases.iter().filter_map(|case| of(case)))
}

/// The same for each hidden effect by itself: some are hidden more often than others.
fn by_effect(cases: &[&Case], of: impl Fn(&Case) -> Option<bool>) -> Vec<Proportion> {
    let mut effects: BTreeMap<&str, Vec<bool>> = BTreeMap::new();
    for case in cases {
        if let (Some(hidden), Some(counts)) = (case.hidden.first(), of(case)) {
            effects.entry(&hidden.effect).or_default().push(counts);
        }
    }
    effects.into_values().map(Proportion::of).collect()
}

fn strengths(cases: &[&Case]) -> Vec<f64> {
    let hidden = cases.iter().flat_map(|case| &case.hidden);
    hidden.map(|hidden| hidden.strength).collect()
}

fn clean(gathered: &mut Gathered, cases: &[&Case]) {
    let alarms = share(cases, |case| Some(case.verdict != "clean"));
    gathered.bound_at_most("false alarms, upper 95 % bound", 0.02, alarms);
    gathered.note("false alarms", alarms);
    let by = |of: fn(&Case) -> bool| share(cases, |case| Some(of(case)));
    gathered.note("false alarms of the search", by(|case| case.detected()));
    gathered.note("false alarms of noise", by(|case| !case.noise.is_empty()));
    gathered.note(
        "false alarms of the remainder",
        by(|case| case.unexplained.is_some()),
    );
}

fn single(
    gathered: &mut Gathered,
    cases: &[&Case],
    detected: Option<[f64; 2]>,
    first: Option<f64>,
) {
    if let Some([average, worst]) = detected {
        let of = by_effect(cases, |case| Some(case.detected()));
        gathered.average_at_least("detected, average of the effects", average, &of);
        let all = families(cases);
        let of = |knocks: bool| -> Vec<Proportion> {
            let some = all.iter().filter(|one| (one.family == KNOCK) == knocks);
            some.map(|one| one.detected()).collect()
        };
        gathered.none_below("detected, the worst family but knocks", worst, &of(false));
        // Of five and six sigmas no test finds them as often: docs/characteristics.md.
        match of(true).as_slice() {
            [knocks] if first.is_some() => {
                gathered.none_below("detected, knocks", worst, &[*knocks]);
            }
            [knocks] => gathered.note("detected, knocks", *knocks),
            _ => {}
        }
    }
    let in_set = share(cases, |case| {
        case.detected()
            .then(|| case.hidden.iter().all(|hidden| hidden.in_set))
    });
    gathered.at_least("the named set holds the truth", 0.95, in_set);
    set_size(gathered, cases);
    let right = |case: &Case, cosine: f64| {
        let hidden = case.hidden.first()?;
        case.detected().then_some(hidden.first_cosine >= cosine)
    };
    let first_at = |cosine: f64| share(cases, move |case| right(case, cosine));
    match first {
        Some(least) => gathered.average_at_least(
            "the class named first is right, average of the effects",
            least,
            &by_effect(cases, |case| right(case, NEAR_PARALLEL)),
        ),
        None => gathered.note("the class named first is right", first_at(NEAR_PARALLEL)),
    }
    gathered.note(
        "the same with classes of a cosine of 0.97 or more",
        first_at(NEARER),
    );
    gathered.note("the name named first is right", first_at(1.0));
    covered(gathered, cases);
    let more = share(cases, |case| {
        case.detected().then_some(case.findings.len() > 1)
    });
    gathered.note("a spurious second", more);
}

fn set_size(gathered: &mut Gathered, cases: &[&Case]) {
    let sizes: Vec<[f64; 2]> = cases
        .iter()
        .filter(|case| case.detected())
        .filter_map(|case| Some([case.set_size() as f64, case.oracle_set_size? as f64]))
        .collect();
    gathered.ratio_at_most("mean size of the set over the oracle's", 1.2, &sizes);
    let own: Vec<f64> = sizes.iter().map(|pair| pair[0]).collect();
    gathered.mean("mean size of the set", &own);
    gathered.mean(
        "mean size of the smallest sets that hold it in 95 %",
        &smallest(cases),
    );
}

/// Sizes of the sets of the first search at the one constant with which they hold the truth in
/// 95 % of the detected records: nothing that is compared in this way can do with less.
fn smallest(cases: &[&Case]) -> Vec<f64> {
    let detected = || cases.iter().filter(|case| case.detected());
    let deficits: Vec<f64> = detected()
        .filter_map(|case| case.hidden.first()?.deficit)
        .collect();
    let constant = quantile(&deficits, 0.95);
    detected()
        .map(|case| {
            1 + case
                .nearest
                .iter()
                .filter(|near| near.1 <= constant)
                .count()
        })
        .map(|size| size as f64)
        .collect()
}

fn covered(gathered: &mut Gathered, cases: &[&Case]) {
    let covered = cases
        .iter()
        .flat_map(|case| &case.hidden)
        .filter_map(|hidden| hidden.covered);
    gathered.at_least(
        "95 % interval of the size holds it, given the right name",
        0.93,
        Proportion::of(covered),
    );
}

fn pair(gathered: &mut Gathered, cases: &[&Case]) {
    let each = share(cases, |case| Some(case.each_in_its_set()));
    gathered.at_least("each in its set", 0.90, each);
    let third = share(cases, |case| Some(case.findings.len() > 2));
    gathered.at_most("a spurious third", 0.08, third);
    covered(gathered, cases);
}

fn beyond(gathered: &mut Gathered, cases: &[&Case]) {
    let reached = |case: &Case| {
        let hidden = case.hidden.first();
        hidden.is_some_and(|hidden| BEYOND.contains(&hidden.strength))
    };
    let flagged = share(cases, |case| {
        reached(case).then(|| case.unexplained.is_some())
    });
    gathered.at_least("flagged unexplained", 0.98, flagged);
    let masked = share(cases, |case| {
        Some(case.detected() && case.unexplained.is_none())
    });
    gathered.at_most("a false name with a clean remainder", 0.05, masked);
    let noise = share(cases, |case| {
        Some(!case.noise.is_empty() && !case.detected() && case.unexplained.is_none())
    });
    gathered.note("taken for noise alone", noise);
    gathered.note(
        "as long as asked for beside the causes that were named",
        share(cases, |case| Some(reached(case))),
    );
}

fn step(gathered: &mut Gathered, cases: &[&Case]) {
    const NEAR: f64 = 0.05;
    let onset = |case: &Case| case.hidden.first().and_then(|hidden| hidden.onset_error);
    gathered.at_least(
        "onset within 5 % of the record, given the right name",
        0.90,
        share(cases, |case| onset(case).map(|error| error <= NEAR)),
    );
    gathered.note(
        "onset within 5 % of the record, of all",
        share(cases, |case| {
            Some(onset(case).is_some_and(|error| error <= NEAR))
        }),
    );
    gathered.note("detected", share(cases, |case| Some(case.detected())));
}
