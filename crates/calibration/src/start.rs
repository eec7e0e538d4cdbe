//! Starts of a fit.

use gyrocal::FilterSettings;

/// Noise of the gyros over the declared one in a filter that follows the samples more closely.
const LOOSE: f64 = 30.0;

/// How the initial guess of a fit is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Start {
    /// By growing windows even if the filter does not diverge.
    pub(crate) careful: bool,
    /// By a filter that follows the samples more closely: what the model lacks does not lead it astray.
    pub(crate) loose: bool,
    /// In stages where a window has no solution: slow, and only for records that no other start fits.
    pub(crate) staged: bool,
}

impl Start {
    /// The usual one, sufficient for nearly every record.
    pub(crate) const FILTERED: Self = Self {
        careful: false,
        loose: false,
        staged: false,
    };

    pub(crate) const CAREFUL: Self = Self {
        careful: true,
        ..Self::FILTERED
    };

    /// The last one, if all others fail.
    pub(crate) const STAGED: Self = Self {
        staged: true,
        ..Self::CAREFUL
    };

    /// Those that are tried where the fit from the usual one is poor.
    pub(crate) const OTHERS: [Self; 3] = [
        Self::CAREFUL,
        Self {
            loose: true,
            ..Self::FILTERED
        },
        Self {
            loose: true,
            ..Self::CAREFUL
        },
    ];

    /// The same by growing windows.
    pub(crate) fn carefully(self) -> Self {
        Self {
            careful: true,
            ..self
        }
    }

    /// Settings of the filter that makes the guess.
    pub(crate) fn settings(self, settings: &FilterSettings<f64>) -> FilterSettings<f64> {
        let factor = if self.loose { LOOSE } else { 1.0 };
        FilterSettings {
            drift_noise_deg_per_h: factor * settings.drift_noise_deg_per_h,
            ..*settings
        }
    }
}
