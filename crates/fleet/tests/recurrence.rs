//! The search for recurring causes on drawn scores.
#![cfg(test)]

use gyrocal_fleet::RecurringCause;
use gyrocal_fleet::recurrence::{
    Injected, RecurrenceOptions, ScoreSimulator, UnitRecords, oracle_finds, recurring,
};
use gyrocal_hypothesis::{ScoreTable, ScoredEffect, Stop, Stopped};
use gyrocal_statistics::deviates::Draw;
use nalgebra::DMatrix;

const UNITS: usize = 120;

/// A step at five onsets, a wave of two columns, a constant with a twin, and ten other constants.
fn simulator() -> ScoreSimulator {
    let effect = |id: String, persists, variants| ScoredEffect {
        id,
        unit: "deg/h".to_owned(),
        persists,
        variants,
    };
    let mut effects = vec![
        effect(
            "step".to_owned(),
            false,
            (0..5).map(|column| vec![column]).collect(),
        ),
        effect("wave".to_owned(), true, vec![vec![5, 6]]),
        effect("constant".to_owned(), true, vec![vec![7]]),
        effect("twin".to_owned(), true, vec![vec![8]]),
    ];
    effects
        .extend((9..19).map(|column| effect(format!("other-{column}"), true, vec![vec![column]])));
    let correlation = DMatrix::from_fn(19, 19, |i, j| match (i.min(j), i.max(j)) {
        (one, other) if one == other => 1.0,
        // Neighbouring onsets.
        (one, other) if other < 5 => 0.7_f64.powi((other - one) as i32),
        (7, 8) => 0.95,
        _ => 0.0,
    });
    ScoreSimulator::new(ScoreTable {
        effects,
        in_model: Vec::new(),
        z: vec![0.0; 19],
        root_information: vec![50.0; 19],
        correlation,
    })
    .unwrap()
}

/// A fleet with a cause of a strength in every `each`-th unit.
fn fleet(cause: Option<(&str, f64, usize)>, seed: u64) -> Vec<ScoreTable> {
    let simulator = simulator();
    let mut draw = Draw::new(seed, 0);
    (0..UNITS)
        .map(|unit| {
            let own = cause.filter(|(_, _, each)| unit % each == 0);
            let own = own.map(|(effect, strength, _)| (effect, strength));
            simulator.draw(own, &mut draw).unwrap()
        })
        .collect()
}

#[test]
fn a_search_that_is_stopped_finds_nothing() {
    let stop = Stop::default();
    stop.ask();
    let found = stop.over(|| recurring(&[], &RecurrenceOptions::default()));
    assert_eq!(found.err(), Some(Stopped));
}

fn found(tables: &[ScoreTable]) -> Vec<RecurringCause> {
    let names: Vec<String> = (0..tables.len())
        .map(|unit| format!("unit-{unit}"))
        .collect();
    recurring(&units(&names, tables), &RecurrenceOptions::default()).unwrap()
}

fn units<'a>(names: &'a [String], tables: &'a [ScoreTable]) -> Vec<UnitRecords<'a>> {
    let all = names.iter().zip(tables);
    all.map(|(unit, table)| UnitRecords {
        unit,
        tables: vec![table],
    })
    .collect()
}

#[test]
fn a_cause_with_random_signs_and_onsets_is_found_and_no_other() {
    for effect in ["step", "wave", "constant"] {
        let found = found(&fleet(Some((effect, 3.0, 5)), 1));
        let [only] = &found[..] else {
            panic!("{effect}: {found:?}")
        };
        assert_eq!(only.effect, effect);
        // A fifth of the units, at three sigmas: the grid is 0.1, 0.2, 0.5 and 2, 3, 4.
        assert!(only.share > 0.1 && only.share < 0.4, "{only:?}");
        assert!(only.strength > 2.0 && only.strength < 4.0, "{only:?}");
        assert!(!only.is_common);
        // Of the units that are told as many have it as their probabilities say: to four standard deviations.
        let with: Vec<String> = (0..UNITS)
            .step_by(5)
            .map(|unit| format!("unit-{unit}"))
            .collect();
        let right = only
            .units
            .iter()
            .filter(|one| with.contains(&one.unit))
            .count();
        let expected: f64 = only.units.iter().map(|one| one.probability).sum();
        let variances = only.units.iter();
        let variances = variances.map(|one| one.probability * (1.0 - one.probability));
        let variance: f64 = variances.sum();
        assert!(
            (right as f64 - expected).abs() < 4.0 * variance.sqrt(),
            "{right} {:?}",
            only.units
        );
    }
}

