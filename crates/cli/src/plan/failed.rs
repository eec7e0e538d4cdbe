//! Errors of `gyrocal plan`, with advice.

use std::path::Path;

use gyrocal_design::DesignError;
use gyrocal_record::printable_path;

use crate::advice::advised;

/// No next run could be planned; its help is the advice.
#[derive(Debug, thiserror::Error)]
#[error("{records}: no plan")]
pub struct NotPlanned {
    records: String,
    source: DesignError,
}

/// A diagnosis is of another record, or was made with another bench file.
#[derive(Debug, thiserror::Error)]
#[error(
    "{diagnosis}: a diagnosis {other}; that has SHA-256 {found}, expected {expected}, that of {given}"
)]
pub(super) struct OtherInput {
    pub(super) diagnosis: String,
    /// The input that differs.
    pub(super) other: &'static str,
    pub(super) given: String,
    pub(super) found: String,
    pub(super) expected: String,
}

impl OtherInput {
    fn advice(&self) -> &'static str {
        "diagnose these records with these bench files, in this order, or leave --diagnosis out: the command then \
         diagnoses them"
    }
}

impl NotPlanned {
    /// The failure of a plan for records.
    #[must_use]
    pub fn new(records: &[impl AsRef<Path>], source: DesignError) -> Self {
        let names = records.iter().map(|path| printable_path(path.as_ref()));
        Self {
            records: names.collect::<Vec<_>>().join(", "),
            source,
        }
    }

    fn advice(&self) -> &'static str {
        match &self.source {
            DesignError::NotPlannable { .. } => {
                "write the diagnosis again with `gyrocal diagnose` of this version"
            }
            DesignError::UnknownCoefficient { .. } => "name one of them in --sigma",
            DesignError::Duration { .. } => "give other --hours",
            DesignError::NoAttitude => "widen --limits or [gimbal_limits_deg]",
            DesignError::Limits { .. } => {
                "give shorter --hours, or wider --limits or [gimbal_limits_deg]"
            }
            _ => {
                "the model with the findings cannot be fitted: `gyrocal diagnose` of the same files lists \
                 them"
            }
        }
    }
}

advised! {
    NotPlanned, "gyrocal::plan";
    OtherInput, "gyrocal::plan";
}
