//! Stages of a diagnosis, for programs that show how long it will take.

/// A stage of a diagnosis that begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stage {
    /// The noise audit, and the fit of the nominal model.
    Audit,
    /// The search for effects.
    Search,
    /// Residual tests and cross-validation.
    Validation,
    /// The answer.
    Answer,
}

impl Stage {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Audit => "noise audit",
            Self::Search => "search",
            Self::Validation => "validation",
            Self::Answer => "answer",
        }
    }

    /// Share of the time of a diagnosis that has passed when the stage begins, for an estimate of the
    /// time left: of records with one effect, on which most of the time is taken by its search. Every
    /// stage takes time in proportion to the rows.
    #[must_use]
    pub fn share_before(self) -> f64 {
        match self {
            Self::Audit => 0.0,
            Self::Search => 0.06,
            Self::Validation => 0.82,
            Self::Answer => 0.95,
        }
    }
}
