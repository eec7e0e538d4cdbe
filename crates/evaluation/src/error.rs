//! The error of this crate.

use std::path::PathBuf;

use gyrocal::effect::EffectKind;
use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::DiagnosisError;
use gyrocal_hypothesis::Stopped;

/// Failure of a campaign, or of the evaluation of one record.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// The file of results cannot be read or written.
    #[error("{}: the results cannot be kept there: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// Another process writes the file of results.
    #[error(
        "{}: another process is writing results there; wait for it, or give this one a file of \
         its own",
        path.display()
    )]
    Busy {
        /// The file.
        path: PathBuf,
    },
    /// The file is not a file of results.
    #[error(
        "{}: found a file that holds no results of a campaign, expected one or no file; give the \
         results another name",
        path.display()
    )]
    NoResults {
        /// The file.
        path: PathBuf,
    },
    /// The file holds the results of another campaign.
    #[error(
        "{}: found results of another campaign, {difference}; give this one a file of its own, \
         or delete that file to run all seeds again",
        path.display()
    )]
    OtherCampaign {
        /// The file.
        path: PathBuf,
        /// The first difference between the fingerprints, found and expected.
        difference: String,
    },
    /// A complete line of the file cannot be parsed.
    #[error(
        "{}:{line}: no result: {reason}; delete the line to have its seed run again",
        path.display()
    )]
    Line {
        /// The file.
        path: PathBuf,
        /// Line of the file, counted from 1.
        line: usize,
        /// The error in it.
        reason: String,
    },
    /// A result cannot be written as JSON and read again.
    #[error("the result of seed {seed} does not survive JSON: {reason}")]
    Unstorable {
        /// The seed.
        seed: u64,
        /// The error of the conversion.
        reason: serde_json::Error,
    },
    /// The worker threads cannot be started.
    #[error("the threads cannot be started: {reason}")]
    Threads {
        /// The message of the thread pool.
        reason: String,
    },
    /// A scenario cannot be simulated.
    #[error("the record could not be simulated")]
    Simulation(#[from] gyrocal_truth::Error),
    /// A record cannot be calibrated.
    #[error("the record could not be calibrated")]
    Calibration(#[from] CalibrationError),
    /// A record cannot be diagnosed.
    #[error("the record could not be diagnosed")]
    Diagnosis(#[from] DiagnosisError),
    /// The job was asked to end; what was finished is in the file of results.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The covariance of a trial has no inverse.
    #[error("the covariance of the coefficients is not positive definite")]
    NotPositiveDefinite,
    /// None of the effects that were drawn can be observed in the record at the requested strength.
    #[error(
        "none of {tried} effects that were tried can be hidden in this record at {strength} \
         sigmas of its bound"
    )]
    NotInjectable {
        /// Number of draws.
        tried: usize,
        /// Requested strength, in sigmas of the effect's Cramér–Rao bound.
        strength: f64,
    },
    /// The catalogue has no effect of a kind that a cell injects.
    #[error(
        "the catalogue of this build has no effect of the kind {kind:?}, which the cell injects"
    )]
    MissingEffect {
        /// The kind.
        kind: EffectKind,
    },
    /// The table of right answers cannot be read, or lacks one.
    #[error("the table of right answers: {reason}")]
    RightAnswers {
        /// The error in it.
        reason: String,
    },
    /// A name that no cell has.
    #[error("found the cell `{name}`, expected one of {known}")]
    UnknownCell {
        /// The name.
        name: String,
        /// All names, separated by commas.
        known: String,
    },
}
