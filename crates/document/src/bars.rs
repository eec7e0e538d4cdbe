//! Horizontal bars.

use crate::Tint;

/// Horizontal bars in groups, with a threshold.
#[derive(Clone, Debug, PartialEq)]
pub struct Bars {
    /// Its title.
    pub title: String,
    /// Quantity of the bars, with its unit.
    pub quantity: String,
    /// The threshold and its name.
    pub threshold: Option<(f64, String)>,
    /// The groups from top to bottom.
    pub groups: Vec<BarGroup>,
    /// A sentence on what is left out; may be empty.
    pub omitted: String,
}

impl Bars {
    /// Bars without a threshold, of which none is left out.
    #[must_use]
    pub fn new(title: &str, quantity: &str, groups: Vec<BarGroup>) -> Self {
        Self {
            title: title.to_owned(),
            quantity: quantity.to_owned(),
            threshold: None,
            groups,
            omitted: String::new(),
        }
    }
}

/// A group of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    /// Its heading.
    pub label: String,
    /// The bars.
    pub bars: Vec<Bar>,
}

impl BarGroup {
    /// A group with a heading.
    #[must_use]
    pub fn new(label: &str, bars: impl IntoIterator<Item = Bar>) -> Self {
        Self {
            label: label.to_owned(),
            bars: bars.into_iter().collect(),
        }
    }
}

/// A bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Its name.
    pub label: String,
    /// Its length; nan where it was not determined.
    pub value: f64,
    /// Its colour.
    pub tint: Tint,
    /// A remark beside it; may be empty.
    pub note: String,
}
