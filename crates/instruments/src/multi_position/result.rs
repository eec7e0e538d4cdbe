//! The JSON result of `gyrocal tumble`.

use serde::Serialize;

use super::few_positions::FewPositionReport;
use super::prepare::{PreparedTest, SensorReport};
use super::report::MultiPositionReport;
use super::signs::earth_is_reversed;

/// Result of a test with many or with few stops. One of its tests is there.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TumbleResult {
    /// Calibration of the sensors.
    pub sensors: SensorReport,
    /// `true` if the unit turns about specific force as on an Earth that turns the other way: in all gyros that tell the two
    /// apart by ten standard deviations, within three. Signs of gyros, accelerometers or latitude are wrong then, or the
    /// drift in specific force is as large as twice Earth rate by chance.
    pub earth_is_reversed: bool,
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
        let laws = report.gyros.iter();
        let laws = laws.map(|gyro| &gyro.extended.coefficients[..]);
        Self {
            sensors: prepared.sensors(),
            earth_is_reversed: earth_is_reversed(prepared, laws),
            test: Some(report),
            few_positions: None,
        }
    }

    /// The result of a test with few stops.
    #[must_use]
    pub fn of_few(prepared: &PreparedTest, report: FewPositionReport) -> Self {
        let laws = report.gyros.iter().map(|gyro| &gyro.coefficients[..]);
        Self {
            sensors: prepared.sensors(),
            earth_is_reversed: earth_is_reversed(prepared, laws),
            test: None,
            few_positions: Some(report),
        }
    }
}
