//! Sizes of an effect in several records.

use serde::{Deserialize, Serialize};

use crate::Estimated;

/// Sizes of an effect in each record, all else shared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SizesByRecord {
    /// Whether they are one.
    pub choice: SizeChoice,
    /// Log-likelihood of one size less that of a size for each turn-on, both at the scale of sizes that fits
    /// best \[nats\].
    pub log_odds_nats: f64,
    /// The sizes, of the records that tell of them.
    pub sizes: Vec<RecordSize>,
}

/// Sizes of an effect in one record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordSize {
    /// Index of the record.
    pub record: usize,
    /// The sizes, in the order and unit of the finding's parameters.
    pub estimates: Vec<Estimated>,
}

/// Whether an effect has one size in all records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum SizeChoice {
    /// One size, at odds of three to one at least.
    Shared,
    /// A size for each turn-on, at odds of three to one at least.
    PerTurnOn,
    /// The records do not tell.
    Undecided,
}
