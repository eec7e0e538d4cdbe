//! Why there is no plan, and what to do about it.

use std::path::Path;

use gyrocal_diagnosis::plan::PlanError;
use miette::Diagnostic;

use crate::Failure;

/// No next run could be planned.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{record}: no plan")]
#[diagnostic(code(gyrocal::plan), help("{}", self.advice()))]
pub(super) struct NotPlanned {
    record: String,
    source: PlanError,
}

/// A diagnosis speaks of another record, or was made with another bench file.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error(
    "{diagnosis}: a diagnosis {other}; that has SHA-256 {found}, expected {expected}, that of {given}"
)]
#[diagnostic(
    code(gyrocal::plan),
    help(
        "diagnose this record with this bench file, or leave --diagnosis out: then the command does"
    )
)]
pub(super) struct OtherInput {
    pub(super) diagnosis: String,
    /// What is another one.
    pub(super) other: &'static str,
    pub(super) given: String,
    pub(super) found: String,
    pub(super) expected: String,
}

impl NotPlanned {
    pub(super) fn new(record: &Path, source: PlanError) -> Self {
        Self {
            record: record.display().to_string(),
            source,
        }
    }

    fn advice(&self) -> &'static str {
        match &self.source {
            PlanError::UnknownEffect { .. } => {
                "write the diagnosis again with `gyrocal diagnose` of this version"
            }
            PlanError::UnknownCoefficient { .. } => "name one of them in --sigma",
            PlanError::Duration { .. } => "give other --hours",
            PlanError::Limits { .. } => {
                "give shorter --hours, or wider --limits or [gimbal_limits_deg]"
            }
            _ => {
                "the record cannot be fitted with what was found in it: `gyrocal diagnose` says \
                 what that is"
            }
        }
    }
}

impl From<NotPlanned> for Failure {
    fn from(error: NotPlanned) -> Self {
        Self::Work(error.into())
    }
}

impl From<OtherInput> for Failure {
    fn from(error: OtherInput) -> Self {
        Self::Work(error.into())
    }
}
