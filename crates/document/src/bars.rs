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

/// A group of bars.
#[derive(Clone, Debug, PartialEq)]
pub struct BarGroup {
    /// Its heading.
    pub label: String,
    /// The bars.
    pub bars: Vec<Bar>,
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
