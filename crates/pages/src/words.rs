//! Words and numbers in sentences.

use gyrocal_document::{Item, Section};
use gyrocal_statistics::format;

/// A specific force in µg.
pub(crate) fn micro_g(force_g: f64) -> String {
    format!("{} µg", format::short(1e6 * force_g, 2))
}

/// `a, b and c`.
pub(crate) fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [head @ .., last] => format!("{} and {last}", head.join(", ")),
    }
}

/// A section.
pub(crate) fn section(id: &str, title: &str, lead: &str, items: Vec<Item>) -> Section {
    Section {
        id: id.to_owned(),
        title: title.to_owned(),
        lead: lead.to_owned(),
        items,
    }
}
