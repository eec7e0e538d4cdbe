//! Population cells: random records that share one kind of injected effect.

mod draws;

use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Scenario, simulate};

use crate::baseline::BaselineMethod;
use crate::error::EvaluationError;
use crate::out_of_catalogue::score_out_of_catalogue;
use crate::record_score::RecordScore;
use crate::scenario::scenario;
use crate::score::score;

/// A population of records with the same kind of injected effect: one cell of the table of operating
/// characteristics.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum PopulationCell {
    /// No effect.
    Clean,
    /// One effect of the catalogue, of this many sigmas of its own bound.
    Single(u32),
    /// One effect of 5 to 50 sigmas, uniform in the logarithm.
    LogUniform,
    /// Two effects, each of 8 sigmas of its own bound given the other.
    Pair,
    /// An effect that is not in the catalogue, of 10 sigmas given the findings.
    OutOfCatalogue,
    /// A step of a gyro, of 8 sigmas.
    Step,
    /// A cubic term of a gyro, of 3 sigmas.
    Cubic,
    /// An error of 0.1 degrees in the initial azimuth.
    Azimuth,
}

impl PopulationCell {
    /// All cells, in the order of the table.
    pub const ALL: [Self; 11] = [
        Self::Clean,
        Self::Single(5),
        Self::Single(6),
        Self::Single(8),
        Self::Single(12),
        Self::LogUniform,
        Self::Pair,
        Self::OutOfCatalogue,
        Self::Step,
        Self::Cubic,
        Self::Azimuth,
    ];

    /// Name on the command line and in files.
    #[must_use]
    pub fn name(self) -> String {
        self.words().0
    }

    /// Description of its records, as a heading.
    #[must_use]
    pub fn title(self) -> String {
        self.words().1
    }

    /// Name and title.
    fn words(self) -> (String, String) {
        let (name, title) = match self {
            Self::Clean => ("clean", "clean records"),
            Self::Single(d) => return (format!("d{d}"), format!("d = {d}")),
            Self::LogUniform => ("d5-50", "d = 5 to 50"),
            Self::Pair => ("pair", "two effects, d = 8 each"),
            Self::OutOfCatalogue => ("beyond", "beyond the catalogue, d = 10"),
            Self::Step => ("step", "a step, d = 8"),
            Self::Cubic => ("cubic", "a cubic term, d = 3"),
            Self::Azimuth => ("azimuth", "azimuth wrong by 0.1 deg"),
        };
        (name.to_owned(), title.to_owned())
    }

    /// The cell of a name.
    ///
    /// # Errors
    /// [`EvaluationError::UnknownCell`].
    pub fn of_name(name: &str) -> Result<Self, EvaluationError> {
        let found = Self::ALL.into_iter().find(|cell| cell.name() == name);
        found.ok_or_else(|| EvaluationError::UnknownCell {
            name: name.to_owned(),
            known: Self::ALL.map(Self::name).join(", "),
        })
    }

    /// Number of records on which its targets must be met.
    #[must_use]
    pub fn full_runs(self) -> u64 {
        if self == Self::Clean { 2000 } else { 1000 }
    }

    /// Number of the scenario for a seed: no two cells share one for seeds below a million.
    #[must_use]
    pub fn number(self, seed: u64) -> u64 {
        let place = Self::ALL.iter().position(|cell| *cell == self).unwrap_or(0);
        seed.wrapping_add(1_000_000 * place as u64)
    }

    /// Simulates and diagnoses the record of a seed, and compares the result with the truth.
    ///
    /// # Errors
    /// [`EvaluationError`] if the record cannot be simulated, calibrated or diagnosed, or shows no
    /// effect at the strength of the cell.
    pub fn evaluate(
        self,
        seed: u64,
        methods: &[BaselineMethod],
    ) -> Result<RecordScore, EvaluationError> {
        let number = self.number(seed);
        let scenario = scenario(number);
        let random = &mut Draw::new(number, 0);
        let injected = match self {
            Self::Clean => Vec::new(),
            Self::Single(strength) => draws::single(seed, &scenario, f64::from(strength), random)?,
            Self::LogUniform => {
                let strength = random.log_uniform([5.0, 50.0]);
                draws::single(seed, &scenario, strength, random)?
            }
            Self::Pair => draws::pair(&scenario, 8.0, random)?,
            Self::OutOfCatalogue => return score_out_of_catalogue(seed, &scenario, 10.0, random),
            Self::Step => draws::one_of(draws::is_step, &scenario, 8.0, random)?,
            Self::Cubic => draws::one_of(draws::is_cubic, &scenario, 3.0, random)?,
            Self::Azimuth => draws::azimuth(&scenario, random)?,
        };
        let hidden = injected.iter().map(|(injected, _)| injected.to_hidden());
        let hidden: Result<Vec<_>, _> = hidden.collect();
        let simulation = simulate(&Scenario {
            hidden: hidden?,
            ..scenario.clone()
        })?;
        score(&scenario, &simulation, &injected, methods)
    }
}

#[cfg(test)]
mod tests {
    use super::PopulationCell;

    #[test]
    fn names_are_unique_and_lead_back() {
        for cell in PopulationCell::ALL {
            assert_eq!(PopulationCell::of_name(&cell.name()).ok(), Some(cell));
        }
        let error = PopulationCell::of_name("d7").err();
        let said = error.map(|error| error.to_string()).unwrap_or_default();
        assert!(said.contains("found the cell `d7`, expected one of clean"));
    }
}
