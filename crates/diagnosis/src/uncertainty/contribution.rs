//! Lines of an uncertainty budget.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{Contribution, UncertaintySource};
use serde::{Deserialize, Serialize};

/// How a contribution was evaluated, by the GUM.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum EvaluationType {
    /// By statistics of the record.
    A,
    /// By what the bench declares, or by judgement.
    B,
}

impl EvaluationType {
    /// Its letter.
    #[must_use]
    pub fn letter(self) -> &'static str {
        match self {
            Self::A => "A",
            Self::B => "B",
        }
    }
}

/// One line of a budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ContributionLine {
    /// Its source.
    pub source: String,
    /// The coefficient whose prior it is, or the gyro whose turn-ons scatter; `None` of other sources.
    pub of: Option<String>,
    /// How it was evaluated.
    pub evaluation: EvaluationType,
    /// Distribution that the quantity counts as having: `normal` or `discrete`.
    pub distribution: String,
    /// Standard uncertainty of the quantity, in `quantity_unit`.
    pub quantity_standard_uncertainty: f64,
    /// Unit of the quantity.
    pub quantity_unit: String,
    /// Derivative of the coefficient by the quantity; 1 of a source that is known by its contribution.
    pub sensitivity: f64,
    /// Contribution to the standard uncertainty of the coefficient, in its unit.
    pub contribution: f64,
    /// Degrees of freedom; `None` of an uncertainty that counts as exact.
    pub degrees_of_freedom: Option<f64>,
}

impl From<&Contribution> for ContributionLine {
    fn from(line: &Contribution) -> Self {
        let of = match line.source {
            UncertaintySource::Prior(index) => DRIFT.get(index).map(|one| one.id.to_owned()),
            UncertaintySource::TurnOn(axis) => ["gyro x", "gyro y", "gyro z"]
                .get(axis)
                .map(|gyro| (*gyro).to_owned()),
            _ => None,
        };
        Self {
            source: line.source.name().to_owned(),
            of,
            evaluation: match line.source.is_type_a() {
                true => EvaluationType::A,
                false => EvaluationType::B,
            },
            distribution: line.source.distribution().to_owned(),
            quantity_standard_uncertainty: line.quantity_standard,
            quantity_unit: line.quantity_unit.to_owned(),
            sensitivity: line.sensitivity,
            contribution: line.standard,
            degrees_of_freedom: finite(line.degrees_of_freedom),
        }
    }
}

/// Degrees of freedom, if there is an end to them.
pub(super) fn finite(degrees: f64) -> Option<f64> {
    Some(degrees).filter(|degrees| degrees.is_finite())
}
