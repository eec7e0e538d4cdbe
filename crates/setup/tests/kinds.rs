//! Every breakage is told by a finding of its kind, or of one that no record tells from it.
#![cfg(test)]

use gyrocal_record::{Bench, Gravity, Record};
use gyrocal_setup::{SetupCheck, SetupKind, check_setup};
use gyrocal_truth::faults::{BREAKAGES, Breakage, Broken, sound};

/// First of the seeds; each breakage has its own thousand.
const FIRST_SEED: u64 = 2_100_000;

/// Records of a breakage. `cargo figures diagnosis` has more.
const RECORDS: u64 = 20;

fn is_right(breakage: &Breakage, check: &SetupCheck) -> bool {
    let is_named = |name: &str| breakage.kinds.contains(&name);
    !check.findings.is_empty()
        && check.findings.iter().all(|finding| {
            let mut kinds = core::iter::once(finding.kind).chain(finding.equivalent_kinds.clone());
            kinds.any(|kind| is_named(kind.as_str()))
        })
}

#[test]
fn gross_errors_are_told_and_nothing_beside() {
    let (mut right, mut all) = (0, 0);
    for (index, breakage) in BREAKAGES.iter().enumerate() {
        let first = FIRST_SEED + 1000 * index as u64;
        let missed: Vec<u64> = (first..first + RECORDS)
            .filter(|seed| {
                let broken = breakage.record(*seed).unwrap();
                !is_right(breakage, &check_setup(&broken.record, &broken.bench))
            })
            .collect();
        // 17 of 20 is the target of the worst kind.
        assert!(missed.len() <= 3, "{}: missed {missed:?}", breakage.name);
        right += RECORDS - missed.len() as u64;
        all += RECORDS;
    }
    // 98 % is the target over all.
    assert!(right as f64 >= 0.98 * all as f64, "{right} of {all}");
}

fn broken(first: &str, second: &str, seed: u64) -> Broken {
    let of = |name: &str| {
        let found = BREAKAGES.iter().find(|breakage| breakage.name == name);
        found.unwrap_or_else(|| panic!("no breakage {name}"))
    };
    let mut broken = of(first).record(seed).unwrap();
    of(second).spoil(&mut broken);
    broken
}

#[test]
fn two_errors_at_once_are_told_both_or_the_one_that_stops() {
    // What can be mended, in the order of the tests.
    for (first, second, kinds) in [
        (
            "0 in one column",
            "a jump of the attitude",
            ["missing-coded", "jump"],
        ),
        ("stuck for hours", "a common scale", ["stuck", "gravity"]),
        (
            "the logger hangs",
            "the gain of one axis",
            ["repeated", "scale"],
        ),
        (
            "a jump of the attitude",
            "the gain of one axis",
            ["scale", "jump"],
        ),
        (
            "-999 in all columns",
            "latitude negated",
            ["missing-coded", "latitude"],
        ),
        ("clipped", "angles left at zero", ["clipped", "attitude"]),
        (
            "a block over later rows",
            "standard g at another site",
            ["duplicated", "gravity"],
        ),
        // Wrong axes or a wrong latitude stop, and leave magnitudes as they are.
        (
            "two axes exchanged",
            "standard g at another site",
            ["axes", "gravity"],
        ),
        (
            "latitude negated, no angles",
            "a common scale",
            ["handedness", "gravity"],
        ),
    ] {
        for seed in [2_170_000, 2_170_002, 2_170_004] {
            let broken = broken(first, second, seed);
            let check = check_setup(&broken.record, &broken.bench);
            let told: Vec<&str> = check.findings.iter().map(|f| f.kind.as_str()).collect();
            // An error that stops hides what would come after it.
            let stopped = check.usable.is_none();
            let expected = if stopped && told.len() == 1 {
                &kinds[..1]
            } else {
                &kinds[..]
            };
            assert_eq!(told, expected, "{first} and {second}, seed {seed}");
        }
    }
}

#[test]
fn what_can_be_mended_is_mended_beside_an_error_that_stops() {
    let broken = broken(
        "two axes exchanged",
        "standard g at another site",
        2_178_000,
    );
    let check = check_setup(&broken.record, &broken.bench);
    assert!(check.usable.is_none());
    let mended = check.mended.unwrap_or_else(|| panic!("a mended record"));
    let mean = |record: &Record| {
        let squares = record
            .accel_g
            .iter()
            .map(|row| row.iter().map(|x| x * x).sum::<f64>());
        (squares.sum::<f64>() / record.len() as f64).sqrt()
    };
    let rest = broken.bench.gravity.map_or(1.0, |gravity| gravity.ratio());
    // A tenth of what is taken for gravity.
    assert!(
        (mean(&mended) / rest - 1.0).abs() < 5e-6,
        "{}",
        mean(&mended)
    );
    assert!((mean(&broken.record) / rest - 1.0).abs() > 5e-5);
}

