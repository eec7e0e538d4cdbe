use gyrocal::EstimationError;

/// Why a record could not be calibrated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// The record has fewer rows with a measured value than the filter has states.
    #[error(
        "the record has {found} rows with a value of an accelerometer, expected at least \
         {expected}, the number of states; record for longer"
    )]
    TooShort {
        /// Rows in which an accelerometer has a value.
        found: usize,
        /// Rows that are needed.
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
    /// Rows of the records, and attitudes of the gyros that go with them, are not as many.
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
    /// The filter could not go on; the source says why.
    #[error("the filter stopped at row {row} of the data (t = {time_s} s)")]
    Filter {
        /// Row of the data, counted from 1.
        row: usize,
        /// Time of that row, s.
        time_s: f64,
        /// What the filter said.
        source: EstimationError,
    },
    /// The streaming filter needs to be told how the platform lies.
    #[error(
        "the bench file gives no initial angles, which the streaming filter needs; give \
         `initial_angles_deg` or use the batch estimator"
    )]
    NoAttitude,
    /// The streaming filter reads one record.
    #[error("{found} records, the streaming filter reads one; use the batch estimator")]
    OneRecord {
        /// Number of records.
        found: usize,
    },
    /// The bench does not say how the platform lies, and no early row tells where up is.
    #[error(
        "the bench file gives no initial angles, and no row of the first 20 minutes has all three \
         accelerometers, so the platform cannot be levelled; give `initial_angles_deg` or record \
         all axes from the start"
    )]
    NotLevelled,
    /// No azimuth that was tried led to a solution.
    #[error(
        "none of {starts} azimuths that were tried fits the record; give `initial_angles_deg`, or \
         check the latitude and that up is positive"
    )]
    NoAzimuth {
        /// Azimuths that were tried.
        starts: usize,
    },
    /// A pass over a record could not be made; the source says why.
    #[error("the batch estimator could not pass over record {run}")]
    Pass {
        /// Number of the record, counted from 1.
        run: usize,
        /// What it said.
        source: EstimationError,
    },
    /// No step lowered the cost any more, though the solution was not reached.
    #[error(
        "the batch estimator stopped after {iterations} steps: no shorter step fits the record \
         better; check latitude, initial angles and units, or give priors nearer to the truth"
    )]
    NoDescent {
        /// Steps that were made.
        iterations: usize,
    },
    /// The estimate still moved after the last step that was allowed.
    #[error(
        "the batch estimator did not converge in {iterations} steps (the last one was {last_step:.1} \
         standard deviations long); check latitude, initial angles and units, or give priors \
         nearer to the truth"
    )]
    NotConverged {
        /// Steps that were made.
        iterations: usize,
        /// Length of the last one in standard deviations of the whole problem.
        last_step: f64,
    },
    /// One of several records could not be taken; the source says why.
    #[error("record {run} of {runs} cannot be calibrated")]
    OfSeveral {
        /// Number of the record, counted from 1.
        run: usize,
        /// Number of records.
        runs: usize,
        /// What is wrong with it.
        source: Box<CalibrationError>,
    },
    /// Rows cannot be averaged over such intervals.
    #[error(
        "means over {found_s} s were asked for, expected from {least_s} s, two rows of the record, \
         to {most_s} s"
    )]
    AveragingInterval {
        /// The interval that was asked for, s.
        found_s: f64,
        /// The shortest, s.
        least_s: f64,
        /// The longest, s.
        most_s: f64,
    },
    /// Rounding left the coefficients a covariance that no errors can have: variances are
    /// positive, but that of some combination of coefficients is not.
    #[error(
        "the covariance of the coefficients is not positive definite after the last row: the \
         prior is too wide for what the record says; narrow it, record for longer, or carry the \
         covariance as factors"
    )]
    NotPositiveDefinite,
}

impl CalibrationError {
    /// A failed pass over the record of this index, counted from 0.
    pub(crate) fn pass(index: usize, source: EstimationError) -> Self {
        Self::Pass {
            run: index + 1,
            source,
        }
    }

    /// Says which of several records an error is about, `index` counted from 0.
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
