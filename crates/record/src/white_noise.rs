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
    /// Its keys.
    pub const KEYS: [&'static str; 2] = ["accel_g", "gyro_deg_per_h"];

    /// Takes the table of a file.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the table or a value is absent or not positive.
    pub fn from_root(root: &Table<'_>) -> Result<Self, Error> {
        let noise = root.table(Self::TABLE, &Self::KEYS)?;
        Ok(Self {
            accel_g: noise.number(Self::KEYS[0], Bound::Positive)?,
            gyro_deg_per_h: noise.number(Self::KEYS[1], Bound::Positive)?,
        })
    }
}
