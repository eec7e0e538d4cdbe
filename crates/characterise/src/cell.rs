//! The cells of the table: what is hidden in their records.

use gyrocal::{EFFECTS, Effect};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};

use crate::beyond::beyond;
use crate::case::Case;
use crate::error::CharacteriseError;
use crate::judge::judge;
use crate::methods::Method;
use crate::plant::{Planted, fitted, plant, plant_in, searched, shape};
use crate::population::scenario;

/// Draws of an effect that the record can show before it is given up.
pub(crate) const TRIES: usize = 200;

/// Two effects are hidden together if the cosine between their signatures is less.
const LARGEST_COSINE: f64 = 0.6;

const STEPS: [&str; 3] = ["gyro_x.step", "gyro_y.step", "gyro_z.step"];
const CUBICS: [&str; 3] = ["gyro_x.g_xxx", "gyro_y.g_yyy", "gyro_z.g_zzz"];

/// Error of the azimuth, deg.
const AZIMUTH_DEG: f64 = 0.1;

/// A population of records in which the same is hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Cell {
    /// Nothing.
    Clean,
    /// One effect of the catalogue, this many sigmas of its own bound long.
    Single(u32),
    /// One effect, between 5 and 50 sigmas, uniform in the logarithm.
    LogUniform,
    /// Two effects, each 8 sigmas of its own bound beside the other.
    Pair,
    /// An effect that the catalogue does not hold, 10 sigmas beside the causes that are named.
    Beyond,
    /// A step of a gyro, 8 sigmas.
    Step,
    /// A cubic term of a gyro, 3 sigmas.
    Cubic,
    /// An error of the azimuth at the first row of 0.1 degrees.
    Azimuth,
}

impl Cell {
    /// All of them, in the order of the table.
    pub const ALL: [Self; 11] = [
        Self::Clean,
        Self::Single(5),
        Self::Single(6),
        Self::Single(8),
        Self::Single(12),
        Self::LogUniform,
        Self::Pair,
        Self::Beyond,
        Self::Step,
        Self::Cubic,
        Self::Azimuth,
    ];

    /// Its name on the command line and in files.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Clean => "clean".to_owned(),
            Self::Single(strength) => format!("d{strength}"),
            Self::LogUniform => "d5-50".to_owned(),
            Self::Pair => "pair".to_owned(),
            Self::Beyond => "beyond".to_owned(),
            Self::Step => "step".to_owned(),
            Self::Cubic => "cubic".to_owned(),
            Self::Azimuth => "azimuth".to_owned(),
        }
    }

    /// What its records have in common.
    #[must_use]
    pub fn title(self) -> String {
        match self {
            Self::Clean => "clean records".to_owned(),
            Self::Single(strength) => format!("d = {strength}"),
            Self::LogUniform => "d = 5 to 50".to_owned(),
            Self::Pair => "two effects, d = 8 each".to_owned(),
            Self::Beyond => "beyond the catalogue, d = 10".to_owned(),
            Self::Step => "a step, d = 8".to_owned(),
            Self::Cubic => "a cubic term, d = 3".to_owned(),
            Self::Azimuth => "azimuth wrong by 0.1 deg".to_owned(),
        }
    }

    /// The cell of a name.
    ///
    /// # Errors
    /// [`CharacteriseError::UnknownCell`].
    pub fn of_name(name: &str) -> Result<Self, CharacteriseError> {
        let found = Self::ALL.into_iter().find(|cell| cell.name() == name);
        found.ok_or_else(|| CharacteriseError::UnknownCell {
            name: name.to_owned(),
            known: Self::ALL.map(Self::name).join(", "),
        })
    }

    /// Records that its figures are asked for on.
    #[must_use]
    pub fn full_runs(self) -> u64 {
        if self == Self::Clean { 2000 } else { 1000 }
    }

    /// Number of its record in the population for a seed: no two cells share one below a million.
    #[must_use]
    pub fn number(self, seed: u64) -> u64 {
        let place = Self::ALL.iter().position(|cell| *cell == self).unwrap_or(0);
        seed.wrapping_add(1_000_000 * place as u64)
    }

    /// Simulates, diagnoses and judges the record of a seed.
    ///
    /// # Errors
    /// [`CharacteriseError`] if the record cannot be simulated, calibrated or diagnosed, or shows
    /// nothing at the size that is asked for.
    pub fn examine(self, seed: u64, methods: &[Method]) -> Result<Case, CharacteriseError> {
        let number = self.number(seed);
        let scenario = scenario(number);
        let draw = &mut Draw::new(number, 0);
        let planted = match self {
            Self::Clean => Vec::new(),
            Self::Single(strength) => single(seed, &scenario, f64::from(strength), draw)?,
            Self::LogUniform => {
                let strength = draw.log_uniform([5.0, 50.0]);
                single(seed, &scenario, strength, draw)?
            }
            Self::Pair => pair(&scenario, 8.0, draw)?,
            Self::Beyond => return beyond(seed, &scenario, 10.0, draw),
            Self::Step => one_of(STEPS, &scenario, 8.0, draw)?,
            Self::Cubic => one_of(CUBICS, &scenario, 3.0, draw)?,
            Self::Azimuth => azimuth(&scenario, draw)?,
        };
        let hidden: Result<Vec<_>, _> = planted
            .iter()
            .map(|(planted, _)| planted.hidden())
            .collect();
        let simulation = simulate(&Scenario {
            hidden: hidden?,
            ..scenario.clone()
        })?;
        judge(&scenario, &simulation, &planted, methods)
    }
}

