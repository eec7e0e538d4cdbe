//! Gross errors of a set-up.

use serde::{Deserialize, Serialize};

/// A gross error of the set-up: a wrong description or a wrong use of the instrument, which is no
/// effect of the catalogue.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetupProblem {
    /// Its kind.
    pub kind: String,
    /// The problem in words.
    pub description: String,
    /// The numbers that show it.
    pub evidence: String,
}
