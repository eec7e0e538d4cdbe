//! Texts without letters that a reader does not see.

/// The text with control characters and marks of direction as `\u{…}`: an HTML page would drop or obey
/// them.
pub(super) fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        if is_hidden(letter) {
            shown.extend(letter.escape_unicode());
        } else {
            shown.push(letter);
        }
    }
    shown
}

fn is_hidden(letter: char) -> bool {
    (letter.is_control() && letter != '\n')
        || matches!(letter, '\u{200B}'..='\u{200F}' | '\u{202A}'..='\u{202E}'
            | '\u{2060}'..='\u{206F}' | '\u{FEFF}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_of_direction_are_shown() {
        assert_eq!(printable("a\u{202E}b\u{7}"), "a\\u{202e}b\\u{7}");
        assert_eq!(printable("37 µg ± 2"), "37 µg ± 2");
    }
}
