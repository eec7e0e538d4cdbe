//! The JSON result of `gyrocal tumble`.

use serde::Serialize;

use super::few_positions::FewPositionReport;
use super::prepare::{PreparedTest, SensorReport};
use super::report::MultiPositionReport;

/// Result of a test with many or with few stops. One of its tests is there.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TumbleResult {
    /// Calibration of the sensors.
    pub sensors: SensorReport,
    /// The test with many stops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub test: Option<MultiPositionReport>,
    /// The test with few stops.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub few_positions: Option<FewPositionReport>,
}

impl TumbleResult {
    /// The result of a test with many stops.
    #[must_use]
    pub fn of_many(prepared: &PreparedTest, report: MultiPositionReport) -> Self {
        Self {
            sensors: prepared.sensors(),
            test: Some(report),
            few_positions: None,
        }
    }

    /// The result of a test with few stops.
    #[must_use]
    pub fn of_few(prepared: &PreparedTest, report: FewPositionReport) -> Self {
        Self {
            sensors: prepared.sensors(),
            test: None,
            few_positions: Some(report),
        }
    }
}
