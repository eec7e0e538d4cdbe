//! The JSON result of `gyrocal tumble`.

use serde::Serialize;

use super::prepare::{PreparedTest, SensorReport};
use super::report::MultiPositionReport;
use super::signs::earth_is_reversed;

/// Result of a multi-position test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TumbleResult {
    /// Calibration of the sensors.
    pub sensors: SensorReport,
    /// `true` if the unit turns about specific force as on an Earth that turns the other way: in all gyros that tell the two
    /// apart by ten standard deviations, within three. Signs of gyros, accelerometers or latitude are wrong then, or the
    /// drift in specific force is as large as twice Earth rate by chance.
    pub earth_is_reversed: bool,
    /// The test.
    pub test: MultiPositionReport,
}

impl TumbleResult {
    /// The result of a test.
    #[must_use]
    pub fn of(prepared: &PreparedTest, test: MultiPositionReport) -> Self {
        let laws = test.gyros.iter();
        let laws = laws.map(|gyro| &gyro.extended.coefficients[..]);
        Self {
            sensors: prepared.sensors(),
            earth_is_reversed: earth_is_reversed(prepared, laws),
            test,
        }
    }
}
