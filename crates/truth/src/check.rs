//! Whether a scenario makes sense.

use gyrocal_record::Bound;

use crate::effect::Effect;
use crate::error::Error;
use crate::hidden::Hidden;
use crate::scenario::{MOST_ROWS, Scenario};

/// What a scenario lacks that one of its hidden effects needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lack {
    /// Which effect, by its number.
    pub(crate) index: usize,
    /// The field of the scenario that is wrong.
    name: &'static str,
    pub(crate) found: String,
    pub(crate) expected: String,
}

impl Scenario {
    /// Says what is wrong with the values, if something is.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidScenario`] for the first value that makes no sense.
    pub fn check(&self) -> Result<(), Error> {
        let coefficients = self.coefficients;
        let temperature = self.temperature.unwrap_or_default();
        let single = [
            (
                "latitude_deg",
                self.latitude_deg,
                Bound::Within(-90.0, 90.0),
            ),
            ("accel_noise_g", self.accel_noise_g, Bound::NotNegative),
            (
                "gyro_noise_deg_per_h",
                self.gyro_noise_deg_per_h,
                Bound::NotNegative,
            ),
            ("gravity", self.bench_gravity(), Bound::Positive),
            ("start_s", self.start_s, Bound::Finite),
            ("interval_s", self.interval_s, Bound::Positive),
            ("duration_s", self.duration_s, Bound::NotNegative),
            (
                "duration_s / interval_s",
                self.duration_s / self.interval_s,
                Bound::Within(0.0, MOST_ROWS),
            ),
            (
                "missing_fraction",
                self.missing_fraction,
                Bound::Within(0.0, 1.0),
            ),
            ("temperature.mean_c", temperature.mean_c, Bound::Finite),
            ("temperature.daily_k", temperature.daily_k, Bound::Finite),
            (
                "temperature.wander_k",
                temperature.wander_k,
                Bound::NotNegative,
            ),
        ];
        let three = [
            (
                "initial_angles_sigma_deg",
                self.initial_angles_sigma_deg,
                Bound::NotNegative,
            ),
            ("initial", self.declared_angles_deg(), Bound::Finite),
            (
                "magnetic_field_gauss",
                self.magnetic_field_gauss.unwrap_or_default(),
                Bound::Finite,
            ),
            (
                "coefficients.bias_deg_per_h",
                coefficients.bias_deg_per_h,
                Bound::Finite,
            ),
            (
                "coefficients.g_deg_per_h_per_g",
                coefficients.g_deg_per_h_per_g,
                Bound::Finite,
            ),
            (
                "coefficients.gg_deg_per_h_per_g2",
                coefficients.gg_deg_per_h_per_g2,
                Bound::Finite,
            ),
        ];
        let all = three
            .into_iter()
            .flat_map(|(name, values, bound)| values.map(|value| (name, value, bound)))
            .chain(single);
        for (name, value, bound) in all {
            if !bound.holds(value) {
                return Err(Error::InvalidScenario {
                    name,
                    found: value.to_string(),
                    expected: bound.describe(),
                });
            }
        }
        self.check_hidden()?;
        match self
            .gaps_s
            .iter()
            .find(|gap| !(gap[0] > 0.0 && gap[1] > gap[0]))
        {
            Some(gap) => Err(Error::InvalidScenario {
                name: "gaps_s",
                found: format!("{gap:?}"),
                expected: "0 < from < to (the first row has the initial attitude)".to_owned(),
            }),
            None => Ok(()),
        }
    }

    /// The first hidden effect that has no meaning in this scenario.
    pub(crate) fn lack(&self) -> Option<Lack> {
        let effects = self.hidden.iter().enumerate();
        effects
            .filter_map(|(index, hidden)| {
                let (name, found, expected) = self.lack_of(index, hidden)?;
                Some(Lack {
                    index,
                    name,
                    found,
                    expected,
                })
            })
            .next()
    }

    fn check_hidden(&self) -> Result<(), Error> {
        match self.lack() {
            Some(lack) => Err(Error::InvalidScenario {
                name: lack.name,
                found: lack.found,
                expected: lack.expected,
            }),
            None => Ok(()),
        }
    }

    /// The field, what was found and what was expected.
    fn lack_of(&self, index: usize, hidden: &Hidden) -> Option<(&'static str, String, String)> {
        let id = hidden.id();
        let onset_s = match hidden.effect() {
            Effect::GyroTemperature(_) | Effect::AccelTemperature(_)
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
                return (!bound.holds(latitude_deg)).then(|| {
                    (
                        "latitude_deg",
                        format!("{latitude_deg} with the effect {id}"),
                        bound.describe(),
                    )
                });
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
        twice.then(|| {
            (
                "hidden",
                format!("{id} twice"),
                "it once, with the sum of both sizes".to_owned(),
            )
        })
    }
}
