//! Files of records that no command makes.

use std::path::Path;

use gyrocal_truth::plant::{Kind, Setting, simulate, with_strength};
use gyrocal_truth::units::strapdown::UnitRun;

use super::results::ran;
use crate::any_plant::loaded;
use crate::error::Error;

/// Makes files in the folder of a record:
///
/// - `plant PLANT SEED ROWS EFFECT STRENGTH`: `record.csv` of an example with a hidden effect of so many standard
///   deviations, or with `none`, and `columns.toml`;
/// - `unit SEED ROWS RAMP`: `record.csv`, `axes.csv` and `bench.toml` of a strapdown unit, a row in five minutes,
///   with a ramp of gyro y, deg/h/day;
/// - any other line: what the command `gyrocal` writes.
pub(super) fn make(line: &str, folder: &Path) -> Result<(), Error> {
    let words: Vec<&str> = line.split(' ').collect();
    match words[..] {
        ["plant", plant, seed, rows, effect, strength] => {
            let mut kinds = Kind::ALL.into_iter();
            let kind = kinds.find(|kind| kind.facts().name == plant);
            let kind = kind.ok_or_else(|| format!("`{line}`: found no plant of that name"))?;
            let mut setting = Setting::random(kind, seed.parse()?, rows.parse()?);
            let mut effects = kind.facts().effects.iter();
            if let Some(hidden) = effects.find(|(id, _)| *id == effect) {
                setting.hidden = *hidden;
                setting = with_strength(&setting, strength.parse()?);
            }
            plant_record(&setting, folder)
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
        _ => match ran(line, folder)? {
            (0, _) => Ok(()),
            (code, error) => Err(format!("`{line}`: exit code {code}: {error}").into()),
        },
    }
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
