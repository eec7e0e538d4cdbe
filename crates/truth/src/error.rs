//! What can be wrong with a scenario.

/// Why a scenario cannot be simulated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value of the scenario makes no sense.
    #[error("scenario: {name}: found {found}, expected {expected}")]
    InvalidScenario {
        /// The field of [`Scenario`](crate::Scenario).
        name: &'static str,
        /// Its value.
        found: String,
        /// What it has to be.
        expected: String,
    },
}
