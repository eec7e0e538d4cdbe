//! What is usually done instead, on the same records.
//!
//! All four start from the nominal model at its best fit with the noise that is declared, which in
//! the cells is the true one. Two only say that something is wrong, two name it. They get the same
//! linear bank as the diagnosis: signatures with what the fit takes up projected out.

mod bic;
mod ljung_box;
mod nis;
mod stls;

use gyrocal::Effect;
use gyrocal::effect::Role;
use gyrocal_record::Record;
use serde::{Deserialize, Serialize};

use crate::bank::Bank;
use crate::signature::{Columns, Signature};

/// Onsets of steps and of knocks in the library: 5 % of the record apart.
const ONSETS: usize = 20;

/// Time constants of warm-ups, from half an hour to half the record.
const TIME_CONSTANTS: usize = 6;
const SHORTEST_TIME_CONSTANT_H: f64 = 0.5;

/// A method that the diagnosis is compared with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// The mean of the normalised innovations squared.
    Nis,
    /// The portmanteau test of Ljung and Box.
    LjungBox,
    /// Forward selection by the Bayesian information criterion.
    Bic,
    /// Sequentially thresholded least squares.
    Stls,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Nis, Self::LjungBox, Self::Bic, Self::Stls];

    /// Its name on the command line and in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Nis => "nis",
            Self::LjungBox => "ljung-box",
            Self::Bic => "bic",
            Self::Stls => "stls",
        }
    }

    /// Whether it names causes.
    #[must_use]
    pub fn names(self) -> bool {
        matches!(self, Self::Bic | Self::Stls)
    }

    pub(crate) fn call(self, bank: &Bank, library: &[Entry]) -> (Called, Vec<usize>) {
        let chosen = match self {
            Self::Nis => return (Called::detection(nis::detects(bank)), Vec::new()),
            Self::LjungBox => return (Called::detection(ljung_box::detects(bank)), Vec::new()),
            Self::Bic => bic::select(bank, library),
            Self::Stls => stls::select(bank, library),
        };
        let mut names: Vec<String> = Vec::new();
        for entry in &chosen {
            let id = library[*entry].effect.id;
            if !names.iter().any(|name| name == id) {
                names.push(id.to_owned());
            }
        }
        let detected = !names.is_empty();
        (Called { detected, names }, chosen)
    }
}

/// What a method says of a record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Called {
    /// Whether something is wrong.
    pub detected: bool,
    /// What, the strongest first; nothing by methods that only detect.
    pub names: Vec<String>,
}

impl Called {
    fn detection(detected: bool) -> Self {
        Self {
            detected,
            names: Vec::new(),
        }
    }
}

/// One effect at one onset or time constant.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) effect: &'static Effect,
    pub(crate) searched_shape: bool,
    pub(crate) signature: Signature,
}

/// Every effect that has a signature; those with an onset or a time constant once for each point
/// of a grid.
pub(crate) fn library(
    effects: &[&'static Effect],
    record: &Record,
    columns: &mut Columns,
) -> Vec<Entry> {
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
                library.push(Entry {
                    effect,
                    searched_shape: shape.is_some(),
                    signature,
                });
            }
        }
    }
    library
}

#[cfg(test)]
mod tests;
