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
}
