//! Estimates side by side.

use crate::Tint;

/// Estimates of several models side by side, as numbers and on a scale of each quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimates {
    /// Its title.
    pub title: String,
    /// The models with their colours.
    pub models: Vec<(String, Tint)>,
    /// The quantities.
    pub rows: Vec<EstimateRow>,
    /// Head of the column of remarks; may be empty.
    pub note_head: String,
}

impl Estimates {
    /// Estimates of these models, without a column of remarks.
    #[must_use]
    pub fn new(
        title: &str,
        models: &[(&str, Tint)],
        rows: impl IntoIterator<Item = EstimateRow>,
    ) -> Self {
        let models = models.iter();
        Self {
            title: title.to_owned(),
            models: models
                .map(|(name, tint)| ((*name).to_owned(), *tint))
                .collect(),
            rows: rows.into_iter().collect(),
            note_head: String::new(),
        }
    }
}

/// The estimates of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimateRow {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// An estimate of each model.
    pub values: Vec<ValueWithSigma>,
    /// A remark; may be empty.
    pub note: String,
    /// Whether the remark is to be noticed.
    pub strong: bool,
}

/// An estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueWithSigma {
    /// The value.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

impl EstimateRow {
    /// A quantity with value and standard deviation of each model, without a remark.
    #[must_use]
    pub fn new(name: &str, unit: &str, values: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let values = values.into_iter();
        Self {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: values
                .map(|[value, sigma]| ValueWithSigma { value, sigma })
                .collect(),
            note: String::new(),
            strong: false,
        }
    }
}
