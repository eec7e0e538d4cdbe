//! The oscillator of `examples/duffing`: records of an independent simulator, effects hidden there.

use std::path::PathBuf;

use gyrocal_answer::write_text;
use gyrocal_plant::{ColumnMap, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting, simulate};

use crate::{loaded, oscillator, record};

fn example(file: &str) -> PathBuf {
    crate::example(Kind::Duffing, file)
}

#[test]
fn the_records_of_the_example_are_those_of_the_simulator() {
    let files = [("record.csv", 41), ("later.csv", 42)];
    for (file, seed) in files {
        let text =
            simulate(&oscillator(seed, 800, -0.05), None).csv(&["drive_n"], &["displacement_m"]);
        if std::env::var_os("GYROCAL_WRITE_EXAMPLES").is_some() {
            std::fs::write(example(file), &text).unwrap();
        }
        let committed = std::fs::read_to_string(example(file)).unwrap();
        assert!(
            committed == text,
            "{file}: GYROCAL_WRITE_EXAMPLES=1 writes it anew"
        );
    }
}

#[test]
fn the_example_names_its_hidden_effect_and_gains_on_the_later_record() {
    let plant = loaded(Kind::Duffing);
    let columns = ColumnMap::read(&example("columns.toml")).unwrap();
    let read = |file| columns.record(plant.description(), &example(file)).unwrap();
    let diagnosed = diagnose(
        &plant,
        read("record.csv"),
        Some(read("later.csv")),
        &SearchOptions::default(),
    );
    let answer = diagnosed.unwrap().answer;
    write_text(&answer).unwrap();
    assert_eq!(
        answer.findings.len(),
        1,
        "{:?}",
        gyrocal_words::plant::all(&answer)
    );
    let found = &answer.findings[0];
    assert!(found.set().any(|id| id == "v_rate.x^3"), "{found:?}");
    let size = &found.parameters[0];
    // Four standard deviations.
    assert!(
        (size.estimate + 0.05).abs() < 4.0 * size.sigma.unwrap(),
        "{size:?}"
    );
    assert_eq!(answer.later_record.unwrap().rows, 800);
    let later = answer.gain.unwrap().validation.unwrap();
    assert!(later.log_score_nats > 3.0, "{later:?}");
    // The noise of the sensor is left, 0.01 m, and with it at most a tenth more.
    assert!(later.open_loop[0].extended.unwrap() < 0.011, "{later:?}");
    assert!(
        later.open_loop[0].nominal.unwrap() > 1.5 * later.open_loop[0].extended.unwrap(),
        "{later:?}"
    );
}

#[test]
fn a_clean_record_with_misdeclared_noise_has_no_finding() {
    let plant = loaded(Kind::Duffing);
    for (seed, noise) in [(501, 0.5), (502, 2.0)] {
        let setting = Setting {
            noise,
            ..Setting::random(Kind::Duffing, seed, 800)
        };
        let record = record(&plant, &setting);
        let answer = diagnose(&plant, record, None, &SearchOptions::default())
            .unwrap()
            .answer;
        assert!(
            answer.findings.is_empty(),
            "{:?}",
            gyrocal_words::plant::all(&answer)
        );
        assert!(
            answer.remainder.unmodelled.is_empty(),
            "{:?}",
            gyrocal_words::plant::all(&answer)
        );
        let ratio = answer.noise[0].ratio;
        // Four standard deviations of the noise of 800 values.
        assert!((ratio / noise - 1.0).abs() < 0.1, "{ratio}");
    }
}

#[test]
fn a_sensor_gain_is_taken_up_by_the_gain_of_the_drive() {
    let plant = loaded(Kind::Duffing);
    let record = record(&plant, &oscillator(7, 800, -0.05));
    let answer = diagnose(&plant, record, None, &SearchOptions::default())
        .unwrap()
        .answer;
    let gain = answer
        .not_searched
        .iter()
        .find(|one| one.effect == "y.gain");
    assert!(
        gain.is_some_and(|one| one.why.contains('g')),
        "{:?}",
        answer.not_searched
    );
}
