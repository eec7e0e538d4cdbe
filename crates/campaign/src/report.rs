//! The JSON result of `gyrocal monte-carlo`.

use gyrocal_record::Manifest;
use serde::{Deserialize, Serialize};

use crate::summary::Summary;

/// What `gyrocal monte-carlo` found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MonteCarloReport {
    /// [`SCHEMA_VERSION`](gyrocal_record::SCHEMA_VERSION) at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// The first seed, and the one after the last.
    pub seeds: [u64; 2],
    /// Whether seeds are numbers of a random population around the scenario.
    pub population: bool,
    /// What all runs say.
    pub summary: Summary,
}
