//! The truth of a record as a serialisable report.

use gyrocal_record::{Manifest, SCHEMA_VERSION, SimulationReport, TrueCoefficient};
use serde::Serialize;

use crate::hidden::Hidden;
use crate::simulation::Simulation;

/// Truth of a simulated record, hidden effects included.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TruthReport {
    /// Coefficients, rows and attitudes.
    #[serde(flatten)]
    pub simulation: SimulationReport,
    /// The hidden effects.
    pub hidden: Vec<HiddenReport>,
}

impl TruthReport {
    /// The truth of a simulation.
    #[must_use]
    pub fn new(simulation: &Simulation, manifest: Manifest) -> Self {
        let truth = &simulation.truth;
        let coefficients = truth.coefficients.named().into_iter();
        Self {
            simulation: SimulationReport {
                schema_version: SCHEMA_VERSION,
                manifest,
                coefficients: coefficients
                    .map(|(name, value, unit)| TrueCoefficient {
                        name: name.to_owned(),
                        value,
                        unit: unit.to_owned(),
                    })
                    .collect(),
                rows: simulation.record.len(),
                initial_angles_deg: truth.platform_c_enu_first().angles_deg(),
                final_angles_deg: truth.platform_c_enu_last().angles_deg(),
            },
            hidden: truth.hidden.iter().map(HiddenReport::from).collect(),
        }
    }
}

/// One hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HiddenReport {
    /// Its id.
    pub effect: String,
    /// Its parameters, those that have their default included.
    pub parameters: Vec<ParameterReport>,
}

/// One parameter of a hidden effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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
