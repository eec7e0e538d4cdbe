use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::DiagnoseError;

/// Why a record gave no case.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CharacteriseError {
    /// The record could not be simulated.
    #[error("the record could not be simulated")]
    Simulation(#[from] gyrocal_truth::Error),
    /// The nominal model could not be fitted.
    #[error("the record could not be calibrated")]
    Calibration(#[from] CalibrationError),
    /// The record could not be diagnosed.
    #[error("the record could not be diagnosed")]
    Diagnosis(#[from] DiagnoseError),
    /// The record shows no effect that was tried at the size that was asked for.
    #[error(
        "none of {tried} effects that were tried can be hidden in this record at {strength} \
         sigmas of its bound"
    )]
    NothingToHide {
        /// How many were tried.
        tried: usize,
        /// The size that was asked for.
        strength: f64,
    },
    /// An effect that the catalogue does not hold.
    #[error("found the effect `{id}`, expected one of the catalogue; `docs/model.md` lists them")]
    UnknownEffect {
        /// Its id.
        id: String,
    },
    /// A cell that does not exist.
    #[error("found the cell `{name}`, expected one of {known}")]
    UnknownCell {
        /// Its name.
        name: String,
        /// Those that do.
        known: String,
    },
}
