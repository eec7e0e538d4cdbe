//! Effects that the catalogue does not hold, scaled to a length beside the causes that are named.

use gyrocal_calibration::{Column, Extension};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Scenario, Simulation, simulate};

use crate::case::{Case, HiddenCase};
use crate::error::CharacteriseError;
use crate::judge::case;
use crate::plant::fitted;
use crate::population::duration_h;

/// Times that a size is corrected after a diagnosis: what is named changes with the size.
const CORRECTIONS: usize = 3;

/// A length within this share of the one that was asked for needs no correction.
const NEAR: f64 = 0.1;

/// No correction is larger: a cause that was named may have taken up everything.
const LARGEST_CORRECTION: f64 = 4.0;

/// Effects that are tried before a record is given up.
const TRIES: usize = 8;

/// The length of an effect before anything is named must be within this factor of what was
/// asked for: those that switch do not grow in proportion.
const REACHED: f64 = 1.2;

/// Larger ones change the motion of the platform itself: they are not small disturbances of what the
/// model fits, but another record. Of a gyro \[deg/h\] and of an accelerometer \[g\].
const LARGEST_SIZES: [f64; 2] = [0.05, 5e-4];

/// An effect of which less is left beside the named causes, in sigmas, is what they are: a sign that
/// never switches is a bias.
const LEAST_LENGTH: f64 = 0.5;

/// An effect and how it depends on its size.
struct Beyond {
    id: String,
    size: f64,
    further: Vec<(&'static str, f64)>,
}

impl Beyond {
    fn hidden(&self) -> Result<Hidden, gyrocal_truth::Error> {
        let mut parameters = vec![("size", self.size)];
        parameters.extend(self.further.iter().copied());
        Hidden::new(&self.id, &parameters)
    }

    fn largest_size(&self) -> f64 {
        let [gyro_deg_per_h, accel_g] = LARGEST_SIZES;
        if self.id.starts_with("gyro_") {
            gyro_deg_per_h
        } else {
            accel_g
        }
    }

