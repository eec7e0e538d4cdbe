//! Baseline methods: established tests and selection rules, applied to the same records.
//!
//! All four start from the fit of the nominal model with the declared noise, which in the population
//! cells is the true one. Two are tests only, two select effects. They use scores and information of
//! the same signatures as the diagnosis, with the fitted parameters projected out.

mod bic;
mod stls;

use gyrocal::Effect;
use gyrocal::effect::Role;
use gyrocal_record::Record;
use gyrocal_statistics::{StatisticsError, autocorrelation, nis};
use serde::{Deserialize, Serialize};

use crate::projection::ProjectedScores;
use crate::signature::{Signature, SignatureColumns};

/// Probability of a false alarm of a test, and lags of the portmanteau test: the usual choice for thousands of values.
const LEVEL: f64 = 0.01;
const LAGS: usize = 20;

/// Number of onsets of a step or an attitude jump in the library: 5 % of the record apart.
const ONSETS: usize = 20;

/// Number of time constants of a warm-up in the library, from half an hour to half the record.
const TIME_CONSTANTS: usize = 6;
const SHORTEST_TIME_CONSTANT_H: f64 = 0.5;

/// A method for comparison with the diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BaselineMethod {
    /// The mean of the normalised innovations squared over the record, two-sided (Bar-Shalom, Li and Kirubarajan,
    /// Estimation with Applications to Tracking and Navigation, 2001, 5.4).
    Nis,
    /// The portmanteau test over all pairs of axes (Ljung and Box, Biometrika 65, 1978; Hosking's form for several
    /// series, 1980).
    LjungBox,
    /// Forward selection by the Bayesian information criterion.
    Bic,
    /// Sequentially thresholded least squares.
    Stls,
}

impl BaselineMethod {
    /// All methods.
    pub const ALL: [Self; 4] = [Self::Nis, Self::LjungBox, Self::Bic, Self::Stls];

    /// Name on the command line and in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nis => "nis",
            Self::LjungBox => "ljung-box",
            Self::Bic => "bic",
            Self::Stls => "stls",
        }
    }

    /// `true` for a method that selects effects, `false` for a test.
    #[must_use]
    pub fn identifies_effects(self) -> bool {
        matches!(self, Self::Bic | Self::Stls)
    }

    /// Applies the method; returns the result and the selected terms.
    pub(crate) fn apply(
        self,
        scores: &ProjectedScores,
        library: &[LibraryEntry],
    ) -> (BaselineResult, Vec<Term>) {
        let detection = |test: Result<f64, StatisticsError>| BaselineResult {
            detected: test.is_ok_and(|p_value| p_value < LEVEL),
            names: Vec::new(),
        };
        let selected = match self {
            // The nine fitted coefficients take nine of thousands of degrees of freedom, which shifts the mean
            // by less than a tenth of its sigma.
            Self::Nis => {
                let test = nis(&scores.whitened, LEVEL).map(|nis| nis.p_value);
                return (detection(test), Vec::new());
            }
            Self::LjungBox => {
                let test = autocorrelation(&scores.whitened, LAGS, LEVEL).map(|test| test.p_value);
                return (detection(test), Vec::new());
            }
            Self::Bic => bic::select(scores, library),
            Self::Stls => stls::select(scores, library),
        };
        let mut names: Vec<String> = Vec::new();
        for id in selected.iter().map(|term| library[term.entry].effect.id) {
            if !names.iter().any(|name| name == id) {
                names.push(id.to_owned());
            }
        }
        let detected = !names.is_empty();
        (BaselineResult { detected, names }, selected)
    }
}

/// Result of a baseline method on one record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BaselineResult {
    /// `true` if the method rejects the nominal model.
    pub detected: bool,
    /// Selected effects, strongest first; empty for tests.
    pub names: Vec<String>,
}

/// One size of an effect of the library: the number of its entry, and that of its column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Term {
    pub(crate) entry: usize,
    pub(crate) column: usize,
}

/// An effect at one onset or time constant.
#[derive(Debug, Clone)]
pub(crate) struct LibraryEntry {
    pub(crate) effect: &'static Effect,
    pub(crate) has_shape: bool,
    pub(crate) signature: Signature,
}

impl LibraryEntry {
    /// Its sizes, given its number.
    fn terms(&self, entry: usize) -> impl Iterator<Item = Term> {
        let columns = self.signature.columns.iter();
        columns.map(move |&column| Term { entry, column })
    }
}

/// All effects that have a signature; those with an onset or a time constant once for each point of a
/// grid.
pub(crate) fn library(
    effects: &[&'static Effect],
    record: &Record,
    columns: &mut SignatureColumns,
) -> Vec<LibraryEntry> {
    let duration_s = match record.time_s.as_slice() {
        [first, .., last] => last - first,
        _ => 0.0,
    };
    let onsets = (1..=ONSETS).map(|i| duration_s * i as f64 / (ONSETS + 1) as f64);
    let longest_h = 0.5 * duration_s / 3600.0;
    let ratio = longest_h / SHORTEST_TIME_CONSTANT_H;
    let time_constants = (0..TIME_CONSTANTS).map(|i| {
        let place = i as f64 / (TIME_CONSTANTS - 1) as f64;
        SHORTEST_TIME_CONSTANT_H * libm::pow(ratio, place)
    });
    let mut library = Vec::new();
    for effect in effects {
        let shapes: Vec<Option<f64>> = match effect.shape().map(|shape| shape.role) {
            Some(Role::TimeConstant(_)) => time_constants.clone().map(Some).collect(),
            Some(_) => onsets.clone().map(Some).collect(),
            None => vec![None],
        };
        for shape in shapes {
            if let Some(signature) = columns.signature(effect, record, shape) {
                library.push(LibraryEntry {
                    effect,
                    has_shape: shape.is_some(),
                    signature,
                });
            }
        }
    }
    library
}

#[cfg(test)]
mod tests;
