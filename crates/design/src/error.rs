//! Errors of this crate.

use gyrocal_calibration::CalibrationError;
use gyrocal_hypothesis::Stopped;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// A fit or a pass over a record failed.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The effect has no signature, or is not in the catalogue.
    #[error("`{effect}` is no effect that a run can be planned for")]
    NotPlannable {
        /// Its id.
        effect: String,
    },
    /// The record or its bench lacks an input of the effect.
    #[error("`{effect}` cannot be in the model: {why}")]
    MissingInput {
        /// Its id.
        effect: &'static str,
        /// The missing input.
        why: String,
    },
    /// A goal names an unknown coefficient.
    #[error("there is no coefficient `{name}`; they are {known}")]
    UnknownCoefficient {
        /// Its id.
        name: String,
        /// All ids, as a list in words.
        known: String,
    },
    /// A run of a duration that cannot be planned.
    #[error(
        "a run of {found_s} s was asked for, expected from {least_s} s, twelve rows, to {most_s} s"
    )]
    Duration {
        /// The duration \[s\].
        found_s: f64,
        /// The shortest run \[s\].
        least_s: f64,
        /// The longest run \[s\].
        most_s: f64,
    },
    /// No attitude lies within the limits.
    #[error("no attitude lies within the limits of the angles; that about y is from -90 to 90 deg")]
    NoAttitude,
    /// The gimbals reach a limit in any run of that duration.
    #[error(
        "no attitude that was tried keeps the gimbals within their limits for {wanted_h:.1} h, as \
         the Earth turns under the platform; the longest lasts {longest_h:.1} h, from \
         {angles_deg:.0?} deg; plan for a shorter run or widen the limits"
    )]
    Limits {
        /// The requested duration \[h\].
        wanted_h: f64,
        /// The longest that stays within the limits \[h\].
        longest_h: f64,
        /// Platform angles at its start \[deg\].
        angles_deg: [f64; 3],
    },
}
