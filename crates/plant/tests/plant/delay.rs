//! Dead times of inputs: hidden ones, and declared ones.

use gyrocal_answer::Answer;
use gyrocal_plant::{Extension, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting};

use crate::{loaded, record};

/// Seeds that nothing was tuned on.
const SEED: u64 = 75_000;

const ROWS: usize = 600;

/// What is found where the inputs of a plant act so many rows late.
fn diagnosed(kind: Kind, seed: u64, rows_late: f64) -> Answer {
    let setting = Setting {
        hidden: ("drive.late_rows", rows_late),
        ..Setting::random(kind, seed, ROWS)
    };
    let plant = loaded(kind);
    let found = diagnose(
        &plant,
        record(&plant, &setting),
        None,
        &SearchOptions::default(),
    );
    found.unwrap().answer
}

#[test]
fn dead_times_of_any_length_are_found_to_a_part_of_a_row() {
    // Two rows more, and the loop of the servo is no longer stable.
    let servo: &[f64] = &[0.4, 1.0, 1.7];
    let kinds = [
        (Kind::Servo, "drive.delay", servo),
        (Kind::Duffing, "u.delay", &[0.4, 1.0, 3.3, 12.7]),
    ];
    for (kind, effect, all) in kinds {
        let step_s = kind.facts().step_s;
        for (seed, rows_late) in (SEED..).zip(all.iter().copied()) {
            let answer = diagnosed(kind, seed, rows_late);
            let words = gyrocal_words::plant::all(&answer);
            let found = answer
                .findings
                .iter()
                .find(|one| one.set().any(|id| id == effect));
            let found = found.unwrap_or_else(|| panic!("{effect}, {rows_late} rows: {words:?}"));
            if found.effect != effect {
                continue;
            }
            let size = &found.parameters[0];
            let (off, sigma) = (
                (size.estimate - rows_late * step_s).abs(),
                size.sigma.unwrap(),
            );
            // Four standard deviations, and what the simulation misses of a jump within a row.
            assert!(
                off < 4.0 * sigma + 0.002 * step_s,
                "{rows_late} rows: {} ± {sigma}; {words:?}",
                size.estimate
            );
        }
    }
}

#[test]
fn a_delay_extends_the_script() {
    let answer = diagnosed(Kind::Servo, SEED + 10, 1.25);
    let extension = Extension::of(&loaded(Kind::Servo), &answer);
    let script = extension.script("plant.write()\n", "plant.py").unwrap();
    assert!(
        script.starts_with("plant.extend(\"drive.delay\", 0.02"),
        "{script}"
    );
}
