//! Ranges of numbers in files.

/// The range that a number must be in. All numbers are finite.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Bound {
    /// Any finite number.
    Finite,
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NotNegative,
    /// From the first to the second, both included.
    Within(f64, f64),
}

impl Bound {
    /// An angle in degrees: beyond a turn it is a mistake in the unit.
    pub const ANGLE_DEG: Self = Self::Within(-360.0, 360.0);

    /// Whether a number is finite and within the bound.
    #[must_use]
    pub fn holds(self, number: f64) -> bool {
        number.is_finite()
            && match self {
                Self::Finite => true,
                Self::Positive => number > 0.0,
                Self::NotNegative => number >= 0.0,
                Self::Within(low, high) => (low..=high).contains(&number),
            }
    }

    /// The bound in words.
    #[must_use]
    pub fn describe(self) -> String {
        match self {
            Self::Finite => "a finite number".to_owned(),
            Self::Positive => "a finite number greater than 0".to_owned(),
            Self::NotNegative => "a finite number not less than 0".to_owned(),
            Self::Within(low, high) => format!("a number from {low} to {high}"),
        }
    }
}
