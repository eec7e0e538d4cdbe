//! Errors of this crate.

/// Errors of a scenario.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A value of the scenario is out of its bounds.
    #[error("scenario: {name}: found {found}, expected {expected}")]
    InvalidScenario {
        /// The field of [`Scenario`](crate::Scenario).
        name: &'static str,
        /// Its value.
        found: String,
        /// The expected value.
        expected: String,
    },
    /// What watches the simulation ended it.
    #[error("the simulation was stopped before its end")]
    Stopped,
    /// There is no such effect.
    #[error("found the unknown effect `{id}`, expected the id of an effect; {advice}")]
    UnknownEffect {
        /// The id that was given.
        id: String,
        /// The nearest ids, or the reason why no record can have the effect.
        advice: String,
    },
    /// An effect has no such parameter.
    #[error("{effect}: found the unknown parameter `{parameter}`, expected {expected}")]
    UnknownParameter {
        /// The effect's id.
        effect: String,
        /// The name that was given.
        parameter: String,
        /// The parameters that it has.
        expected: String,
    },
    /// A required parameter of an effect is missing.
    #[error("{effect}: found no `{parameter}`, expected `{parameter} = ` {expected}")]
    MissingParameter {
        /// The effect's id.
        effect: String,
        /// The parameter.
        parameter: &'static str,
        /// The expected value.
        expected: String,
    },
    /// A parameter of an effect is out of its bounds or was given twice.
    #[error("{effect}: {parameter}: found {found}, expected {expected}")]
    InvalidParameter {
        /// The effect's id.
        effect: String,
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        found: String,
        /// The expected value.
        expected: String,
    },
}
