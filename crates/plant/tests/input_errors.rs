//! Delay and play of inputs.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use gyrocal_plant::answer::{Diagnosis, Found};
use gyrocal_plant::{LoadedPlant, PlantRecord, SearchOptions, diagnose};
use gyrocal_plant_truth::{Kind, Run, Setting, simulate, with_strength};

/// Seeds that nothing was tuned on.
const SEED: u64 = 72_000;

const ROWS: usize = 600;

fn diagnosed(kind: Kind, run: Run) -> Diagnosis {
    let file = format!("../../examples/{}/plant.json", kind.facts().name);
    let plant = LoadedPlant::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap();
    let record = PlantRecord {
        time_s: run.time_s,
        inputs: run.inputs.concat(),
        outputs: run.outputs.concat(),
        ..PlantRecord::default()
    };
    let record = record.prepared(plant.description(), "simulated").unwrap();
    let diagnosed = diagnose(&plant, record, None, &SearchOptions::default());
    diagnosed.unwrap().answer
}

fn set(found: &Found) -> Vec<&str> {
    let rivals = found.rivals.iter().map(|(id, _)| id.as_str());
    rivals.chain([found.effect.as_str()]).collect()
}

#[test]
fn a_drive_that_is_logged_too_early_is_a_delay() {
    let mut run = simulate(&Setting::random(Kind::Duffing, SEED, ROWS), None);
    let step_s = run.time_s[1] - run.time_s[0];
    // Each row has the drive that acts a row later.
    run.inputs.remove(0);
    run.inputs.push(run.inputs[ROWS - 2].clone());
    let answer = diagnosed(Kind::Duffing, run);
    let found = &answer.findings[0];
    assert!(set(found).contains(&"u.delay"), "{:?}", answer.sentences());
    if found.effect == "u.delay" {
        // The second derivative of the drive, which a delay of first order lacks, is taken up in part.
        let delay_s = found.sizes[0].value;
        assert!((delay_s - step_s).abs() < 0.1 * step_s, "{delay_s}");
    }
}

#[test]
fn play_of_a_drive_under_feedback_is_found() {
    let mut setting = Setting::random(Kind::Servo, SEED + 1, ROWS);
    setting.hidden = ("drive.play", 0.02);
    let setting = with_strength(&setting, 15.0);
    let answer = diagnosed(Kind::Servo, simulate(&setting, None));
    let found = &answer.findings[0];
    assert!(
        set(found).contains(&"drive.play"),
        "{:?}",
        answer.sentences()
    );
}
