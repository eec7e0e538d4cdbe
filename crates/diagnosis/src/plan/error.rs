use gyrocal_calibration::CalibrationError;

/// Why no next run could be planned.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// A run could not be passed over, or a model not fitted.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// An effect that is named is in no catalogue, or has no signature.
    #[error("`{effect}` is no effect that a run can be planned for")]
    UnknownEffect {
        /// Its id.
        effect: String,
    },
    /// A goal speaks of a coefficient that there is not.
    #[error("there is no coefficient `{name}`; they are {known}")]
    UnknownCoefficient {
        /// What was asked for.
        name: String,
        /// All there are, as a list in words.
        known: String,
    },
    /// A duration without meaning.
    #[error(
        "a run of {found_s} s was asked for, expected from {least_s} s, twelve rows, to {most_s} s"
    )]
    Duration {
        /// What was asked for, s.
        found_s: f64,
        /// The shortest run, s.
        least_s: f64,
        /// The longest, s.
        most_s: f64,
    },
    /// The gimbals reach a limit in any run of that duration.
    #[error(
        "no attitude that was tried keeps the gimbals within their limits for {wanted_h:.1} h, as \
         the Earth turns under the platform; the longest lasts {longest_h:.1} h, from \
         {angles_deg:.0?} deg; plan for a shorter run or widen the limits"
    )]
    Limits {
        /// Duration that was asked for, h.
        wanted_h: f64,
        /// The longest that stays within the limits, h.
        longest_h: f64,
        /// Where that begins, deg.
        angles_deg: [f64; 3],
    },
}
