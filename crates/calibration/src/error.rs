//! Errors of this crate.

use gyrocal::EstimationError;
use gyrocal_inference::{PassError, Stopped};

/// Errors of this crate.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The record has fewer rows with a measured value than the model has states.
    #[error(
        "the record has {found} rows with a value of an accelerometer, expected at least \
         {expected}, the number of states; record for longer"
    )]
    TooShort {
        /// Number of rows in which an accelerometer has a value.
        found: usize,
        /// Least number of such rows.
        expected: usize,
    },
    /// The columns of the record differ in length.
    #[error("the record has {times} times and {samples} samples, expected as many of each")]
    UnequalLengths {
        /// Number of times.
        times: usize,
        /// Number of accelerometer samples.
        samples: usize,
    },
    /// The numbers of rows and of attitudes of the gyros differ.
    #[error(
        "{rows} rows and {attitudes} attitudes of the gyros, expected one attitude for each row of \
         each record"
    )]
    GyroAxes {
        /// Number of rows.
        rows: usize,
        /// Number of attitudes.
        attitudes: usize,
    },
    /// The filter stopped at a row; the source is its error.
    #[error("the filter stopped at row {row} of the data (t = {time_s} s)")]
    Filter {
        /// Row of the data, counted from 1.
        row: usize,
        /// Time of that row, s.
        time_s: f64,
        /// Error of the filter.
        source: EstimationError,
    },
    /// The bench description declares no initial attitude, which the streaming filter needs.
    #[error(
        "the bench file gives no initial angles, which the streaming filter needs; give \
         `initial_angles_deg` or use the batch estimator"
    )]
    NoAttitude,
    /// Several records were given to the streaming filter, which takes one.
    #[error("{found} records, the streaming filter reads one; use the batch estimator")]
    OneRecord {
        /// Number of records.
        found: usize,
    },
    /// The bench description declares no initial attitude, and no early row has all three
    /// accelerometers, from which the platform could be levelled.
    #[error(
        "the bench file gives no initial angles, and no row of the first 20 minutes has all three \
         accelerometers, so the platform cannot be levelled; give `initial_angles_deg` or record \
         all axes from the start"
    )]
    NotLevelled,
    /// No solution was found from any azimuth.
    #[error(
        "none of {starts} azimuths that were tried fits the record; give `initial_angles_deg`, or \
         check the latitude and that up is positive"
    )]
    NoAzimuth {
        /// Number of azimuths tried.
        starts: usize,
    },
    /// A pass of the batch estimator over a record failed; the source is its error.
    #[error("the batch estimator could not pass over record {run}")]
    Pass {
        /// Number of the record, counted from 1.
        run: usize,
        /// Error of the pass.
        source: EstimationError,
    },
    /// No shortened step lowered the cost before convergence.
    #[error(
        "the batch estimator stopped after {iterations} steps: no shorter step fits the record \
         better; check latitude, initial angles and units, or give priors nearer to the truth"
    )]
    NoDescent {
        /// Number of steps made.
        iterations: usize,
    },
    /// The iteration did not converge within the largest number of steps.
    #[error(
        "the batch estimator did not converge in {iterations} steps (the last one was {last_step:.1} \
         standard deviations long); check latitude, initial angles and units, or give priors \
         nearer to the truth"
    )]
    NotConverged {
        /// Number of steps made.
        iterations: usize,
        /// Length of the last one in standard deviations of the whole problem.
        last_step: f64,
    },
    /// One of several records has an error; the source is that error.
    #[error("record {run} of {runs} cannot be calibrated")]
    OfSeveral {
        /// Number of the record, counted from 1.
        run: usize,
        /// Number of records.
        runs: usize,
        /// Error of the record.
        source: Box<CalibrationError>,
    },
    /// No record was given.
    #[error("there is no record; give at least one")]
    NoRecords,
    /// The bench description of a record contradicts that of the first.
    #[error(
        "the bench file of record {} contradicts that of the first record in {key}: one platform has one; \
         give the records that belong together",
        record + 1
    )]
    UnlikeBenches {
        /// Index of the record.
        record: usize,
        /// Key that differs.
        key: &'static str,
    },
    /// The averaging interval is out of range.
    #[error(
        "means over {found_s} s were asked for, expected from {least_s} s, two rows of the record, \
         to {most_s} s"
    )]
    AveragingInterval {
        /// The requested interval, s.
        found_s: f64,
        /// The shortest, s.
        least_s: f64,
        /// The longest, s.
        most_s: f64,
    },
    /// The job was asked to end.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// The covariance of the coefficients is not positive definite: rounding errors exceed the
    /// variance of a combination of coefficients.
    #[error(
        "the covariance of the coefficients is not positive definite after the last row: the \
         prior is too wide for what the record says; narrow it, record for longer, or carry the \
         covariance as factors"
    )]
    NotPositiveDefinite,
}

impl CalibrationError {
    /// A failed pass over the record of this index, counted from 0.
    pub(crate) fn pass(index: usize, error: PassError) -> Self {
        match error {
            PassError::Estimation(source) => Self::Pass {
                run: index + 1,
                source,
            },
            PassError::Stopped(stopped) => stopped.into(),
        }
    }

    /// Adds the number of the record, `index` counted from 0, if there are several.
    pub(crate) fn of_record(self, index: usize, runs: usize) -> Self {
        if runs == 1 {
            return self;
        }
        Self::OfSeveral {
            run: index + 1,
            runs,
            source: Box::new(self),
        }
    }
}
