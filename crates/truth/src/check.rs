//! Validation of a scenario.

use gyrocal_record::{Bound, Record};

use crate::effect::{DRIFT, DRIFT_SPREAD, Effect};
use crate::error::Error;
use crate::hidden::Hidden;
use crate::scenario::{MAX_ROWS, Scenario};

/// Conflict of a hidden effect with its scenario.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Conflict {
    /// Index of the effect.
    pub(crate) index: usize,
    /// The field of the scenario in conflict.
    name: &'static str,
    pub(crate) found: String,
    pub(crate) expected: String,
}

impl Scenario {
    /// Checks that every value is within its bounds.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidScenario`] for the first value that is not.
    pub fn check(&self) -> Result<(), Error> {
        let vectors = self.vectors().into_iter();
        let all = vectors
            .flat_map(|(name, values, bound)| values.map(|value| (name, value, bound)))
            .chain(self.scalars());
        for (name, value, bound) in all {
            if !bound.holds(value) {
                return invalid(name, value.to_string(), bound.describe());
            }
        }
        if let Some(conflict) = self.conflict() {
            return invalid(conflict.name, conflict.found, conflict.expected);
        }
        let mut gaps = self.gaps_s.iter();
        let wrong = gaps.find(|gap| !(gap[0] > 0.0 && gap[1] > gap[0]));
        let expected = || "0 < from < to (the first row has the initial attitude)".to_owned();
        wrong.map_or(Ok(()), |gap| {
            invalid("gaps_s", format!("{gap:?}"), expected())
        })
    }

    /// Scalar fields with their names and bounds.
    #[rustfmt::skip] // a table
    fn scalars(&self) -> [(&'static str, f64, Bound); 12] {
        let temperature = self.temperature.unwrap_or_default();
        let latitude = Bound::Within(-90.0, 90.0);
        let rows = Bound::Within(0.0, MAX_ROWS);
        let duration = Bound::Within(0.0, Record::LONGEST_S);
        let share = Bound::Within(0.0, 1.0);
        [
            ("latitude_deg", self.latitude_deg, latitude),
            ("accel_noise_g", self.accel_noise_g, Bound::NotNegative),
            ("gyro_noise_deg_per_h", self.gyro_noise_deg_per_h, DRIFT_SPREAD),
            ("gravity", self.bench_gravity(), Bound::Positive),
            ("start_s", self.start_s, Bound::Finite),
            ("interval_s", self.interval_s, Bound::Positive),
            ("duration_s", self.duration_s, duration),
            ("duration_s / interval_s", self.duration_s / self.interval_s, rows),
            ("missing_fraction", self.missing_fraction, share),
            ("temperature.mean_c", temperature.mean_c, Bound::Finite),
            ("temperature.daily_k", temperature.daily_k, Bound::Finite),
            ("temperature.wander_k", temperature.wander_k, Bound::NotNegative),
        ]
    }

    /// Fields of three numbers with their names and bounds.
    #[rustfmt::skip] // a table
    fn vectors(&self) -> [(&'static str, [f64; 3], Bound); 6] {
        let coefficients = self.coefficients;
        let field_gauss = self.magnetic_field_gauss.unwrap_or_default();
        [
            ("initial_angles_sigma_deg", self.initial_angles_sigma_deg, Bound::NotNegative),
            ("initial", self.declared_angles_deg(), Bound::Finite),
            ("magnetic_field_gauss", field_gauss, Bound::Finite),
            ("coefficients.bias_deg_per_h", coefficients.bias_deg_per_h, DRIFT),
            ("coefficients.g_deg_per_h_per_g", coefficients.g_deg_per_h_per_g, DRIFT),
            ("coefficients.gg_deg_per_h_per_g2", coefficients.gg_deg_per_h_per_g2, DRIFT),
        ]
    }

    /// The first hidden effect that the scenario does not admit.
    pub(crate) fn conflict(&self) -> Option<Conflict> {
        let mut effects = self.hidden.iter().enumerate();
        effects.find_map(|(index, hidden)| {
            let (name, found, expected) = self.conflict_of(index, hidden)?;
            Some(Conflict {
                index,
                name,
                found,
                expected,
            })
        })
    }

    /// The field, what was found and what was expected.
    fn conflict_of(&self, index: usize, hidden: &Hidden) -> Option<(&'static str, String, String)> {
        let id = hidden.id();
        let onset_s = match hidden.effect() {
            Effect::GyroTemperature { .. } | Effect::AccelTemperature { .. }
                if self.temperature.is_none() =>
            {
                return Some((
                    "temperature",
                    format!("the effect {id} without a temperature"),
                    "a temperature that is logged with the record".to_owned(),
                ));
            }
            Effect::GyroMagnetic(_) if self.magnetic_field_gauss.is_none() => {
                return Some((
                    "magnetic_field_gauss",
                    format!("the effect {id} without a magnetic field"),
                    "the Earth's field at the site".to_owned(),
                ));
            }
            Effect::Latitude => {
                let latitude_deg = self.latitude_deg + hidden.value(0);
                let bound = Bound::Within(-90.0, 90.0);
                let found = format!("{latitude_deg} with the effect {id}");
                let conflict = ("latitude_deg", found, bound.describe());
                return (!bound.holds(latitude_deg)).then_some(conflict);
            }
            Effect::GyroStep(_) => Some(hidden.value(1)),
            Effect::Knock => Some(hidden.value(3)),
            _ => None,
        };
        if let Some(onset_s) = onset_s.filter(|onset_s| *onset_s > self.duration_s) {
            return Some((
                "hidden",
                format!("{id} with an onset at {onset_s} s"),
                format!("an onset in the record, from 0 s to {} s", self.duration_s),
            ));
        }
        let before = self.hidden.get(..index)?;
        let twice = !hidden.effect().can_repeat() && before.iter().any(|other| other.id() == id);
        let expected = "it once, with the sum of both sizes".to_owned();
        twice.then(|| ("hidden", format!("{id} twice"), expected))
    }
}

fn invalid(name: &'static str, found: String, expected: String) -> Result<(), Error> {
    Err(Error::InvalidScenario {
        name,
        found,
        expected,
    })
}
