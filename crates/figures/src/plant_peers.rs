//! The diagnosis of a plant beside sparse regression (pysindy) and symbolic regression (pyoperon), on the
//! same records of a quadrotor whose states are all measured, with the same candidate terms.
//!
//! Both come from PyPI, by their hashes, into an environment of their own; where they cannot be had,
//! nothing is compared.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use gyrocal_plant::{LoadedPlant, PlantRecord, SearchOptions, diagnose};
use gyrocal_plant_truth::{Kind, Run, Setting, Stream, simulate, strength, with_strength};
use gyrocal_statistics::{Proportion, median};
use serde::{Deserialize, Serialize};

use crate::any_plant::loaded;
use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::output;
use crate::truth::Extent;

/// Seeds that nothing was tuned on.
const SEEDS: u64 = 500_000;

/// Rows of a record.
const ROWS: usize = 600;

/// Strengths of the hidden effects, standard deviations.
const STRENGTHS: [f64; 2] = [8.0, 50.0];

/// Effects that are terms of the rates, which all methods can name.
const EFFECTS: usize = 5;

/// Names of the columns of a record.
const INPUTS: [&str; 3] = ["up", "uq", "ur"];
const OUTPUTS: [&str; 6] = [
    "angle_roll",
    "angle_pitch",
    "angle_yaw",
    "gyro_p",
    "gyro_q",
    "gyro_r",
];

/// A record and our answer, for the script.
#[derive(Serialize)]
struct Ours {
    record: String,
    later: String,
    names: Vec<String>,
    parameters: BTreeMap<String, f64>,
    sizes: BTreeMap<String, f64>,
    seconds: f64,
    #[serde(skip)]
    truth: &'static str,
    #[serde(skip)]
    set: Vec<String>,
}

/// What a method says of a record.
#[derive(Deserialize)]
struct Said {
    names: Vec<String>,
    error: f64,
    seconds: f64,
}

/// Rows of the table: the same figure for each method.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let directory = gyrocal_testkit::workspace().join("target/figures/plant-peers");
    std::fs::create_dir_all(&directory)?;
    let python = match environment(&directory) {
        Ok(python) => python,
        Err(error) => {
            let reason = format!("pysindy and pyoperon cannot be had: {error}");
            return Ok(vec![Figure::note("plant peers: not compared", reason)]);
        }
    };
    let plant = loaded(Kind::Quadrotor)?;
    let count = extent.records(40, 3);
    let ours = (SEEDS..SEEDS + count)
        .map(|seed| diagnosed(&plant, seed, &directory))
        .collect::<Result<Vec<_>, Error>>()?;
    std::fs::write(directory.join("ours.json"), serde_json::to_string(&ours)?)?;
    let script = directory.join("peers.py");
    std::fs::write(&script, include_str!("plant_peers/peers.py"))?;
    output(Command::new(python).arg(&script).arg(&directory))?;
    let text = std::fs::read_to_string(directory.join("peers.json"))?;
    let said: Vec<BTreeMap<String, Said>> = serde_json::from_str(&text)?;
    let seeds = format!("{SEEDS} to {}", SEEDS + count - 1);
    Ok(["ours", "pysindy", "pyoperon"]
        .iter()
        .flat_map(|method| of_method(method, &ours, &said, &seeds))
        .collect())
}

fn environment(directory: &Path) -> Result<PathBuf, Error> {
    let environment = directory.join("env");
    let python = environment.join("bin/python");
    let done = environment.join("complete");
    if !done.is_file() {
        let lock = directory.join("requirements.lock");
        std::fs::write(&lock, include_str!("plant_peers/requirements.lock"))?;
        output(
            Command::new("python3")
                .args(["-m", "venv"])
                .arg(&environment),
        )?;
        let mut install = Command::new(&python);
        install.args([
            "-m",
            "pip",
            "install",
            "--quiet",
            "--disable-pip-version-check",
        ]);
        output(
            install
                .args(["--require-hashes", "--requirement"])
                .arg(lock),
        )?;
        std::fs::write(done, "")?;
    }
    Ok(python)
}

fn record(plant: &LoadedPlant, run: &Run) -> Result<PlantRecord, Error> {
    let record = PlantRecord {
        time_s: run.time_s.clone(),
        inputs: run.inputs.concat(),
        outputs: run.outputs.concat(),
        ..PlantRecord::default()
    };
    Ok(record.prepared(plant.description(), "simulated")?)
}

