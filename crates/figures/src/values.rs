//! Named texts for templates: printed numbers and tables.

use std::collections::BTreeMap;

/// Texts by the names of their places in a template.
#[derive(Default)]
pub(crate) struct Values(BTreeMap<String, String>);

impl Values {
    pub(crate) fn put(&mut self, name: impl Into<String>, text: impl Into<String>) {
        self.0.insert(name.into(), text.into());
    }

    pub(crate) fn get(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

/// A number with a fixed number of decimals; zero has no sign.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|digit| matches!(digit, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

/// A number with two significant digits.
pub(crate) fn two_digits(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value.abs()) {
        let decimals = 1.0 - value.abs().max(1e-3).log10().floor();
        fixed(value, decimals.max(0.0) as usize)
    } else {
        format!("{value:.1e}")
    }
}

/// Length of the number that a text begins with: sign, digits, decimals, exponent; zero of a text that begins with none.
pub(crate) fn length_of_number(text: &str) -> usize {
    let digits = |from: usize| {
        let tail = text.get(from..).unwrap_or_default();
        tail.len() - tail.trim_start_matches(|c: char| c.is_ascii_digit()).len()
    };
    let sign = usize::from(text.starts_with(['+', '-']));
    let mut length = sign + digits(sign);
    if length == sign {
        return 0;
    }
    if text[length..].starts_with('.') && digits(length + 1) > 0 {
        length += 1 + digits(length + 1);
    }
    if let Some(exponent) = text[length..].strip_prefix('e') {
        let from = length + 1 + usize::from(exponent.starts_with(['+', '-']));
        if digits(from) > 0 {
            length = from + digits(from);
        }
    }
    length
}

/// Value of a printed number, and the power of ten of its last digit; `None` for that of an integer.
pub(crate) fn parsed(digits: &str) -> Option<(f64, Option<i32>)> {
    let (mantissa, exponent) = digits.split_once('e').unwrap_or((digits, "0"));
    let exponent: i32 = exponent.parse().ok()?;
    let decimals = mantissa.split_once('.').map_or(0, |(_, rest)| rest.len());
    let has_last = digits.contains(['.', 'e']);
    let last = has_last.then(|| exponent - decimals as i32);
    Some((digits.parse().ok()?, last))
}

/// A table of Markdown.
pub(crate) fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let rule = "|---".repeat(header.len());
    let head = format!("| {} |\n{rule}|", header.join(" | "));
    let rows = rows.into_iter();
    rows.fold(head, |text, cells| {
        format!("{text}\n| {} |", cells.join(" | "))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_digits() {
        assert_eq!(fixed(-0.004, 2), "0.00");
        assert_eq!(fixed(-0.006, 2), "-0.01");
        assert_eq!(two_digits(-123.4), "-123");
        assert_eq!(two_digits(0.012_34), "0.012");
        assert_eq!(two_digits(9.96e-5), "1.0e-4");
        assert_eq!(two_digits(0.0), "0.0000");
    }
}
