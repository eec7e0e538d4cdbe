//! Interpreted functions beside generated ones.

use std::time::Instant;

use gyrocal_plant::answer::Diagnosis;
use gyrocal_plant::{LoadedPlant, PlantError, SearchOptions, diagnose};
use gyrocal_truth::plant::{Kind, Setting};

use super::{HIDDEN, LONG, record};
use crate::figure::Figure;

#[path = "../../../../examples/duffing/plant.rs"]
#[rustfmt::skip]
#[expect(
    unreachable_pub,
    dead_code,
    clippy::too_many_lines,
    clippy::wrong_self_convention,
    reason = "generated for every use"
)]
mod duffing;

/// Largest difference of a number over its standard deviation.
const SAME: f64 = 1e-6;

/// Names, sets, numbers and times of diagnoses with an effect of the catalogue each.
pub(super) fn figures(interpreted: &LoadedPlant, records: u64) -> Result<Vec<Figure>, PlantError> {
    let generated = interpreted.with_model(duffing::Duffing)?;
    let effects = Kind::Duffing.facts().effects;
    let (mut names_equal, mut worst): (bool, f64) = (true, 0.0);
    for seed in HIDDEN..HIDDEN + records {
        let mut setting = Setting::random(Kind::Duffing, seed, super::ROWS);
        setting.hidden = effects[seed as usize % effects.len()];
        let [one, other] = [interpreted, &generated].map(|plant| timed(plant, &setting));
        let (one, other) = (one?.0, other?.0);
        names_equal &= names(&one) == names(&other);
        for (one, other) in one.parameters.iter().zip(&other.parameters) {
            worst = worst.max((one.value - other.value).abs() / one.sigma);
        }
        let sizes = |answer: &Diagnosis| -> Vec<(f64, Option<f64>)> {
            let sizes = answer.findings.iter().flat_map(|found| &found.sizes);
            sizes.map(|size| (size.value, size.sigma)).collect()
        };
        for ((one, sigma), (other, _)) in sizes(&one).into_iter().zip(sizes(&other)) {
            worst = worst.max((one - other).abs() / sigma.unwrap_or(f64::NAN));
        }
    }
    let mut setting = Setting::random(Kind::Duffing, HIDDEN, LONG);
    setting.hidden = effects[0];
    let interpreted_s = timed(interpreted, &setting)?.1;
    let generated_s = timed(&generated, &setting)?.1;
    let seeds = format!("{HIDDEN} to {}", HIDDEN + records - 1);
    let name = "any plant: interpreted over generated, largest difference of a parameter or size";
    Ok(vec![
        Figure::truth(
            "any plant: interpreted and generated, equal names and sets",
            names_equal,
        )
        .over(records as usize, seeds.clone()),
        Figure {
            target: format!("<= {SAME:e} sigma"),
            measured: format!("{worst:.1e} sigma"),
            ..Figure::within(name, [0.0, SAME], worst)
        }
        .over(records as usize, seeds),
        Figure::note(
            "any plant: time of a diagnosis, interpreted / generated",
            format!("{interpreted_s:.2} s / {generated_s:.2} s"),
        ),
    ])
}

fn timed(plant: &LoadedPlant, setting: &Setting) -> Result<(Diagnosis, f64), PlantError> {
    let record = record(plant, setting)?;
    let began = Instant::now();
    let answer = diagnose(plant, record, None, &SearchOptions::default())?.answer;
    Ok((answer, began.elapsed().as_secs_f64()))
}

/// Named effects, each with its rivals.
fn names(answer: &Diagnosis) -> Vec<(&str, Vec<&str>)> {
    let findings = answer.findings.iter();
    findings
        .map(|found| {
            let rivals = found.rivals.iter().map(|(id, _)| id.as_str());
            (found.effect.as_str(), rivals.collect())
        })
        .collect()
}
