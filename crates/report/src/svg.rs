//! SVG as text: elements, attributes, escaping and numbers.

use std::fmt::Display;

use crate::geometry::Point;

/// An element that is being written.
pub(crate) struct Element {
    name: &'static str,
    text: String,
}

impl Element {
    pub(crate) fn new(name: &'static str) -> Self {
        Self {
            name,
            text: format!("<{name}"),
        }
    }

    /// Adds an attribute.
    pub(crate) fn with(mut self, attribute: &str, value: impl Display) -> Self {
        let value = escaped(&value.to_string());
        self.text.push_str(&format!(" {attribute}=\"{value}\""));
        self
    }

    /// Adds a coordinate or a length.
    pub(crate) fn with_px(self, attribute: &str, px: f64) -> Self {
        self.with(attribute, coordinate(px))
    }

    /// Adds points of a line or an outline.
    pub(crate) fn with_points(self, points: &[Point]) -> Self {
        let pairs = points
            .iter()
            .map(|(x, y)| format!("{},{}", coordinate(*x), coordinate(*y)));
        self.with("points", pairs.collect::<Vec<_>>().join(" "))
    }

    /// The element without content.
    pub(crate) fn empty(self) -> String {
        self.text + "/>\n"
    }

    /// The element with text in it.
    pub(crate) fn containing_text(self, text: &str) -> String {
        format!("{}>{}</{}>\n", self.text, escaped(text), self.name)
    }

    /// The element with other elements in it.
    pub(crate) fn containing(self, elements: &str) -> String {
        format!("{}>\n{elements}</{}>\n", self.text, self.name)
    }
}

/// A coordinate to a tenth of a pixel.
fn coordinate(px: f64) -> f64 {
    // The sum turns a negative zero into a positive one.
    (10.0 * px).round() / 10.0 + 0.0
}

/// Text as XML: markup escaped, forbidden characters replaced by spaces.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\u{FFFE}' | '\u{FFFF}' => escaped.push(' '),
            _ if letter.is_control() => escaped.push(' '),
            _ => escaped.push(letter),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_and_text_are_escaped() {
        let element = Element::new("text").with("class", "\"a\" & b");
        assert_eq!(
            element.containing_text("x < y\u{1}"),
            "<text class=\"&quot;a&quot; &amp; b\">x &lt; y </text>\n"
        );
    }

    #[test]
    fn coordinates_have_one_decimal_and_zero_has_no_sign() {
        let points = [(0.04, -0.04), (12.0, 3.149)];
        assert_eq!(
            Element::new("polyline").with_points(&points).empty(),
            "<polyline points=\"0,0 12,3.1\"/>\n"
        );
    }
}
