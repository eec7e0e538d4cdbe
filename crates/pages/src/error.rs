//! Why a page could not be made.

use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::DiagnosisError;
use gyrocal_plant::PlantError;

/// The reason why the content of a page could not be computed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PageError {
    /// A simulation or a pass over the record failed.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A series could not be computed.
    #[error(transparent)]
    Diagnosis(#[from] DiagnosisError),
    /// A pass over the record of a plant failed.
    #[error(transparent)]
    Plant(#[from] PlantError),
}
