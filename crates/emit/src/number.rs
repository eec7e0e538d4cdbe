//! Number types of emitted filters.

/// Number type of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Number {
    /// Single precision, with the factors of the covariance.
    F32,
    /// Double precision, with the covariance itself.
    F64,
}

impl Number {
    /// Its name in Rust.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}
