//! The truth of a record as a serialisable report.

use gyrocal_record::SimulationReport;
use serde::Serialize;

use crate::hidden::Hidden;

/// Truth of a simulated record, hidden effects included.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TruthReport {
    /// Coefficients, rows and attitudes.
    #[serde(flatten)]
    pub simulation: SimulationReport,
    /// The hidden effects.
    pub hidden: Vec<HiddenReport>,
}

/// One hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct HiddenReport {
    /// Its id.
    pub effect: String,
    /// Its parameters, those that have their default included.
    pub parameters: Vec<ParameterReport>,
}

/// One parameter of a hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterReport {
    /// `size`, `onset_s`, and so on.
    pub name: String,
    /// The value, in `unit`.
    pub value: f64,
    /// `deg/h/g`, `s`, and so on.
    pub unit: String,
}

impl From<&Hidden> for HiddenReport {
    fn from(hidden: &Hidden) -> Self {
        let parameters = hidden.parameters().into_iter();
        Self {
            effect: hidden.id().to_owned(),
            parameters: parameters
                .map(|(name, value, unit)| ParameterReport {
                    name: name.to_owned(),
                    value,
                    unit: unit.to_owned(),
                })
                .collect(),
        }
    }
}
