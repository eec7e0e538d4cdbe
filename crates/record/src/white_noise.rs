//! White noise of the instruments, as files declare it.

use crate::bound::Bound;
use crate::error::Error;
use crate::table::Table;

/// The table `[noise]` of bench and scenario files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WhiteNoise {
    /// Standard deviation of one sample of an accelerometer.
    pub accel_g: f64,
    /// Standard deviation of the white gyro noise as held over one minute.
    pub gyro_deg_per_h: f64,
}

impl WhiteNoise {
    /// Name of the table.
    pub const TABLE: &'static str = "noise";

    /// Takes the table of a file.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the table or a value is absent or not positive.
    pub fn from_root(root: &Table<'_>) -> Result<Self, Error> {
        let noise = root.table(Self::TABLE, &["accel_g", "gyro_deg_per_h"])?;
        Ok(Self {
            accel_g: noise.number("accel_g", Bound::Positive)?,
            gyro_deg_per_h: noise.number("gyro_deg_per_h", Bound::Positive)?,
        })
    }
}
