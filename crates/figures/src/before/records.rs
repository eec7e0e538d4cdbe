//! Files of records that no command makes.

use std::path::Path;

use gyrocal_evaluation::{inject_any, scenario};
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::{BREAKAGES, UnlistedEffect, UnlistedKind, large_effects};
use gyrocal_truth::plant::{Kind, Setting, simulate, with_strength};
use gyrocal_truth::units::strapdown::UnitRun;
use gyrocal_truth::{Scenario, Simulation};

use super::results::told;
use crate::any_plant::loaded;
use crate::harness::Error;

/// Makes files in the folder of a record:
///
/// - `plant PLANT SEED ROWS EFFECT STRENGTH`: `record.csv` of an example with a hidden effect of so many standard
///   deviations, one of the plant's in turn for `any`, or with `none`, and `columns.toml`;
/// - `platform NAME SEED RUN HOURS [STRENGTH|large|unlisted]...`: `NAME.csv` and `NAME.toml` of a run of the platform
///   of a seed, a row in ten minutes, with drawn effects: of the catalogue with so many standard deviations, a large
///   one, or one that the catalogue lacks;
/// - `broken SEED`: `record.csv` and `bench.toml`, one of them spoilt in a way of [`BREAKAGES`], in turn;
/// - `unit SEED ROWS RAMP`: `record.csv`, `axes.csv` and `bench.toml` of a strapdown unit, a row in five minutes,
///   with a ramp of gyro y, deg/h/day;
/// - `white SEED ROWS`: `rate.csv`, a column of white noise of unit size;
/// - any other line: what the command `gyrocal` writes.
pub(crate) fn make(line: &str, folder: &Path) -> Result<(), Error> {
    let words: Vec<&str> = line.split(' ').collect();
    match words[..] {
        ["plant", plant, seed, rows, effect, strength] => {
            let mut kinds = Kind::ALL.into_iter();
            let kind = kinds.find(|kind| kind.facts().name == plant);
            let kind = kind.ok_or_else(|| format!("`{line}`: found no plant of that name"))?;
            let mut setting = Setting::random(kind, seed.parse()?, rows.parse()?);
            let effects = kind.facts().effects;
            let drawn = (effect == "any").then(|| &effects[setting.seed as usize % effects.len()]);
            let mut named = effects.iter().filter(|(id, _)| *id == effect);
            if let Some(hidden) = named.next().or(drawn) {
                setting.hidden = *hidden;
                setting = with_strength(&setting, strength.parse()?);
            }
            plant_record(&setting, folder)
        }
        ["platform", name, seed, run, hours, ref hidden @ ..] => {
            let run = platform_run([seed.parse()?, run.parse()?], hours.parse()?, hidden)?;
            written((&run.record, &run.bench), folder, [name, name])
        }
        ["broken", seed] => {
            let seed: u64 = seed.parse()?;
            // Of one to the next of another sort: a few seeds have some of all.
            let broken = BREAKAGES[7 * seed as usize % BREAKAGES.len()].record(seed)?;
            written((&broken.record, &broken.bench), folder, ["record", "bench"])
        }
        ["unit", seed, rows, ramp] => {
            let ramp: f64 = ramp.parse()?;
            let unit = UnitRun {
                attitude_rad: [1.3, -0.7, 2.1],
                turn_rad_per_s: [0.0; 3],
                interval_s: 300.0,
                rows: rows.parse()?,
                seed: seed.parse()?,
                gyro_error: &|force, days| {
                    let [x, y, z] = force.map(|force| 0.1 * force - 0.05 * force * force);
                    [0.2 + x, -0.1 + y + ramp * days, 0.05 + z]
                },
                accel_error: &|_, _| [0.0; 3],
            };
            Ok(unit.simulate().write(folder)?)
        }
        ["white", seed, rows] => {
            /// Purpose of the stream of noise.
            const WHITE: u64 = 72;
            let (mut draw, rows) = (Draw::new(seed.parse()?, WHITE), rows.parse()?);
            let rows = (0..rows).map(|_: usize| format!("{}\n", draw.normal()));
            let text = format!("rate\n{}", rows.collect::<String>());
            Ok(std::fs::write(folder.join("rate.csv"), text)?)
        }
        _ => match told(line, folder)? {
            (0, _) => Ok(()),
            (code, [_, error]) => Err(format!("`{line}`: exit code {code}: {error}").into()),
        },
    }
}

/// A run of the platform of a seed. Runs differ in attitude and noise.
fn platform_run([seed, run]: [u64; 2], hours: f64, hidden: &[&str]) -> Result<Simulation, Error> {
    /// Purpose of the stream of effects.
    const EFFECTS: u64 = 71;
    /// Distance between the numbers of two runs.
    const RUNS: u64 = 100_000;
    let random = &mut Draw::new(seed, EFFECTS);
    let mut made = Scenario {
        interval_s: 600.0,
        duration_s: 3600.0 * hours,
        gaps_s: Vec::new(),
        ..scenario(seed)
    };
    let mut unlisted = None;
    for one in hidden {
        match *one {
            "large" => made.hidden.extend(large_effects(&made, random)),
            "unlisted" => {
                let kind = *random.one_of(&UnlistedKind::ALL);
                let mut effect = UnlistedEffect::draw(kind, &made, random)?;
                effect.size = effect.largest_size;
                unlisted = Some(effect);
            }
            strength => (made, _) = inject_any(made, strength.parse()?, random)?,
        }
    }
    let other = scenario(seed + RUNS * run);
    (made.initial, made.seed) = (other.initial, other.seed);
    Ok(match unlisted {
        Some(effect) => effect.simulate(&made)?,
        None => gyrocal_truth::simulate(&made)?,
    })
}

fn written(
    (record, bench): (&Record, &Bench),
    folder: &Path,
    [csv, toml]: [&str; 2],
) -> Result<(), Error> {
    record.write(&folder.join(format!("{csv}.csv")))?;
    Ok(bench.write(&folder.join(format!("{toml}.toml")))?)
}

fn plant_record(setting: &Setting, folder: &Path) -> Result<(), Error> {
    let plant = loaded(setting.kind)?;
    let inputs = plant.description().inputs.iter().map(|input| &*input.id);
    let outputs = plant.description().outputs.iter().map(|output| &*output.id);
    let [inputs, outputs]: [Vec<&str>; 2] = [inputs.collect(), outputs.collect()];
    let mut columns = "[time]\ncolumn = \"time_s\"\n".to_owned();
    for (title, names) in [("inputs", &inputs), ("outputs", &outputs)] {
        columns += &format!("[{title}]\n");
        columns.extend(names.iter().map(|name| format!("{name} = \"{name}\"\n")));
    }
    std::fs::write(folder.join("columns.toml"), columns)?;
    let record = simulate(setting, None).csv(&inputs, &outputs);
    Ok(std::fs::write(folder.join("record.csv"), record)?)
}
