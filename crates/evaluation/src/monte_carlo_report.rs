//! The JSON result of `gyrocal monte-carlo`.

use gyrocal_record::Manifest;
use serde::{Deserialize, Serialize};

use crate::calibration_summary::CalibrationSummary;

/// Result of `gyrocal monte-carlo`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct MonteCarloReport {
    /// `SCHEMA_VERSION` of `gyrocal-record` at the time of writing.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// The first seed, and the one after the last.
    pub seeds: [u64; 2],
    /// `true` if seeds number the scenarios of a random population.
    pub population: bool,
    /// Statistics over all runs.
    pub summary: CalibrationSummary,
}
