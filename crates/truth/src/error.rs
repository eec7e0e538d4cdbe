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
    /// There is no such effect.
    #[error("found the unknown effect `{id}`, expected the id of an effect; {advice}")]
    UnknownEffect {
        /// What was asked for.
        id: String,
        /// The nearest ids, or why no record can hide it.
        advice: String,
    },
    /// An effect has no such parameter.
    #[error("{effect}: found the unknown parameter `{parameter}`, expected {expected}")]
    UnknownParameter {
        /// The effect's id.
        effect: String,
        /// What was given.
        parameter: String,
        /// The parameters that it has.
        expected: String,
    },
    /// A parameter that an effect cannot do without was not given.
    #[error("{effect}: found no `{parameter}`, expected `{parameter} = ` {expected}")]
    MissingParameter {
        /// The effect's id.
        effect: String,
        /// The parameter.
        parameter: &'static str,
        /// What it has to be.
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
        /// What it has to be.
        expected: String,
    },
}
