//! Errors with advice.

/// Advice if a fit does not converge because of the declared noise.
pub(crate) const GYRO_ADVICE: &str = "`gyro_deg_per_h` in [noise] is out of proportion to that of the \
    accelerometers: give 1e-7 or more, the noise of the best gyros";

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
