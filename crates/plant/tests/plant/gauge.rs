//! Gauges, weak excitation, and inputs that are refused in words.

use gyrocal_answer::write_text;
use gyrocal_plant::{ColumnMap, FittedPlant, LoadedPlant, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting, simulate};
use serde_json::Value;

use crate::{example, loaded, record};

#[test]
fn the_scale_of_the_unmeasured_tank_is_a_gauge() {
    let plant = loaded(Kind::Tanks);
    let setting = Setting::random(Kind::Tanks, 3, 300);
    let fit = FittedPlant::nominal(&plant, record(&plant, &setting), &[]).unwrap();
    let (held, directions) = fit.to_hold().unwrap();
    assert_eq!(directions.len(), 1, "{directions:?}");
    assert!(directions[0].is_gauge, "{directions:?}");
    assert_eq!(held.len(), 1);
    // Outflow of the upper tank, pump and inflow of the lower one take the scale of the level.
    let names: Vec<&str> = directions[0]
        .parts
        .iter()
        .map(|part| part.name.as_str())
        .collect();
    for name in ["k1", "k2", "k4"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(gyrocal_words::plant::direction(&directions[0]).starts_with("No record"));
}

/// A plant of which nothing is said of its initial states before a record.
fn without_sigmas(kind: Kind) -> LoadedPlant {
    let text = std::fs::read_to_string(example(kind, "plant.json")).unwrap();
    let mut program: Value = serde_json::from_str(&text).unwrap();
    let tables = program["tables"].as_array_mut().unwrap();
    let states = tables
        .iter_mut()
        .find(|table| table["name"] == "plant_states");
    for row in states.unwrap()["rows"].as_array_mut().unwrap() {
        // The last column, as the declaration writes it where `sigma` is left out.
        *row.as_array_mut().unwrap().last_mut().unwrap() = Value::from(0.0);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plant.json");
    std::fs::write(&path, program.to_string()).unwrap();
    LoadedPlant::read(&path).unwrap()
}

/// Without standard deviations of the states nothing bounds the gauge: a solver that inverts the information stops.
#[test]
fn a_gauge_is_held_where_nothing_is_known_of_the_states() {
    let plant = without_sigmas(Kind::Tanks);
    let bounded = loaded(Kind::Tanks);
    for seed in 3..6 {
        let setting = Setting::random(Kind::Tanks, seed, 300);
        let record = record(&plant, &setting);
        let fit = FittedPlant::nominal(&plant, record.clone(), &[]).unwrap();
        let (held, directions) = fit.to_hold().unwrap();
        assert_eq!((held.len(), directions.len()), (1, 1), "{directions:?}");
        assert!(directions[0].is_gauge, "{directions:?}");
        let own = FittedPlant::nominal(&plant, record.clone(), &held).unwrap();
        let known = FittedPlant::nominal(&bounded, record, &held).unwrap();
        // With the gauge held, priors of a metre change the fit by little.
        let more = own.deviance() - known.deviance();
        assert!((-3.0..0.5).contains(&more), "{seed}: {more}");
    }
}

#[test]
fn an_input_that_never_moves_is_weak_excitation_and_no_gauge() {
    let plant = loaded(Kind::Duffing);
    let mut still = record(&plant, &Setting::random(Kind::Duffing, 4, 300));
    // A free oscillation: the drive is off.
    let inputs = vec![vec![0.0]; still.len() + 1];
    let run = simulate(&Setting::random(Kind::Duffing, 4, 300), Some(&inputs));
    still.inputs.fill(0.0);
    still.outputs = run.outputs.concat();
    assert_eq!(still.still_inputs(plant.description()), ["u"]);
    let fit = FittedPlant::nominal(&plant, still.clone(), &[]).unwrap();
    let directions = fit.null_directions().unwrap();
    assert_eq!(directions.len(), 1, "{directions:?}");
    assert!(!directions[0].is_gauge, "{directions:?}");
    assert_eq!(directions[0].parts[0].name, "g");
    let options = SearchOptions::default();
    let answer = diagnose(&plant, still, None, &options).unwrap().answer;
    assert!(answer.undetermined[0].held.is_some());
    write_text(&answer).unwrap();
    let sentences = gyrocal_words::plant::all(&answer);
    for words in [
        "Input u never moves in this record",
        "with another input it would",
    ] {
        let says = |sentence: &String| sentence.contains(words);
        assert!(sentences.iter().any(says), "{words}: {sentences:?}");
    }
}

#[test]
fn a_driven_oscillator_has_neither() {
    let plant = loaded(Kind::Duffing);
    let setting = Setting::random(Kind::Duffing, 5, 300);
    let fit = FittedPlant::nominal(&plant, record(&plant, &setting), &[]).unwrap();
    assert_eq!(fit.null_directions().unwrap(), []);
}

#[test]
fn a_missing_column_is_told_with_those_that_are_there() {
    let plant = loaded(Kind::Servo);
    let directory = std::env::temp_dir().join(format!("gyrocal-plant-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let (map, data) = (directory.join("map.toml"), directory.join("data.csv"));
    let text = "[time]\ncolumn = \"t\"\n[inputs]\ndrive = \"volt\"\n[outputs]\ny = \"angle\"\n";
    std::fs::write(&map, text).unwrap();
    std::fs::write(&data, "t,volts,angle\n0,1,2\n").unwrap();
    let columns = ColumnMap::read(&map).unwrap();
    let error = columns
        .record(plant.description(), &data)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("the column `volt` for input `drive`"),
        "{error}"
    );
    assert!(error.contains("the file has t, volts, angle"), "{error}");
    std::fs::remove_dir_all(&directory).unwrap();
}
