//! Scenarios of the population before effects are injected.

use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Population, Scenario, Temperature};

/// Seed of the population; records are numbers in it.
const SEED: u64 = 77;

/// Purpose of the random stream that decides if the temperature is logged; 0 draws the effects.
const PURPOSE: u64 = 1;

/// Times between rows, drawn with equal probability: mostly one or two minutes, since records with a
/// row each ten seconds cost six times as much.
const INTERVALS_S: [f64; 8] = [10.0, 30.0, 60.0, 60.0, 60.0, 120.0, 120.0, 120.0];

/// Scenario of record `number` without injected effects: any attitude, latitude to 80 degrees on both
/// hemispheres, drift as [`Population::new`] draws it, two to four days with a row each 10, 30, 60 or
/// 120 s, up to three gaps of ten minutes to six hours, the temperature logged in half of the
/// records. Noise is as declared.
#[must_use]
pub fn scenario(number: u64) -> Scenario {
    let population = Population {
        duration_days: [2.0, 4.0],
        intervals_s: INTERVALS_S.to_vec(),
        ..Population::varied(SEED)
    };
    Scenario {
        temperature: (Draw::new(number, PURPOSE).uniform() < 0.5).then(Temperature::default),
        ..population.scenario(number)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A record of one day with its temperature: quick to simulate, and long enough for every effect.
    pub(crate) fn short(number: u64) -> Scenario {
        Scenario {
            duration_s: 86_400.0,
            interval_s: 300.0,
            gaps_s: Vec::new(),
            temperature: Some(Temperature::default()),
            ..scenario(number)
        }
    }

    #[test]
    fn all_listed_properties_of_scenarios_vary() {
        // Of 64 the rarest property, one interval of eight, is missing with a chance of 2e-4; the
        // population is fixed.
        let all: Vec<_> = (0..64).map(scenario).collect();
        let with = |of: &dyn Fn(&Scenario) -> bool| {
            let count = all.iter().filter(|scenario| of(scenario)).count();
            assert!(0 < count && count < all.len(), "{count} of {}", all.len());
        };
        with(&|scenario| scenario.latitude_deg < 0.0);
        with(&|scenario| scenario.gaps_s.is_empty());
        with(&|scenario| scenario.temperature.is_some());
        for interval_s in super::INTERVALS_S {
            with(&|scenario| scenario.interval_s == interval_s);
        }
    }
}
