//! Gauges that are found and said, and weak excitation that is called none.

use std::path::{Path, PathBuf};

use gyrocal_plant::{FittedPlant, LoadedPlant, PlantRecord};
use gyrocal_plant_codegen::{derive, settings_of_a_command};

use super::prepared;
use super::simulated::{Kind, Setting, Stream, simulate};
use crate::harness::{Error, Figure};

/// Seed of the records.
const SEED: u64 = 400_000;

/// Rows of a record, and the time between them, s.
const ROWS: usize = 300;
const STEP_S: f64 = 0.2;

/// Steps of a simulation between rows.
const FINE: usize = 20;

/// Rows over which an input is held.
const HELD: usize = 10;

/// Standard deviation of the sensor.
const SIGMA: f64 = 0.01;

/// Tanks, two synthetic models and an oscillator without its drive.
pub(super) fn figure(plants: &[LoadedPlant]) -> Result<Figure, Error> {
    let [tanks, duffing] = [Kind::Tanks, Kind::Duffing].map(|kind| &plants[kind as usize]);
    let of = |kind| Setting::random(kind, SEED, ROWS);
    let level = prepared(tanks, simulate(&of(Kind::Tanks), None))?;
    let product = script("product.py")?;
    let of_product = of_rates(&product, 1, |state, input| {
        vec![2.0 * 0.4 * input - 0.5 * state[0]]
    })?;
    let compartments = script("compartments.py")?;
    let of_compartments = of_rates(&compartments, 2, |state, input| {
        let uptake = 0.5 * state[0];
        vec![0.8 * input - uptake, uptake / 2.0 - 0.2 * state[1]]
    })?;
    let still = vec![vec![0.0]; ROWS];
    let free = prepared(duffing, simulate(&of(Kind::Duffing), Some(&still)))?;
    let cases = [
        ("tanks", gauge_of(tanks, level, &["k1", "k2", "k4"])?),
        (
            "product of two gains",
            gauge_of(&product, of_product, &["a", "b"])?,
        ),
        (
            "amount without a scale",
            gauge_of(&compartments, of_compartments, &["share", "volume"])?,
        ),
        ("an input that is still", weak(duffing, free)?),
    ];
    let wrong = cases.iter().filter(|(_, right)| !right);
    let wrong: Vec<&str> = wrong.map(|(name, _)| *name).collect();
    let right = format!("{} of {}", cases.len() - wrong.len(), cases.len());
    let name =
        "any plant: gauge of tanks and of two synthetic models said, weak excitation called none";
    let figure = Figure {
        target: format!("{0} of {0}", cases.len()),
        measured: match wrong.as_slice() {
            [] => right,
            wrong => format!("{right}, not {}", wrong.join(", ")),
        },
        ..Figure::truth(name, wrong.is_empty())
    };
    Ok(figure.over(cases.len(), SEED.to_string()))
}

/// A plant that is derived from a script beside this file.
pub(super) fn script(name: &str) -> Result<LoadedPlant, Error> {
    derived(&PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src/any_plant")).join(name))
}

/// A plant that is derived from a script.
pub(crate) fn derived(path: &Path) -> Result<LoadedPlant, Error> {
    let derived = derive(path, settings_of_a_command())?;
    Ok(LoadedPlant::parse(
        &derived.program,
        &path.display().to_string(),
    )?)
}

/// A record of rates of states, the last of which is read; the input is held at random values.
fn of_rates(
    plant: &LoadedPlant,
    states: usize,
    rates: impl Fn(&[f64], f64) -> Vec<f64>,
) -> Result<PlantRecord, Error> {
    let mut random = Stream::new(SEED, 5);
    let mut state = vec![0.0; states];
    let mut run = PlantRecord::default();
    let mut input = 0.0;
    for row in 0..ROWS {
        if row % HELD == 0 {
            input = random.between(0.0, 2.0);
        }
        run.time_s.push(row as f64 * STEP_S);
        run.inputs.push(input);
        run.outputs
            .push(state[states - 1] + SIGMA * random.normal());
        let h = STEP_S / FINE as f64;
        for _ in 0..FINE {
            // Heun's rule, in steps a hundredth of the time constants.
            let here = rates(&state, input);
            let ahead: Vec<f64> = state.iter().zip(&here).map(|(x, k)| x + h * k).collect();
            let there = rates(&ahead, input);
            for ((x, a), b) in state.iter_mut().zip(&here).zip(&there) {
                *x += 0.5 * h * (a + b);
            }
        }
    }
    Ok(run.prepared(plant.description(), "simulated")?)
}

/// Whether one gauge is found, with exactly these parameters in it, and said to be one.
fn gauge_of(plant: &LoadedPlant, record: PlantRecord, expected: &[&str]) -> Result<bool, Error> {
    let (held, directions) = FittedPlant::nominal(plant, record, &[])?.to_hold()?;
    let [one] = directions.as_slice() else {
        return Ok(false);
    };
    let parameters = &plant.description().parameters;
    let is_parameter = |name: &&str| parameters.iter().any(|own| own.id == *name);
    let names = one.parts.iter().map(|part| part.name.as_str());
    let mut names: Vec<&str> = names.filter(is_parameter).collect();
    names.sort_unstable();
    Ok(one.is_gauge && names == expected && held.len() == 1)
}

/// Whether what is not determined is found and said to be no gauge.
fn weak(plant: &LoadedPlant, record: PlantRecord) -> Result<bool, Error> {
    let directions = FittedPlant::nominal(plant, record, &[])?.null_directions()?;
    Ok(!directions.is_empty() && directions.iter().all(|one| !one.is_gauge))
}