    /// A tone at an odd period, a term with the sign of a specific force (Coulomb friction), or a
    /// dead zone, of a gyro or an accelerometer.
    fn draw(kind: u64, scenario: &Scenario, draw: &mut Draw) -> Self {
        let axis = *draw.one_of(&["x", "y", "z"]);
        let other = *draw.one_of(&["x", "y", "z"]);
        let (id, first_size) = match kind % 6 {
            0 => (format!("gyro_{axis}.tone"), 1e-3),
            1 => (format!("gyro_{axis}.sign_{other}"), 1e-3),
            2 => (format!("gyro_{axis}.dead_zone"), 1e-3),
            3 => (format!("accel_{axis}.tone"), 1e-6),
            4 => (format!("accel_{axis}.sign"), 1e-6),
            _ => (format!("accel_{axis}.dead_zone"), 1e-6),
        };
        let further = if id.ends_with(".tone") {
            vec![
                ("period_h", odd_period_h(scenario, draw)),
                ("phase_deg", 360.0 * draw.uniform()),
            ]
        } else {
            Vec::new()
        };
        Self {
            id,
            size: first_size,
            further,
        }
    }
}

/// Between six rows and a third of the record, away from the day and its half, which terms of the
/// catalogue have.
fn odd_period_h(scenario: &Scenario, draw: &mut Draw) -> f64 {
    let range = [
        6.0 * scenario.interval_s / 3600.0,
        duration_h(scenario) / 3.0,
    ];
    loop {
        let period_h = draw.log_uniform(range);
        let away = |from_h: f64| libm::fabs(libm::log(period_h / from_h)) > 0.15;
        if away(24.0) && away(12.0) {
            return period_h;
        }
    }
}

/// A record with an effect beyond the catalogue, diagnosed; `None` if none of those that were
/// tried reaches the length.
pub(crate) fn beyond(
    number: u64,
    scenario: &Scenario,
    strength: f64,
    draw: &mut Draw,
) -> Result<Case, CharacteriseError> {
    let clean = simulate(scenario)?;
    let without = missed(&clean, &Extension::default())?;
    for attempt in 0..TRIES {
        let mut effect = Beyond::draw(number + attempt as u64, scenario, draw);
        if !scale(scenario, &without, &mut effect, strength)? {
            continue;
        }
        let mut corrections = 0;
        loop {
            let simulation = with(scenario, &effect)?;
            let found = diagnose(
                &simulation.record,
                &simulation.bench,
                &DiagnoseOptions::default(),
            )?;
            let named = found
                .extended
                .as_ref()
                .map_or_else(Extension::default, |extended| {
                    without_unnamed(extended.extension())
                });
            // Nor can it be told where the named causes cannot be fitted without it.
            let nothing = named == Extension::default();
            let without = if nothing {
                Ok(without.clone())
            } else {
                missed(&clean, &named)
            };
            let (Ok(without), Ok(with)) = (without, missed(&simulation, &named)) else {
                break;
            };
            let length = distance(&without, &with);
            if length < LEAST_LENGTH {
                break;
            }
            let off = strength / length;
            corrections += 1;
            if (off - 1.0).abs() < NEAR || corrections > CORRECTIONS {
                return Ok(Case {
                    hidden: vec![hidden_case(&effect, length)],
                    ..case(&found)
                });
            }
            effect.size = (effect.size * off.min(LARGEST_CORRECTION)).min(effect.largest_size());
        }
    }
    Err(CharacteriseError::NothingToHide {
        tried: TRIES,
        strength,
    })
}

/// Brings an effect to a length beside the nominal model; false if it cannot be.
fn scale(
    scenario: &Scenario,
    without: &[[f64; 3]],
    effect: &mut Beyond,
    strength: f64,
) -> Result<bool, CharacteriseError> {
    for _ in 0..=CORRECTIONS {
        let Ok(simulation) = with(scenario, effect) else {
            return Ok(false);
        };
        let Ok(with) = missed(&simulation, &Extension::default()) else {
            return Ok(false);
        };
        let length = distance(without, &with);
        let off = strength / length;
        if !(1e-4..1e4).contains(&off) {
            return Ok(false);
        }
        if (1.0 / REACHED..REACHED).contains(&off) {
            return Ok(true);
        }
        effect.size *= off;
        if effect.size > effect.largest_size() {
            return Ok(false);
        }
    }
    Ok(false)
}

fn with(scenario: &Scenario, effect: &Beyond) -> Result<Simulation, CharacteriseError> {
    Ok(simulate(&Scenario {
        hidden: vec![effect.hidden()?],
        ..scenario.clone()
    })?)
}

/// What a model misses of a record, in its standard deviations.
fn missed(
    simulation: &Simulation,
    extension: &Extension,
) -> Result<Vec<[f64; 3]>, CharacteriseError> {
    let nominal = fitted(simulation)?;
    if *extension == Extension::default() {
        return Ok(nominal.whitened()?);
    }
    Ok(nominal.refitted(extension)?.whitened()?)
}

/// What the same model misses of one record and not of the other: the two have the same noise, and
/// the model is fitted to each.
fn distance(without: &[[f64; 3]], with: &[[f64; 3]]) -> f64 {
    let square: f64 = without
        .iter()
        .flatten()
        .zip(with.iter().flatten())
        .map(|(without, with)| with - without)
        .filter(|difference| !difference.is_nan())
        .map(|difference| difference * difference)
        .sum();
    square.sqrt()
}

/// Lines and curves that the search put into the model are no names: they are what is unexplained.
fn without_unnamed(extension: &Extension) -> Extension {
    let further = &extension.further;
    let mut kept = gyrocal_calibration::Further::default();
    for (column, sigma) in further.columns().iter().zip(further.sigmas()) {
        if !matches!(column, Column::Course { .. } | Column::Readings { .. }) {
            kept.extend([column.clone()], *sigma);
        }
    }
    Extension {
        further: kept,
        ..extension.clone()
    }
}

fn hidden_case(effect: &Beyond, strength: f64) -> HiddenCase {
    let mut parameters = vec![("size".to_owned(), effect.size)];
    let further = effect.further.iter();
    parameters.extend(further.map(|(name, value)| ((*name).to_owned(), *value)));
    HiddenCase {
        effect: effect.id.clone(),
        parameters,
        strength,
        in_set: false,
        first_cosine: 0.0,
        covered: None,
        onset_error: None,
        deficit: None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::population::scenario;

    #[test]
    fn every_kind_is_scaled_to_its_length() {
        let scenario = Scenario {
            duration_s: 86_400.0,
            interval_s: 300.0,
            gaps_s: Vec::new(),
            ..scenario(3)
        };
        let clean = simulate(&scenario).unwrap();
        let without = missed(&clean, &Extension::default()).unwrap();
        let mut scaled = 0;
        for kind in 0..6 {
            let mut effect = Beyond::draw(kind, &scenario, &mut Draw::new(kind, 0));
            if scale(&scenario, &without, &mut effect, 10.0).unwrap() {
                scaled += 1;
                let other = with(&scenario, &effect).unwrap();
                let length = distance(&without, &missed(&other, &Extension::default()).unwrap());
                assert!(
                    (10.0 / REACHED..10.0 * REACHED).contains(&length),
                    "{length}"
                );
                // A size is what it is, with the sign that it had.
                assert!(effect.size > 0.0);
            }
        }
        // A term whose force never changes its sign in a day is a constant, and cannot be.
        assert!(scaled >= 3, "{scaled}");
    }
}
