//! Fits where nothing is known of the states before a record, and parameters are declared wrong.

use gyrocal_plant::{FittedPlant, LoadedPlant};
use serde::{Deserialize, Serialize};

use super::hidden::settings;
use super::simulated::{Kind, Setting, Stream, simulate};
use super::{Of, ROWS, by_kind, far_start, in_turn, prepared, program};
use crate::harness::{Context, Error, Figure, Row};

/// Seed of the records; no constant was tuned on them.
const UNKNOWN: u64 = 660_000;

/// Cost over that of the fit from the true order of magnitude, with what is known of the states, up to which it is
/// the same fit.
const SAME_COST: f64 = 1.002;

/// How a fit ended.
#[derive(Clone, Serialize, Deserialize)]
struct Ended {
    /// Whether the record has an effect that the model lacks.
    is_wrong: bool,
    /// Whether the best fit was reached, directions without information held.
    is_best: bool,
    /// Why there is none.
    reason: Option<String>,
}

/// Records of all plants, each second one with a hidden effect.
pub(super) fn figures(context: &Context, plants: &[LoadedPlant]) -> Result<Vec<Figure>, Error> {
    let bare = Kind::ALL.map(without_sigmas);
    let bare = bare.into_iter().collect::<Result<Vec<_>, Error>>()?;
    let population = in_turn(
        "unknown states",
        &Kind::ALL,
        [UNKNOWN, 200, 2],
        |kind, seed| {
            let is_wrong = seed % 2 == 1;
            let setting = if is_wrong {
                settings(kind, seed)[0].clone()
            } else {
                Setting::random(kind, seed, ROWS)
            };
            let (known, plant) = (&plants[kind as usize], &bare[kind as usize]);
            let record = prepared(known, simulate(&setting, None))?;
            let (held, _) = FittedPlant::nominal(known, record.clone(), &[])?.to_hold()?;
            let best = FittedPlant::nominal(known, record.clone(), &held)?.deviance();
            let first = far_start(plant, Stream::new(seed, 4));
            let fit = FittedPlant::nominal_from(plant, record.clone(), &[], Some(&first));
            let fit = fit.and_then(|fit| {
                let (held, _) = fit.to_hold()?;
                if held.is_empty() {
                    return Ok(fit);
                }
                FittedPlant::nominal_from(plant, record, &held, Some(&first))
            });
            Ok(Ended {
                is_wrong,
                is_best: fit
                    .as_ref()
                    .is_ok_and(|fit| fit.deviance() < SAME_COST * best),
                reason: fit.err().map(|error| error.to_string()),
            })
        },
    );
    let name = "any plant: nothing known of the states, parameters within a factor of 3: the best fit reached";
    let mut rows = vec![
        Row::share(name, |one: &Of<Ended>| Some(one.found.is_best)).at_least(
            0.99,
            "of records of five plants, each second with an effect that the model lacks",
        ),
        Row::share("... of them any fit", |one: &Of<Ended>| {
            Some(one.found.reason.is_none())
        }),
        Row::share("... of records with a hidden effect", |one: &Of<Ended>| {
            one.found.is_wrong.then_some(one.found.is_best)
        }),
    ];
    rows.extend(by_kind("... of", |found: &Ended| found.is_best));
    context.measure(&population, &rows)
}

/// An example plant whose states have no standard deviation before a record.
fn without_sigmas(kind: Kind) -> Result<LoadedPlant, Error> {
    let text = std::fs::read_to_string(program(kind))?;
    let mut program: serde_json::Value = serde_json::from_str(&text)?;
    let tables = program["tables"].as_array_mut().into_iter().flatten();
    for table in tables.filter(|table| table["name"] == "plant_states") {
        let rows = table["rows"].as_array_mut().into_iter().flatten();
        for row in rows.filter_map(|row| row.as_array_mut()) {
            // The last column, as a declaration without `sigma` writes it.
            if let Some(sigma) = row.last_mut() {
                *sigma = 0.0.into();
            }
        }
    }
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("plant.json");
    std::fs::write(&path, program.to_string())?;
    Ok(LoadedPlant::read(&path)?)
}
