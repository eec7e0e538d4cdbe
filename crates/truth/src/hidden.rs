//! A hidden effect: an id and the values of its parameters.

use crate::effect::{Effect, Parameter};
use crate::error::Error;

/// An effect of the platform, its sensors or its site that the nominal model does not have.
///
/// It changes the record, never the bench description, which holds the operator's beliefs.
/// [`Hidden::ids`] lists all effects; `docs/formats.md` describes each.
///
/// ```
/// use gyrocal_truth::{Hidden, Scenario, simulate};
///
/// let scenario = Scenario {
///     hidden: vec![
///         Hidden::new("gyro_y.g_z", &[("size", 0.0035)])?,
///         Hidden::new("gyro_x.step", &[("size", 0.01), ("onset_s", 43_200.0)])?,
///     ],
///     duration_s: 86_400.0,
///     ..Scenario::default()
/// };
/// assert_eq!(simulate(&scenario)?.truth.hidden, scenario.hidden);
///
/// let error = Hidden::new("gyro_y.g_w", &[("size", 0.0035)]).unwrap_err();
/// assert!(error.to_string().contains("did you mean `gyro_y.g_x`"));
/// # Ok::<(), gyrocal_truth::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Hidden {
    id: String,
    effect: Effect,
    /// One for each of the effect's parameters.
    values: Vec<f64>,
}

impl Hidden {
    /// The effect of an id with named parameters, in any order.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownEffect`], [`Error::UnknownParameter`], [`Error::MissingParameter`], or
    /// [`Error::InvalidParameter`] for a value that makes no sense or is given twice.
    pub fn new(id: &str, parameters: &[(&str, f64)]) -> Result<Self, Error> {
        let effect = Effect::of(id).ok_or_else(|| unknown(id))?;
        let known = effect.parameters();
        for (name, _) in parameters {
            if !known.iter().any(|parameter| parameter.name == *name) {
                let names: Vec<String> = known.iter().map(|p| format!("`{}`", p.name)).collect();
                return Err(Error::UnknownParameter {
                    effect: id.to_owned(),
                    parameter: (*name).to_owned(),
                    expected: names.join(" or "),
                });
            }
        }
        let values = known.iter().map(|parameter| {
            let all = parameters.iter();
            let mut given = all.filter(|(name, _)| *name == parameter.name);
            let value = given.next().map(|(_, value)| *value);
            if given.next().is_some() {
                return Err(invalid(id, parameter, "two values", "one value".to_owned()));
            }
            let value = value
                .or(parameter.default)
                .ok_or_else(|| Error::MissingParameter {
                    effect: id.to_owned(),
                    parameter: parameter.name,
                    expected: parameter.bound.describe(),
                })?;
            let expected = || parameter.bound.describe();
            let refused = || invalid(id, parameter, &value.to_string(), expected());
            parameter
                .bound
                .holds(value)
                .then_some(value)
                .ok_or_else(refused)
        });
        Ok(Self {
            values: values.collect::<Result<_, _>>()?,
            id: id.to_owned(),
            effect,
        })
    }

    /// The ids of all effects that can be hidden.
    #[must_use]
    pub fn ids() -> Vec<String> {
        Effect::all().into_iter().map(|(id, _)| id).collect()
    }

    /// The id.
    #[must_use]
    pub fn id(&self) -> &str {
        &self.id
    }

    /// Name, value and unit of each parameter.
    #[must_use]
    pub fn parameters(&self) -> Vec<(&'static str, f64, &'static str)> {
        let both = self.effect.parameters().into_iter().zip(&self.values);
        both.map(|(parameter, value)| (parameter.name, *value, parameter.unit))
            .collect()
    }

    /// The same effect, `factor` times as large: sizes, amplitudes and angles are multiplied;
    /// onsets, times, ratios, fractions and correlations are not.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidParameter`] if a size then makes no sense.
    pub fn scaled(&self, factor: f64) -> Result<Self, Error> {
        let both = self.effect.parameters().into_iter().zip(&self.values);
        let scaled = both.map(|(parameter, value)| {
            let factor = if parameter.is_size { factor } else { 1.0 };
            (parameter.name, value * factor)
        });
        Self::new(&self.id, &scaled.collect::<Vec<_>>())
    }

    pub(crate) fn effect(&self) -> Effect {
        self.effect
    }

    /// The value of the parameter with a number, in the order of [`Effect::parameters`].
    pub(crate) fn value(&self, index: usize) -> f64 {
        self.values.get(index).copied().unwrap_or(0.0)
    }

    /// The first three values.
    pub(crate) fn three(&self) -> [f64; 3] {
        core::array::from_fn(|index| self.value(index))
    }
}

fn invalid(id: &str, parameter: &Parameter, found: &str, expected: String) -> Error {
    Error::InvalidParameter {
        effect: id.to_owned(),
        parameter: parameter.name,
        found: found.to_owned(),
        expected,
    }
}

/// Effects that no record has, with advice.
const NOT_OF_RECORDS: [(&str, &str); 1] = [(
    "filter.discretisation",
    "it belongs to a filter, not to a record; a record made by first-order steps is one of the Euler \
     rule",
)];

fn unknown(id: &str) -> Error {
    let mut elsewhere = NOT_OF_RECORDS.iter();
    let advice = elsewhere
        .find(|(known, _)| *known == id)
        .map_or_else(|| advice(id), |(_, advice)| (*advice).to_owned());
    Error::UnknownEffect {
        id: id.to_owned(),
        advice,
    }
}

/// Advice with similar ids.
fn advice(id: &str) -> String {
    /// Most ids that are named.
    const MOST: usize = 3;
    let ids = Hidden::ids();
    let known: Vec<&str> = ids.iter().map(String::as_str).collect();
    match &gyrocal_record::similar_names(id, &known, MOST)[..] {
        [] => "see the list of effects in docs/formats.md".to_owned(),
        similar => format!("did you mean {}?", gyrocal_record::any_of(similar)),
    }
}