#[test]
fn what_stops_is_not_said_to_be_left_out() {
    let text = |name: &str| {
        let breakage = BREAKAGES.iter().find(|breakage| breakage.name == name);
        let broken = breakage.map(|breakage| breakage.record(2_176_000).unwrap());
        let broken = broken.unwrap_or_else(|| panic!("no breakage {name}"));
        let check = check_setup(&broken.record, &broken.bench);
        (
            check.findings[0].stops,
            check.findings[0].problem().description,
        )
    };
    let (stops, words) = text("stuck from the middle on");
    assert!(
        stops && words.contains("Where more than 20 % are lost"),
        "{words}"
    );
    assert!(!words.contains("left out"), "{words}");
    let (stops, words) = text("stuck for hours");
    assert!(!stops && words.contains("left out"), "{words}");
}

#[test]
fn keys_that_a_description_names_are_those_of_a_bench_file() {
    let breakage = BREAKAGES
        .iter()
        .find(|one| one.name == "standard g at another site");
    let broken = breakage.map(|breakage| breakage.record(2_177_000).unwrap());
    let broken = broken.unwrap_or_else(|| panic!("a breakage"));
    let check = check_setup(&broken.record, &broken.bench);
    let words = check.findings[0].problem().description;
    let named = words.split(|letter: char| !(letter.is_alphanumeric() || letter == '_'));
    let keys: Vec<&str> = named.filter(|word| word.contains('_')).collect();
    assert_eq!(keys, Gravity::KEYS, "{words}");
}

#[test]
fn what_is_mended_is_left_out_and_the_rest_stays() {
    let breakage = |name| BREAKAGES.iter().find(|breakage| breakage.name == name);
    let broken = breakage("0 in one column").map(|b| b.record(2_175_000).unwrap());
    let broken = broken.unwrap_or_else(|| panic!("a breakage"));
    let usable = check_setup(&broken.record, &broken.bench).usable;
    let usable = usable.unwrap_or_else(|| panic!("a usable record"));
    let pairs = usable.accel_g.iter().zip(&broken.record.accel_g);
    for (left, given) in pairs.flat_map(|(a, b)| a.iter().zip(b)) {
        assert!(if *given == 0.0 {
            left.is_nan()
        } else {
            left == given
        });
    }
    let broken = breakage("a jump of the attitude").map(|b| b.record(2_175_000).unwrap());
    let broken = broken.unwrap_or_else(|| panic!("a breakage"));
    let check = check_setup(&broken.record, &broken.bench);
    let rows = check.findings[0].rows.clone().unwrap_or_default();
    assert_eq!(rows.end, broken.record.len());
    assert_eq!(check.usable.map_or(0, |usable| usable.len()), rows.start);
}

/// Kinds of what a check tells.
fn kinds(record: &Record, bench: &Bench) -> Vec<SetupKind> {
    let findings = check_setup(record, bench).findings;
    findings.iter().map(|finding| finding.kind).collect()
}

/// Gravity turns by many steps of a converter between all rows of a short record.
#[test]
fn a_stuck_accelerometer_is_told_in_a_short_record() {
    let simulation = sound(2_175_100).unwrap();
    for rows in [30, 100, 145, 300] {
        for axis in 0..3 {
            let mut record = Record {
                time_s: simulation.record.time_s[..rows].to_vec(),
                accel_g: simulation.record.accel_g[..rows].to_vec(),
                temperature_c: None,
            };
            // One axis may hardly move for some hours.
            let first = record.accel_g[0][axis];
            let moves = record.accel_g.iter().map(|row| (row[axis] - first).abs());
            if moves.fold(0.0, f64::max) < 0.05 {
                continue;
            }
            for row in &mut record.accel_g {
                row[axis] = first;
            }
            let told = kinds(&record, &simulation.bench);
            assert_eq!(told, [SetupKind::Stuck], "{rows} rows, axis {axis}");
        }
    }
}

#[test]
fn rows_that_are_all_written_twice_are_told_from_the_first_on() {
    let mut simulation = sound(2_175_101).unwrap();
    let record = &mut simulation.record;
    for row in (1..record.len()).step_by(2) {
        record.accel_g[row] = record.accel_g[row - 1];
    }
    let check = check_setup(record, &simulation.bench);
    let told: Vec<SetupKind> = check.findings.iter().map(|finding| finding.kind).collect();
    assert_eq!(told, [SetupKind::Repeated]);
    let usable = check.usable.unwrap_or_else(|| panic!("a usable record"));
    assert!(usable.accel_g[1][0].is_nan() && !usable.accel_g[0][0].is_nan());
}
