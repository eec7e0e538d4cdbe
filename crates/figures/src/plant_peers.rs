//! The diagnosis of a plant beside sparse regression (pysindy) and symbolic regression (pyoperon), on the
//! same records of a quadrotor whose states are all measured, with the same candidate terms.
//!
//! Both come from PyPI, by their hashes, into an environment of their own.

use std::collections::BTreeMap;
use std::process::Command;

use gyrocal_evaluation::Statistic;
use gyrocal_testkit::python_with;
use serde::{Deserialize, Serialize};

use crate::any_plant::hidden::{DETECTABLE, Hidden, population, settings};
use crate::any_plant::plants;
use crate::any_plant::simulated::{Kind, simulate};
use crate::harness::{Context, Error, Figure};
use crate::kernel::instructions::output;

/// Most records that are compared.
const RECORDS: usize = 40;

/// Effects of the simulator that are terms of the rates, which all methods can name.
const EFFECTS: usize = 5;

/// Our own name among the methods.
const OWN: &str = "ours";

/// The statistic that is a time.
const TIME: &str = "median time";

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
struct Ours<'a> {
    record: String,
    later: String,
    names: Vec<&'a str>,
    parameters: &'a BTreeMap<String, f64>,
    sizes: &'a BTreeMap<String, f64>,
    seconds: f64,
}

/// What a method says of a record.
#[derive(Deserialize)]
struct Said {
    names: Vec<String>,
    error: f64,
    seconds: f64,
}

/// The same figures for each method, of records of the part `simulated`.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let directory = gyrocal_testkit::workspace().join("target/figures/plant-peers");
    std::fs::create_dir_all(&directory)?;
    let place = |name: &str| directory.join(name);
    let Some(python) = python_with(&directory, include_str!("plant_peers/requirements.lock"))
    else {
        let reason = "pysindy and pyoperon cannot be had".to_owned();
        return Ok(vec![Figure::note("plant peers: not compared", reason)]);
    };
    let plants = plants()?;
    let all = context.records(&population(&plants)?)?;
    let effects = &Kind::Quadrotor.facts().effects[..EFFECTS];
    let is_compared = |one: &&Hidden| {
        one.strength >= DETECTABLE && effects.iter().any(|(id, _)| *id == one.effect)
    };
    let own = all.records.iter();
    let own = own.filter(|one| one.plant == Kind::Quadrotor as usize);
    let own = own.map(|one| &one.found).filter(is_compared);
    let own: Vec<&Hidden> = own.take(RECORDS).collect();
    let mut ours = Vec::new();
    for one in &own {
        let [record, later] = ["record", "later"].map(|name| format!("{name}-{}.csv", one.seed));
        let settings = settings(Kind::Quadrotor, one.seed);
        for (setting, name) in settings.iter().zip([&record, &later]) {
            std::fs::write(place(name), simulate(setting, None).csv(&INPUTS, &OUTPUTS))?;
        }
        ours.push(Ours {
            record,
            later,
            names: one.sets.iter().map(|set| set[0].as_str()).collect(),
            parameters: &one.parameters,
            sizes: &one.sizes,
            seconds: one.seconds,
        });
    }
    std::fs::write(place("ours.json"), serde_json::to_string(&ours)?)?;
    std::fs::write(place("peers.py"), include_str!("plant_peers/peers.py"))?;
    output(Command::new(python).arg(place("peers.py")).arg(&directory))?;
    let text = std::fs::read_to_string(place("peers.json"))?;
    let said: Vec<BTreeMap<String, Said>> = serde_json::from_str(&text)?;
    if said.len() != own.len() {
        return Err(format!("{} records were answered of {}", said.len(), own.len()).into());
    }
    let methods = [OWN, "pysindy", "pyoperon"];
    let reached = methods.map(|method| reached(method, &own, &said));
    let beside =
        (1..methods.len()).flat_map(|peer| beside(methods[peer], &reached[0], &reached[peer]));
    let noted = methods.iter().zip(&reached).flat_map(|(method, reached)| {
        reached.iter().map(move |(what, statistic)| {
            let name = format!("plant peers: {what}, {method}");
            let mut figure = Figure::of_statistic(&name, statistic, None, true);
            figure.measured += if *what == TIME { " s" } else { "" };
            figure
        })
    });
    let over = |figure: Figure| figure.over(own.len(), all.seeds.as_str());
    Ok(beside.chain(noted).map(over).collect())
}

