//! Words of answers, and numbers in them.

use gyrocal_document::{Item, Words};
use gyrocal_statistics::format;

/// The tables of an answer, and its other words.
pub(crate) fn by_kind(words: Vec<Words>) -> (Vec<Item>, Vec<Item>) {
    let all = words.into_iter().map(Item::Words);
    all.partition(|item| matches!(item, Item::Words(Words::Table(_))))
}

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

/// The first letter as a capital.
pub(crate) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}
