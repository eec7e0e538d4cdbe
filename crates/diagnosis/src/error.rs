use gyrocal_calibration::CalibrationError;
use gyrocal_hypothesis::Stopped;
use gyrocal_statistics::StatisticsError;

use gyrocal_answer::Answer;

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// A model could not be fitted, or a record not be passed over.
    #[error(transparent)]
    Calibration(#[from] CalibrationError),
    /// A gross error of the set-up leaves nothing sound to diagnose.
    #[error("the set-up is wrong: {}", problems(.result))]
    Setup {
        /// The answer: its verdict is `setup`, and nothing was fitted.
        result: Box<Answer>,
    },
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// Two series that belong together differ in length.
    #[error("{found} rows of {what}, expected {expected}, as many as the record has")]
    UnequalLengths {
        /// The series of another length.
        what: &'static str,
        /// Its number of rows.
        found: usize,
        /// The number of rows of the record.
        expected: usize,
    },
    /// Too few values for a test.
    #[error("{test} has {found} values, expected at least {expected}; record for longer")]
    TooShort {
        /// The test.
        test: &'static str,
        /// Number of values.
        found: usize,
        /// Number of values needed.
        expected: usize,
    },
    /// A covariance of an innovation that no errors can have.
    #[error("the covariance of the innovation of row {row} is not positive definite")]
    NotPositiveDefinite {
        /// Row, counted from 1.
        row: usize,
    },
    /// An argument without meaning.
    #[error("{what} is {found}, expected {expected}")]
    InvalidArgument {
        /// The argument.
        what: &'static str,
        /// Its value.
        found: f64,
        /// Values that it may have.
        expected: &'static str,
    },
    /// A statistic that could not be computed.
    #[error(transparent)]
    Statistics(#[from] StatisticsError),
    /// One of several records has an error; the source is that error.
    #[error("{name} cannot be diagnosed with the other records")]
    OfRecord {
        /// Name of the record.
        name: String,
        /// Its error.
        source: Box<DiagnosisError>,
    },
    /// Records whose coefficients no platform has together.
    #[error(
        "{name}: {coefficient} differs from that of {first} by {sigmas:.0} standard deviations; diagnose records \
         of several platforms one by one, or declare `turn_on_sigma_deg_per_h` in [prior] if only the turn-on \
         differs"
    )]
    SeveralPlatforms {
        /// Name of the record.
        name: String,
        /// Name of the first record.
        first: String,
        /// The coefficient that differs most.
        coefficient: &'static str,
        /// Its difference in standard deviations.
        sigmas: f64,
    },
    /// An effect was asked for that the catalogue does not hold.
    #[error("there is no effect `{id}` in the catalogue{nearest}")]
    UnknownEffect {
        /// Its id.
        id: String,
        /// The nearest ones, as the end of the sentence.
        nearest: String,
    },
    /// An effect was asked for that this record and its bench cannot show.
    #[error("`{effect}` cannot be looked for: {why}")]
    Unavailable {
        /// Its id.
        effect: &'static str,
        /// The missing input.
        why: String,
    },
    /// Two effects that no record distinguishes were asked for together.
    #[error(
        "`{effect}` and `{other}` cannot be in one model: they are the same or exact equivalents; leave one \
         out"
    )]
    NotTogether {
        /// Its id.
        effect: &'static str,
        /// That of the effect before it.
        other: &'static str,
    },
    /// An effect was asked for that is no term of a model.
    #[error(
        "`{effect}` is no effect that a model can have beside the drift coefficients; leave it out"
    )]
    NoTerm {
        /// Its id.
        effect: &'static str,
    },
}

/// The problems of the set-up, in words.
fn problems(result: &Answer) -> String {
    let texts: Vec<String> = result.setup.iter().map(|problem| problem.text()).collect();
    texts.join(" ")
}
