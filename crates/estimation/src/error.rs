use core::fmt;

/// Failure of a filter. Unless its variant states that nothing has changed, the filter is unusable:
/// start again from a known state.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum EstimationError {
    /// A variance or pivot of the covariance is not positive: a prior sigma is zero, or rounding
    /// or underflow won.
    NotPositiveDefinite {
        /// Index of the state whose pivot failed.
        state: usize,
    },
    /// The noise variance of an output is not positive and finite; a noise so small that its
    /// square underflows counts. The filter is unchanged.
    InvalidNoise {
        /// Index of the output.
        output: usize,
    },
    /// An update would cancel more digits than the number type has: the prior is too wide
    /// against the noise for [`crate::Covariance`]. The measurement was not used.
    LostPrecision {
        /// Index of the output.
        output: usize,
    },
    /// A prediction or an innovation is infinite or NaN: the model was evaluated outside its
    /// domain, or the prior is too wide for the step.
    NotFinite {
        /// The quantity.
        quantity: &'static str,
    },
    /// An argument has no meaning; the filter is unchanged.
    InvalidArgument {
        /// The argument and its expected value.
        expected: &'static str,
    },
}

impl fmt::Display for EstimationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotPositiveDefinite { state } => write!(
                f,
                "the covariance is not positive definite at state {state}; \
                 check that prior sigmas are positive and of sensible size, or carry the covariance as factors"
            ),
            Self::InvalidNoise { output } => write!(
                f,
                "the noise variance of output {output} is not positive and finite; \
                 check the declared noise"
            ),
            Self::LostPrecision { output } => write!(
                f,
                "the prior is too wide against the noise of output {output} for this precision; \
                 narrow the prior, shorten the first step, or carry the covariance as factors"
            ),
            Self::NotFinite { quantity } => write!(
                f,
                "{quantity} is not finite; the model has left its domain, \
                 use a shorter step or a narrower prior"
            ),
            Self::InvalidArgument { expected } => {
                write!(f, "invalid argument: expected {expected}")
            }
        }
    }
}

impl core::error::Error for EstimationError {}
