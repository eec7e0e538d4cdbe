//! Right answers, as data.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::keys::WrongKey;
use crate::error::EvaluationError;

/// The table of right answers and of wrong keys.
#[derive(Deserialize)]
pub(super) struct Table {
    right: BTreeMap<String, Right>,
    pub(super) key: Vec<WrongKey>,
}

impl Table {
    pub(super) fn read() -> Result<Self, EvaluationError> {
        let read = toml::from_str(include_str!("right.toml"));
        read.map_err(|error| EvaluationError::RightAnswers {
            reason: error.to_string(),
        })
    }

    /// The answer of a name.
    pub(super) fn right(&self, name: &str) -> Result<Right, EvaluationError> {
        let right = self.right.get(name).cloned();
        right.ok_or_else(|| EvaluationError::RightAnswers {
            reason: format!("it has no `{name}`"),
        })
    }
}

/// The answer that is right for a record, in names: the id of an effect of the catalogue or of its family
/// (`accel_i.noise`), which stands for its exact equivalents too; the kind of an error of the set-up (`latitude`);
/// `bench`, a refusal by the reader of the bench file; `several-platforms`; and `unlisted`, which is said by
/// residuals that are not white or a probability above a half of a cause outside of the catalogue.
#[derive(Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Right {
    /// What the record has: each is told by a name of one of these lists. Nothing, if there are none.
    pub(super) each: Vec<Names>,
    /// Names that tell all of it at once.
    #[serde(default)]
    pub(super) whole: Names,
    /// Names that are not false, but not the answer either.
    #[serde(default)]
    pub(super) near: Names,
    /// Names that may be told beside.
    #[serde(default)]
    pub(super) beside: Names,
    /// Whether it is enough that confidence sets hold it; otherwise findings have its names.
    #[serde(default)]
    pub(super) in_set: bool,
    /// Whether it may be left untold.
    #[serde(default)]
    pub(super) silent: Silent,
}

/// Records of which nothing need be told.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Silent {
    /// None.
    #[default]
    Never,
    /// Those that show less than [`VISIBLE`].
    Faint,
    /// All.
    Always,
}

/// Strength from which on a wrong number must be told: the root of twice the log-likelihood that it costs.
pub(super) const VISIBLE: f64 = 8.0;

pub(super) const UNLISTED: &str = "unlisted";
pub(super) const BENCH: &str = "bench";
pub(super) const SEVERAL: &str = "several-platforms";

/// Names of which one is enough.
pub(super) type Names = Vec<String>;

impl Right {
    /// Nothing is to be told.
    pub(super) fn nothing() -> Self {
        Self {
            silent: Silent::Always,
            ..Self::default()
        }
    }

    /// The same in words.
    pub(super) fn words(&self) -> String {
        if self.each.is_empty() {
            return "nothing".to_owned();
        }
        let each: Vec<String> = self.each.iter().map(|names| names.join(" or ")).collect();
        let whole = self.whole.iter().map(|name| format!(", or {name}"));
        let whole: String = whole.collect();
        let place = if self.in_set { ", in a set" } else { "" };
        let silence = match self.silent {
            Silent::Never => String::new(),
            Silent::Faint => format!("; nothing below {VISIBLE} sigma"),
            Silent::Always => "; or nothing".to_owned(),
        };
        format!("{}{whole}{place}{silence}", each.join(", and "))
    }
}
