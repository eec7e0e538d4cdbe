//! Errors with advice.

/// Advice if a fit does not converge; `tiny_gyro_noise` tells whether the bench file declares an implausibly small
/// noise of the gyros.
pub(crate) fn on_no_fit(tiny_gyro_noise: bool) -> &'static str {
    match tiny_gyro_noise {
        true => {
            "`gyro_deg_per_h` in [noise] is out of proportion to that of the accelerometers: give 1e-7 or more, the \
             noise of the best gyros"
        }
        false => {
            "check the record for an attitude jump, a restart or a run of bad values: `gyrocal calibrate --streaming` \
             shows the misfit of one pass; leave out the first hours if a gyro warms up by degrees an hour, and the \
             angles that belong to them"
        }
    }
}

/// Makes errors diagnostics with a code, whose help is their `advice()`.
macro_rules! advised {
    ($($error:ty, $code:literal;)+) => {$(
        impl miette::Diagnostic for $error {
            fn code<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
                Some(Box::new($code))
            }

            fn help<'a>(&'a self) -> Option<Box<dyn std::fmt::Display + 'a>> {
                Some(Box::new(self.advice()))
            }
        }

        impl From<$error> for $crate::Failure {
            fn from(error: $error) -> Self {
                Self::Work(error.into())
            }
        }
    )+};
}

pub(crate) use advised;
