//! Numbers that are no JSON: `NaN`, `Infinity`, and those beyond `f64`.

/// The text with such numbers outside of strings put between quotes, if there are any.
pub(super) fn unreadable_as_texts(text: &str) -> Option<String> {
    if !text.contains("NaN") && !text.contains("Infinity") && !has_overflow(text) {
        return None;
    }
    let mut result = String::with_capacity(text.len() + 64);
    let mut changed = false;
    for (token, is_number) in tokens(text) {
        let is_unreadable =
            is_number && (matches!(token, "NaN" | "Infinity" | "-Infinity") || overflows(token));
        changed |= is_unreadable;
        if is_unreadable {
            result.push('"');
            result.push_str(token);
            result.push('"');
        } else {
            result.push_str(token);
        }
    }
    changed.then_some(result)
}

/// Whether a number of three digits of exponent may be too large; most programs have none.
fn has_overflow(text: &str) -> bool {
    tokens(text).any(|(token, is_number)| is_number && overflows(token))
}

fn overflows(token: &str) -> bool {
    let is_long = token.len() > 300 || token.contains(['e', 'E']);
    is_long && token.parse::<f64>().is_ok_and(f64::is_infinite)
}

/// The text in pieces: strings, words of letters, digits and signs (`true` for those), the rest.
fn tokens(text: &str) -> impl Iterator<Item = (&str, bool)> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let bytes = rest.as_bytes();
        let first = *bytes.first()?;
        let is_word = |byte: u8| byte.is_ascii_alphanumeric() || matches!(byte, b'+' | b'-' | b'.');
        let length = if first == b'"' {
            string(bytes)
        } else {
            let kind = is_word(first);
            let end = |&byte: &u8| byte == b'"' || is_word(byte) != kind;
            bytes.iter().position(end).unwrap_or(bytes.len())
        };
        let (token, after) = rest.split_at(length);
        rest = after;
        Some((token, first != b'"' && is_word(first)))
    })
}

/// Length of the string at the start, quotes included.
fn string(bytes: &[u8]) -> usize {
    let mut index = 1;
    while index < bytes.len() {
        match bytes[index] {
            b'"' => return index + 1,
            b'\\' => index += 2,
            _ => index += 1,
        }
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::unreadable_as_texts;

    #[test]
    fn only_numbers_outside_of_strings_are_changed() {
        assert_eq!(
            unreadable_as_texts(r#"{"NaN": [1e300, "1e999 \" NaN"]}"#),
            None
        );
        assert_eq!(
            unreadable_as_texts(r#"["NaN é",NaN,-Infinity, 1e999]"#).as_deref(),
            Some(r#"["NaN é","NaN","-Infinity", "1e999"]"#)
        );
        // An unfinished string is the parser's to refuse.
        assert_eq!(
            unreadable_as_texts("[1e999, \"a"),
            Some("[\"1e999\", \"a".to_owned())
        );
    }
}
