//! Why there is no calibration, and what to do about it.

use std::path::Path;

use gyrocal::EstimationError;
use gyrocal_calibration::CalibrationError;
use gyrocal_record::CalibrationMethod;
use miette::Diagnostic;

use super::CalibrateArguments;
use crate::Failure;

/// The records could not be calibrated.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{records}: no calibration")]
#[diagnostic(code(gyrocal::calibrate), help("{}", self.advice()))]
pub(super) struct NotCalibrated {
    records: String,
    method: CalibrationMethod,
    factorised: bool,
    source: CalibrationError,
}

impl NotCalibrated {
    pub(super) fn new(arguments: &CalibrateArguments, source: CalibrationError) -> Self {
        let name = |path: &Path| path.display().to_string();
        let records = match &source {
            CalibrationError::Pass { run, .. } => arguments.records.get(run - 1),
            _ => None,
        };
        let all = || {
            let names: Vec<String> = arguments.records.iter().map(|path| name(path)).collect();
            names.join(", ")
        };
        Self {
            records: records.map_or_else(all, |path| name(path)),
            method: arguments.method(),
            factorised: arguments.factorised,
            source,
        }
    }

    fn advice(&self) -> &'static str {
        use CalibrationError as Why;
        use EstimationError as Filter;

        let batch = self.method == CalibrationMethod::Batch;
        let lost = match &self.source {
            Why::TooShort { .. } => return "record for longer",
            Why::NoAttitude => {
                return "leave out --streaming or --paper: the batch estimator finds the attitude";
            }
            Why::NotLevelled | Why::NoAzimuth { .. } => {
                return "give initial_angles_deg and initial_angles_sigma_deg in [platform]";
            }
            Why::NoDescent { .. } | Why::NotConverged { .. } => {
                return "look for a knock, a restart or a run of bad values in the record: the \
                        verdict of --streaming says how badly one pass fits";
            }
            Why::NotPositiveDefinite => true,
            Why::Filter { source, .. } | Why::Pass { source, .. } => matches!(
                source,
                Filter::LostPrecision { .. } | Filter::NotPositiveDefinite { .. }
            ),
            _ => false,
        };
        if self.method == CalibrationMethod::Paper {
            "the paper's filter fails where the second platform angle comes near 90 deg: leave \
             out --paper"
        } else if lost && !batch && !self.factorised {
            "the prior is very wide against the noise: give [prior] and initial_angles_sigma_deg \
             the sizes that are believed, or carry the covariance as factors with --factorised"
        } else {
            "the numbers of the bench file are out of proportion to each other or to the record: \
             check [noise], [prior] and initial_angles_sigma_deg"
        }
    }
}

impl From<NotCalibrated> for Failure {
    fn from(error: NotCalibrated) -> Self {
        Self::Work(error.into())
    }
}