/// Multiples of it, less their whole part, fill the interval from 0 to 1 evenly, however many there
/// are: the golden ratio.
const EVENLY: f64 = 0.618_033_988_749_894_9;

/// The list that single effects are taken from in turn: every effect, those that have no sister on
/// another axis three times.
fn turns(effects: &[&'static Effect]) -> Vec<&'static Effect> {
    let mut turns = effects.to_vec();
    for effect in effects {
        if effect.family == effect.id {
            turns.extend([effect, effect]);
        }
    }
    turns
}

fn single(
    seed: u64,
    scenario: &Scenario,
    strength: f64,
    draw: &mut Draw,
) -> Result<Vec<(Planted, f64)>, CharacteriseError> {
    let effects = turns(&searched(scenario));
    let clean = simulate(scenario)?;
    let fitted = fitted(&clean)?;
    for attempt in 0..TRIES {
        // In turn; another one if the record says nothing of it.
        let effect = match attempt {
            0 => effects[((seed as f64 * EVENLY).fract() * effects.len() as f64) as usize],
            _ => *draw.one_of(&effects),
        };
        let with_shape = [(effect, shape(effect, scenario, draw))];
        if let Some(planted) = plant_in(&clean, &fitted, &with_shape, strength, 1.0, draw)? {
            return Ok(planted.into_iter().map(|one| (one, strength)).collect());
        }
    }
    Err(CharacteriseError::NothingToHide {
        tried: TRIES,
        strength,
    })
}

fn pair(
    scenario: &Scenario,
    strength: f64,
    draw: &mut Draw,
) -> Result<Vec<(Planted, f64)>, CharacteriseError> {
    let effects = searched(scenario);
    let clean = simulate(scenario)?;
    let fitted = fitted(&clean)?;
    for _ in 0..TRIES {
        let one = *draw.one_of(&effects);
        let other = *draw.one_of(&effects);
        if one.id == other.id || one.equivalents.contains(&other.id) {
            continue;
        }
        let both = [one, other].map(|effect| (effect, shape(effect, scenario, draw)));
        if let Some(planted) = plant_in(&clean, &fitted, &both, strength, LARGEST_COSINE, draw)? {
            return Ok(planted.into_iter().map(|one| (one, strength)).collect());
        }
    }
    Err(CharacteriseError::NothingToHide {
        tried: TRIES,
        strength,
    })
}

/// A step or a cubic term of one of the gyros.
fn one_of(
    ids: [&str; 3],
    scenario: &Scenario,
    strength: f64,
    draw: &mut Draw,
) -> Result<Vec<(Planted, f64)>, CharacteriseError> {
    let is_kind = |effect: &&Effect| ids.contains(&effect.id);
    let effects: Vec<&'static Effect> = EFFECTS.iter().filter(is_kind).collect();
    for _ in 0..TRIES {
        let effect = *draw.one_of(&effects);
        let with_shape = (effect, shape(effect, scenario, draw));
        if let Some(planted) = plant(scenario, &[with_shape], strength, 1.0, draw)? {
            return Ok(planted.into_iter().map(|one| (one, strength)).collect());
        }
    }
    Err(CharacteriseError::NothingToHide {
        tried: TRIES,
        strength,
    })
}

/// The platform turned about the vertical at the first row.
fn azimuth(scenario: &Scenario, draw: &mut Draw) -> Result<Vec<(Planted, f64)>, CharacteriseError> {
    let id = "platform.initial_attitude";
    let effect = EFFECTS
        .iter()
        .find(|effect| effect.id == id)
        .ok_or_else(|| CharacteriseError::UnknownEffect { id: id.to_owned() })?;
    let platform_c_enu = scenario.platform().initial_platform_c_enu.matrix();
    let angle_deg = AZIMUTH_DEG * draw.sign();
    let planted = Planted {
        effect,
        sizes: platform_c_enu.map(|row| angle_deg * row[2]).to_vec(),
        shape: None,
    };
    let strength = planted.strength(scenario)?;
    Ok(vec![(planted, strength)])
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    #[test]
    fn names_are_unique_and_lead_back() {
        for cell in Cell::ALL {
            assert_eq!(Cell::of_name(&cell.name()).ok(), Some(cell));
        }
        let error = Cell::of_name("d7").err().map(|error| error.to_string());
        assert!(
            error.is_some_and(|error| error.contains("found the cell `d7`, expected one of clean"))
        );
    }

    /// No effect is left out of a full cell, and none is drawn much more often than its turns.
    #[test]
    fn turns_are_even() {
        let scenario = Scenario {
            temperature: Some(gyrocal_truth::Temperature::default()),
            ..scenario(1)
        };
        let effects = turns(&searched(&scenario));
        let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
        for seed in 0..1000_u64 {
            let place = ((seed as f64 * EVENLY).fract() * effects.len() as f64) as usize;
            *counts.entry(effects[place].id).or_default() += 1;
        }
        let even = 1000.0 / effects.len() as f64;
        for effect in searched(&scenario) {
            let single = effect.family == effect.id;
            let turns = if single { 3.0 } else { 1.0 };
            let count = counts.get(effect.id).copied().unwrap_or(0) as f64;
            // The golden sequence is off by fewer than two in any interval.
            assert!(
                (count - turns * even).abs() < 1.0 + turns,
                "{}: {count}",
                effect.id
            );
        }
    }
}