/// What one method reached over all records; the first four are compared. A record that a method says nothing of
/// counts as one without names whose model diverges.
fn reached(
    method: &str,
    own: &[&Hidden],
    said: &[BTreeMap<String, Said>],
) -> [(&'static str, Statistic); 6] {
    let nothing = Said {
        names: Vec::new(),
        error: DIVERGED,
        seconds: f64::NAN,
    };
    let said = said.iter().map(|of| of.get(method).unwrap_or(&nothing));
    let pairs: Vec<(&Hidden, &Said)> = own.iter().copied().zip(said).collect();
    let of = |number: fn(&(&Hidden, &Said)) -> f64| pairs.iter().map(number).collect();
    let share =
        |is: &dyn Fn(&(&Hidden, &Said)) -> bool| Statistic::share(&pairs, |one| Some(is(one)));
    let first = share(&|(own, said)| said.names.first() == Some(&own.effect));
    let within = share(&|(own, said)| {
        // The set that holds the effect, or the first one.
        let holding = own.sets.iter().find(|set| set.contains(&own.effect));
        let set = holding.or(own.sets.first());
        let names = if method == OWN {
            set
        } else {
            Some(&said.names)
        };
        let mut names = names.into_iter().flatten().take(set.map_or(1, Vec::len));
        names.any(|name| *name == own.effect)
    });
    let false_terms = of(|(own, said)| {
        let terms = said.names.iter().filter(|name| **name != own.effect);
        terms.count() as f64
    });
    let error = of(|(_, said)| said.error);
    let diverged = pairs.iter().filter(|(_, said)| said.error >= DIVERGED);
    let diverged = Statistic::Value(diverged.count() as f64, pairs.len() as u64);
    let (false_terms, error) = (Statistic::Mean(false_terms), Statistic::Median(error));
    let seconds = Statistic::Median(of(|(_, said)| said.seconds));
    #[rustfmt::skip] // a table
    let all = [
        ("hidden effect is the first name", first),
        ("hidden effect within a set of equal size", within),
        ("mean number of false terms", false_terms),
        ("median error on a second record, sigma of the sensors", error),
        ("records whose model leaves the second one altogether", diverged),
        (TIME, seconds),
    ];
    all
}

/// Ours against a peer: not worse in any, better in one or more.
fn beside(
    peer: &str,
    ours: &[(&str, Statistic); 6],
    theirs: &[(&str, Statistic); 6],
) -> [Figure; 2] {
    // Advantages: positive where ours is better.
    let compared = [
        ("first name", 1.0),
        ("set", 1.0),
        ("false terms", -1.0),
        ("error", -1.0),
    ];
    let figure = |what: &str, target: &str, is: fn(f64) -> bool, wanted: bool| {
        let all = compared.iter().zip(ours.iter().zip(theirs));
        let names = all
            .filter(|((_, sign), ((_, one), (_, other)))| is(sign * (one.value() - other.value())));
        let names: Vec<&str> = names.map(|((name, _), _)| *name).collect();
        let (name, none) = (format!("plant peers: {what} than {peer}"), names.is_empty());
        let measured = if none {
            "none".to_owned()
        } else {
            names.join(", ")
        };
        Figure::told(&name, target, measured, none != wanted)
    };
    [
        figure("worse", "none", |by| by < 0.0, false),
        figure("better", "one or more", |by| by > 0.0, true),
    ]
}
