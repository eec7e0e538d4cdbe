//! Consistency test of another filter.

use serde::{Deserialize, Serialize};

/// Consistency test of another filter on the record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FilterTest {
    /// The filter: `euler` is that of the paper.
    pub name: String,
    /// Its mean normalised innovation squared of a row; `None` if it stopped.
    pub nis_mean: Option<f64>,
    /// Acceptance band of the mean of a consistent filter (99.9 %), lower end first.
    pub nis_band: [f64; 2],
    /// Mean of the streaming filter of this program on the same record.
    pub reference_nis_mean: f64,
    /// Row, time and reason of a stop.
    pub stopped: Option<String>,
}
