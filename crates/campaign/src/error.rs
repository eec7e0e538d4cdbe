//! What can stop a campaign or a trial.

use std::path::PathBuf;

use gyrocal_calibration::CalibrationError;

/// Why a campaign could not be run, or a trial failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CampaignError {
    /// The file of results cannot be read or written.
    #[error("{}: the results cannot be kept there: {reason}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the operating system said.
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
    /// The file is none of results.
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
        /// What the file says and what it should say.
        difference: String,
    },
    /// A line of the file is whole but cannot be understood.
    #[error(
        "{}:{line}: no result: {reason}; delete the line to have its seed run again",
        path.display()
    )]
    Line {
        /// The file.
        path: PathBuf,
        /// Line of the file, counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// A result cannot be written as JSON and read again.
    #[error("the result of seed {seed} does not survive JSON: {reason}")]
    Unstorable {
        /// The seed.
        seed: u64,
        /// What is wrong with it.
        reason: serde_json::Error,
    },
    /// The threads cannot be had.
    #[error("the threads cannot be started: {reason}")]
    Threads {
        /// What the thread pool said.
        reason: String,
    },
    /// A trial's scenario cannot be simulated.
    #[error("the record could not be simulated")]
    Simulation(#[from] gyrocal_truth::Error),
    /// A trial's record cannot be calibrated.
    #[error("the record could not be calibrated")]
    Calibration(#[from] CalibrationError),
    /// A trial's covariance has no inverse.
    #[error("the covariance of the coefficients is not positive definite")]
    NotPositiveDefinite,
}
