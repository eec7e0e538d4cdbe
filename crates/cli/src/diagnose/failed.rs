//! Errors of `gyrocal diagnose`, with advice.

use std::path::Path;

use gyrocal_calibration::{CalibrationError, is_gyro_noise_implausible};
use gyrocal_diagnosis::DiagnosisError;
use gyrocal_record::{Bench, printable_path};

use crate::advice::{advised, on_no_fit};

/// The record could not be diagnosed; its help is the advice.
#[derive(Debug, thiserror::Error)]
#[error("{record}: no diagnosis")]
pub struct NotDiagnosed {
    record: String,
    tiny_gyro_noise: bool,
    source: DiagnosisError,
}

impl NotDiagnosed {
    /// The failure of a record.
    #[must_use]
    pub fn new(record: &Path, bench: &Bench, source: DiagnosisError) -> Self {
        Self {
            record: printable_path(record),
            tiny_gyro_noise: is_gyro_noise_implausible(bench),
            source,
        }
    }

    fn advice(&self) -> &'static str {
        use CalibrationError as Fit;
        use DiagnosisError as Why;

        let source = match &self.source {
            Why::OfRecord { source, .. } => source,
            source => source,
        };
        match source {
            Why::SeveralPlatforms { .. } | Why::Calibration(Fit::UnlikeBenches { .. }) => {
                "give the records of one platform, with the same [prior] and [uncertainty] in their bench \
                 files"
            }
            Why::UnknownEffect { .. } => "docs/diagnosis.md lists the effects",
            Why::Setup { .. } => {
                "mend the record or its bench file: docs/setup-checks.md lists what is checked"
            }
            Why::Unavailable { .. } => "leave it out of --effects, or supply what is missing",
            Why::Calibration(Fit::TooShort { .. })
            | Why::TooShort { .. }
            | Why::UnequalLengths { .. }
            | Why::NotPositiveDefinite { .. }
            | Why::InvalidArgument { .. } => "record for longer",
            Why::Calibration(Fit::NoAttitude) => {
                "leave out --filter: the filter needs initial_angles_deg, the diagnosis does not"
            }
            Why::Calibration(Fit::NotLevelled | Fit::NoAzimuth { .. }) => {
                "give initial_angles_deg and initial_angles_sigma_deg in [platform]"
            }
            Why::Calibration(Fit::NoDescent { .. } | Fit::NotConverged { .. }) => {
                on_no_fit(self.tiny_gyro_noise)
            }
            _ => {
                "the values of the bench file may be implausible, or inconsistent with the record: \
                 check [noise], [prior] and initial_angles_sigma_deg"
            }
        }
    }
}

advised! {
    NotDiagnosed, "gyrocal::diagnose";
}
