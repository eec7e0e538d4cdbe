//! Tests of the library in one program: to compile and link one for each file would take most of their time.
#![cfg(test)]

mod coloured;
mod delay;
mod duffing;
mod fit;
mod gauge;
mod generated;
mod input_errors;
mod knee;
mod left_out;
mod next_run;
mod population;
mod several;

use std::path::{Path, PathBuf};

use gyrocal_plant::{LoadedPlant, PlantRecord};
use gyrocal_truth::plant::{Kind, Run, Setting, simulate};

/// A file of an example.
fn example(kind: Kind, file: &str) -> PathBuf {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    examples.join(kind.facts().name).join(file)
}

fn loaded(kind: Kind) -> LoadedPlant {
    LoadedPlant::read(&example(kind, "plant.json")).unwrap()
}

/// The oscillator of the example, with a spring that softens by a size.
fn oscillator(seed: u64, rows: usize, size: f64) -> Setting {
    Setting {
        parameters: vec![4.6, 0.27, 1.1],
        initial: vec![0.2, -0.4],
        hidden: ("v_rate.x^3", size),
        ..Setting::random(Kind::Duffing, seed, rows)
    }
}

fn record(plant: &LoadedPlant, setting: &Setting) -> PlantRecord {
    prepared(plant, simulate(setting, None))
}

/// A simulated record as its plant takes it.
fn prepared(plant: &LoadedPlant, run: Run) -> PlantRecord {
    let record = PlantRecord {
        time_s: run.time_s,
        inputs: run.inputs.concat(),
        outputs: run.outputs.concat(),
        ..PlantRecord::default()
    };
    record.prepared(plant.description(), "simulated").unwrap()
}