/// Simulates and diagnoses a record; writes it and a later one.
fn diagnosed(plant: &LoadedPlant, seed: u64, directory: &Path) -> Result<Ours, Error> {
    let mut setting = Setting::random(Kind::Quadrotor, seed, ROWS);
    setting.hidden = Kind::Quadrotor.facts().effects[seed as usize % EFFECTS];
    let wanted = Stream::new(seed, 9).log_between(STRENGTHS[0], STRENGTHS[1]);
    let setting = with_strength(&setting, wanted);
    if strength(&setting) < STRENGTHS[0] / 2.0 {
        return Err(format!("record {seed} has no effect of the wanted strength").into());
    }
    let later = Setting {
        seed: seed + 10_000_000,
        initial: Setting::random(Kind::Quadrotor, seed + 10_000_000, ROWS).initial,
        ..setting.clone()
    };
    let runs = [&setting, &later].map(|setting| simulate(setting, None));
    let names = ["record", "later"].map(|name| format!("{name}-{seed}.csv"));
    for (run, name) in runs.iter().zip(&names) {
        std::fs::write(directory.join(name), run.csv(&INPUTS, &OUTPUTS))?;
    }
    let began = Instant::now();
    let first = record(plant, &runs[0])?;
    let answer = diagnose(plant, first, None, &SearchOptions::default())?.answer;
    let seconds = began.elapsed().as_secs_f64();
    let [record, later] = names;
    let truth = setting.hidden.0;
    let holding = answer
        .findings
        .iter()
        .find(|found| found.effect == truth || found.rivals.iter().any(|(id, _)| id == truth));
    let set = holding.or(answer.findings.first()).map(|found| {
        let rivals = found.rivals.iter().map(|(id, _)| id.clone());
        core::iter::once(found.effect.clone())
            .chain(rivals)
            .collect()
    });
    let sizes = answer.findings.iter().filter_map(|found| {
        let size = found.sizes.first()?;
        Some((found.effect.clone(), size.value))
    });
    let parameters = answer.parameters.iter();
    Ok(Ours {
        record,
        later,
        names: answer
            .findings
            .iter()
            .map(|one| one.effect.clone())
            .collect(),
        parameters: parameters
            .map(|one| (one.name.clone(), one.value))
            .collect(),
        sizes: sizes.collect(),
        seconds,
        truth,
        set: set.unwrap_or_default(),
    })
}

fn of_method(
    method: &str,
    ours: &[Ours],
    said: &[BTreeMap<String, Said>],
    seeds: &str,
) -> Vec<Figure> {
    let pairs: Vec<(&Ours, &Said)> = ours
        .iter()
        .zip(said)
        .filter_map(|(own, said)| Some((own, said.get(method)?)))
        .collect();
    let is_first =
        |(own, said): &(&Ours, &Said)| said.names.first().is_some_and(|name| name == own.truth);
    // As many names as our set has.
    let is_within = |(own, said): &(&Ours, &Said)| {
        if method == "ours" {
            own.set.iter().any(|name| name == own.truth)
        } else {
            said.names
                .iter()
                .take(own.set.len().max(1))
                .any(|name| name == own.truth)
        }
    };
    let first = Proportion::of(pairs.iter().map(is_first));
    let within = Proportion::of(pairs.iter().map(is_within));
    let false_terms = pairs.iter().map(|(own, said)| {
        let wrong = said.names.iter().filter(|name| {
            let in_set = method == "ours" && own.set.contains(name);
            **name != own.truth && !in_set
        });
        wrong.count() as f64
    });
    let mean = false_terms.sum::<f64>() / pairs.len().max(1) as f64;
    let middle = |of: fn(&Said) -> f64| {
        let values: Vec<f64> = pairs.iter().map(|(_, said)| of(said)).collect();
        median(&values)
    };
    let note = |what: &str, measured: String| {
        Figure::note(&format!("plant peers: {what}, {method}"), measured).over(pairs.len(), seeds)
    };
    let share = |what: &str, share| {
        Figure::note_share(&format!("plant peers: {what}, {method}"), share, seeds)
    };
    vec![
        share("truth is the first name", first),
        share("truth within a set of equal size", within),
        note("mean number of false terms", format!("{mean:.2}")),
        note(
            "median error on a second record, sigma of the sensors",
            format!("{:.3}", middle(|said| said.error)),
        ),
        note(
            "median time",
            format!("{:.2} s", middle(|said| said.seconds)),
        ),
    ]
}
