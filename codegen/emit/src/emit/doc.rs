//! Doc comments: escaped, wrapped, as attributes.

use proc_macro2::TokenStream;
use quote::quote;

use crate::program::{Element, Group};

/// Width of the text of a doc comment.
const WIDTH: usize = 92;

/// Lines of a doc comment in the making.
#[derive(Default)]
pub(super) struct Doc {
    lines: Vec<String>,
}

impl Doc {
    /// A comment of one paragraph; `text` is Markdown.
    pub(super) fn of(text: &str) -> Self {
        let mut doc = Self::default();
        doc.paragraph(text);
        doc
    }

    /// A paragraph after an empty line; `text` is Markdown.
    pub(super) fn paragraph(&mut self, text: &str) {
        if text.is_empty() {
            return;
        }
        if !self.lines.is_empty() {
            self.lines.push(String::new());
        }
        self.wrap("", "", text);
    }

    /// A heading with a list.
    pub(super) fn list(&mut self, heading: &str, items: &[String]) {
        self.paragraph(&format!("# {heading}"));
        for item in items {
            self.wrap("- ", "  ", item);
        }
    }

    /// Text right below what is there.
    pub(super) fn lines_of(&mut self, text: &str) {
        self.wrap("", "", text);
    }

    /// Attributes that the formatter prints as `///`.
    pub(super) fn tokens(&self) -> TokenStream {
        let lines = self.lines.iter().map(|line| {
            if line.is_empty() {
                String::new()
            } else {
                format!(" {line}")
            }
        });
        quote!(#(#[doc = #lines])*)
    }

    fn wrap(&mut self, first: &str, rest: &str, text: &str) {
        let mut line = first.to_owned();
        let mut is_empty = true;
        for word in text.split_whitespace() {
            if !is_empty && line.len() + 1 + word.len() > WIDTH {
                self.lines
                    .push(std::mem::replace(&mut line, rest.to_owned()));
                is_empty = true;
            }
            if !is_empty {
                line.push(' ');
            }
            line.push_str(word);
            is_empty = false;
        }
        self.lines.push(line);
    }
}

/// Text of a derivation as Markdown: only its code spans are formatting, and addresses
/// become links.
pub(super) fn escape(text: &str) -> String {
    let mut result = String::new();
    let mut is_code = false;
    for (index, word) in text.split_whitespace().enumerate() {
        if index > 0 {
            result.push(' ');
        }
        if !is_code && (word.starts_with("https://") || word.starts_with("http://")) {
            let link = word.trim_end_matches(['.', ',', ';', ')']);
            result.push_str(&format!("<{link}>{}", &word[link.len()..]));
            continue;
        }
        for letter in word.chars() {
            if letter == '`' {
                is_code = !is_code;
            } else if !is_code && matches!(letter, '[' | ']' | '<' | '>' | '*' | '\\') {
                result.push('\\');
            }
            result.push(letter);
        }
    }
    if is_code {
        result.push('`');
    }
    result
}

/// `text` as a sentence, or nothing.
pub(super) fn sentence(text: &str) -> String {
    let text = escape(text);
    let mut letters = text.chars();
    let Some(first) = letters.next() else {
        return String::new();
    };
    // Symbols such as `f1` or `theta_x` keep their case; a comma after a word is none of it.
    let is_word = text.split(' ').next().is_some_and(|word| {
        let word = word.trim_end_matches(['.', ',', ';', ':', '!', '?']);
        word.len() > 1 && word.chars().all(char::is_alphabetic)
    });
    let first = if is_word {
        first.to_ascii_uppercase()
    } else {
        first
    };
    let end = if text.ends_with(['.', '!', '?', ':']) {
        ""
    } else {
        "."
    };
    format!("{first}{}{end}", letters.as_str())
}

/// `names` as code, with commas.
pub(super) fn code_list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names
        .into_iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(", ")
}

/// The units of a group: one, or several in order of first use.
pub(super) fn units(group: &Group) -> String {
    let mut units: Vec<&str> = Vec::new();
    for element in &group.elements {
        if !units.contains(&element.unit.as_str()) {
            units.push(&element.unit);
        }
    }
    units
        .iter()
        .map(|unit| unit_text(unit))
        .collect::<Vec<_>>()
        .join(", ")
}

/// Meaning and unit of one element.
pub(super) fn element(element: &Element) -> Doc {
    let mut meaning = sentence(&element.doc);
    if meaning.ends_with('.') {
        meaning.pop();
    }
    Doc::of(&format!("{meaning} \\[{}\\].", unit_text(&element.unit)))
}

/// A unit, escaped; a pure number is `1`.
pub(super) fn unit_text(unit: &str) -> String {
    if unit.is_empty() {
        "1".to_owned()
    } else {
        escape(unit)
    }
}

#[cfg(test)]
mod tests {
    use super::sentence;

    #[test]
    fn a_sentence_begins_with_a_capital_unless_with_a_symbol() {
        let cases = [
            ("length above 0", "Length above 0."),
            ("angle, from the vertical", "Angle, from the vertical."),
            ("theta_y away from +-90 deg", "theta_y away from +-90 deg."),
            ("f1-f3: rates", "f1-f3: rates."),
            ("x of the bob", "x of the bob."),
            ("sin(x) of the angle", "sin(x) of the angle."),
            ("`rod` by length", "`rod` by length."),
        ];
        for (text, expected) in cases {
            assert_eq!(sentence(text), expected);
        }
    }
}