#[test]
fn a_twin_is_told_as_an_alternative() {
    let found = found(&fleet(Some(("constant", 3.0, 4)), 2));
    assert_eq!(found.len(), 1, "{found:?}");
    let all: Vec<&str> = std::iter::once(&found[0].effect)
        .chain(&found[0].alternatives)
        .map(String::as_str)
        .collect();
    assert!(
        all.contains(&"constant") && all.contains(&"twin"),
        "{all:?}"
    );
}

#[test]
fn two_causes_are_both_named_and_nothing_that_looks_like_one_of_them() {
    let simulator = simulator();
    for seed in 0..3 {
        let mut draw = Draw::new(seed, 7);
        let tables: Vec<ScoreTable> = (0..UNITS)
            .map(|unit| {
                let own = match unit % 5 {
                    0 => Some(("constant", 4.0)),
                    1 => Some(("step", 4.0)),
                    _ => None,
                };
                simulator.draw(own, &mut draw).unwrap()
            })
            .collect();
        let found = found(&tables);
        assert_eq!(found.len(), 2, "{found:?}");
        for cause in ["constant", "step"] {
            let is_it = |one: &&RecurringCause| {
                one.effect == cause || one.alternatives.iter().any(|o| o == cause)
            };
            assert_eq!(found.iter().filter(is_it).count(), 1, "{cause} {found:?}");
        }
        // Each beside the other, by evidence that holds whatever depends on whatever.
        assert!(found.iter().all(|one| one.by_e_value), "{found:?}");
    }
}

#[test]
fn a_cause_with_unknown_onsets_leaves_no_second_name() {
    // Its best onset is not the true one in every unit: what is left must not be named.
    for seed in 200..210 {
        let found = found(&fleet(Some(("step", 3.0, 4)), seed));
        assert_eq!(found.len(), 1, "{seed} {found:?}");
        assert_eq!(found[0].effect, "step");
    }
}

#[test]
fn one_small_size_in_all_units_is_told_as_one() {
    // A size of half a sigma of each unit, with the same sign: 5.5 sigmas of the fleet.
    let mut tables = fleet(None, 3);
    for table in &mut tables {
        table.z[9] += 0.5;
    }
    let found = found(&tables);
    let [only] = &found[..] else {
        panic!("{found:?}")
    };
    assert_eq!((only.effect.as_str(), only.is_common), ("other-9", true));
    let (size, sigma) = (only.size.unwrap(), only.size_sigma.unwrap());
    // 0.5 over the root of a unit's information, to three of its sigmas, 1/(50 √120).
    assert!((sigma * 50.0 * (UNITS as f64).sqrt() - 1.0).abs() < 1e-6);
    assert!((size - 0.01).abs() < 3.0 * sigma, "{size} {sigma}");
}

#[test]
fn nothing_recurs_in_clean_fleets_more_often_than_is_allowed() {
    // 60 fleets at a rate of 5 %: more than 9 would be a chance of 0.1 %.
    let mut wrong = 0;
    let mut p_values = Vec::new();
    for seed in 100..160 {
        let found = found(&fleet(None, seed));
        wrong += usize::from(!found.is_empty());
        p_values.extend(found.into_iter().map(|one| one.p_value));
    }
    assert!(wrong <= 9, "{wrong} {p_values:?}");
}

#[test]
fn the_oracle_finds_more_and_keeps_its_level() {
    let names: Vec<String> = (0..UNITS).map(|unit| format!("unit-{unit}")).collect();
    let cause = Injected {
        effect: "constant",
        strength: 2.0,
        share: 0.2,
    };
    let mut draw = Draw::new(9, 9);
    let mut count = |with: bool| {
        (0..60)
            .filter(|seed| {
                let tables = fleet(with.then_some(("constant", 2.0, 5)), 1000 + seed);
                oracle_finds(&units(&names, &tables), cause, 0.05, 200, &mut draw)
            })
            .count()
    };
    let (with, without) = (count(true), count(false));
    // Level 5 % of 60: more than 9 has a chance of 0.1 %.
    assert!(without <= 9, "{without}");
    assert!(with >= 40, "{with}");
}
