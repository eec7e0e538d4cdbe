//! The diagnosis of a plant beside sparse regression (pysindy) and symbolic regression (pyoperon), on the
//! same records of a quadrotor whose states are all measured, with the same candidate terms.
//!
//! Both come from PyPI, by their hashes, into an environment of their own.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use gyrocal_plant::{LoadedPlant, SearchOptions, diagnose};
use gyrocal_statistics::{Proportion, median};
use gyrocal_testkit::python_with;
use gyrocal_truth::plant::{Kind, Setting, Stream, simulate, strength, with_strength};
use serde::{Deserialize, Serialize};

use crate::any_plant::{loaded, prepared};
use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::output;
use crate::truth::Extent;

/// Seeds that nothing was tuned on.
const SEEDS: u64 = 640_000;

/// Rows of a record.
const ROWS: usize = 600;

/// Strengths of the hidden effects, standard deviations.
const STRENGTHS: [f64; 2] = [8.0, 50.0];

/// Effects that are terms of the rates, which all methods can name.
const EFFECTS: usize = 5;

/// The name of our own row.
const OWN: &str = "ours";

/// Error of a model that leaves a record altogether, standard deviations of the sensors, as the script
/// writes it.
const DIVERGED: f64 = 1e9;

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
    let Some(python) = python_with(&directory, include_str!("plant_peers/requirements.lock"))
    else {
        let reason = "pysindy and pyoperon cannot be had".to_owned();
        return Ok(vec![Figure::note("plant peers: not compared", reason)]);
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
    if said.len() != ours.len() {
        return Err(format!("{} records were answered of {}", said.len(), ours.len()).into());
    }
    let seeds = format!("{SEEDS} to {}", SEEDS + count - 1);
    let [own, peers @ ..] =
        &[OWN, "pysindy", "pyoperon"].map(|method| Row::new(method, &ours, &said));
    let judged = peers.iter().flat_map(|peer| own.beside(peer, &seeds));
    let noted = core::iter::once(own).chain(peers);
    let noted = noted.flat_map(|row| row.figures(&seeds));
    Ok(judged.chain(noted).collect())
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
    let first = prepared(plant, runs[0].clone())?;
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

/// What one method reached over all records.
struct Row {
    method: &'static str,
    /// Records whose hidden effect is the first name.
    first: Proportion,
    /// Records whose hidden effect is among as many first names as our set has.
    within: Proportion,
    /// Names that are not the hidden effect, for each record.
    wrong: f64,
    /// Median over records of the error on a second record, standard deviations of the sensors.
    error: f64,
    /// Records whose model leaves the second record altogether.
    diverged: usize,
    /// Median time of a record, s.
    seconds: f64,
}

impl Row {
    /// A record that a method says nothing of counts as one without names whose model diverges.
    fn new(method: &'static str, ours: &[Ours], said: &[BTreeMap<String, Said>]) -> Self {
        let nothing = Said {
            names: Vec::new(),
            error: DIVERGED,
            seconds: f64::NAN,
        };
        let said = said.iter().map(|of| of.get(method).unwrap_or(&nothing));
        let pairs: Vec<(&Ours, &Said)> = ours.iter().zip(said).collect();
        let is_within = |(own, said): &(&Ours, &Said)| {
            let names = if method == OWN { &own.set } else { &said.names };
            let mut names = names.iter().take(own.set.len().max(1));
            names.any(|name| name == own.truth)
        };
        let wrong = pairs.iter().map(|(own, said)| {
            let names = said.names.iter();
            names.filter(|name| *name != own.truth).count() as f64
        });
        let middle = |of: fn(&Said) -> f64| {
            median(&pairs.iter().map(|(_, said)| of(said)).collect::<Vec<_>>())
        };
        let first = pairs.iter().map(|(own, said)| {
            let first = said.names.first();
            first.is_some_and(|name| name == own.truth)
        });
        Self {
            method,
            first: Proportion::of(first),
            within: Proportion::of(pairs.iter().map(is_within)),
            wrong: wrong.sum::<f64>() / pairs.len().max(1) as f64,
            error: middle(|said| said.error),
            diverged: pairs
                .iter()
                .filter(|(_, said)| said.error >= DIVERGED)
                .count(),
            seconds: middle(|said| said.seconds),
        }
    }

    /// Advantages over another method: positive where this one is better.
    fn advantages(&self, other: &Self) -> [(&'static str, f64); 4] {
        [
            ("first name", self.first.share() - other.first.share()),
            ("set", self.within.share() - other.within.share()),
            ("false terms", other.wrong - self.wrong),
            ("error", other.error - self.error),
        ]
    }

    /// Not worse in any, better in one or more.
    fn beside(&self, other: &Self, seeds: &str) -> Vec<Figure> {
        let advantages = self.advantages(other);
        let of = |is: fn(f64) -> bool| {
            let names = advantages.iter().filter(|(_, by)| is(*by));
            let names: Vec<&str> = names.map(|(name, _)| *name).collect();
            match names.as_slice() {
                [] => "none".to_owned(),
                names => names.join(", "),
            }
        };
        let is_not_worse = advantages.iter().all(|(_, by)| *by >= 0.0);
        let is_better = advantages.iter().any(|(_, by)| *by > 0.0);
        let figure = |what: &str, target: &str, measured, holds| Figure {
            target: target.to_owned(),
            measured,
            ..Figure::truth(&format!("plant peers: {what} than {}", other.method), holds)
        };
        let runs = self.first.trials as usize;
        vec![
            figure("worse", "none", of(|by| by < 0.0), is_not_worse).over(runs, seeds),
            figure("better", "one or more", of(|by| by > 0.0), is_better).over(runs, seeds),
        ]
    }

    fn figures(&self, seeds: &str) -> Vec<Figure> {
        let name = |what: &str| format!("plant peers: {what}, {}", self.method);
        let note = |what: &str, measured| {
            Figure::note(&name(what), measured).over(self.first.trials as usize, seeds)
        };
        let share = |what: &str, share| Figure::note_share(&name(what), share, seeds);
        vec![
            share("hidden effect is the first name", self.first),
            share("hidden effect within a set of equal size", self.within),
            note("mean number of false terms", format!("{:.2}", self.wrong)),
            note(
                "median error on a second record, sigma of the sensors",
                format!("{:.4}", self.error),
            ),
            note(
                "records whose model leaves the second one altogether",
                self.diverged.to_string(),
            ),
            note("median time", format!("{:.2} s", self.seconds)),
        ]
    }
}
