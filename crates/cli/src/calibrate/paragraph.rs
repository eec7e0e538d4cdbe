//! Words in lines.

/// Letters in a line.
const LINE: usize = 100;

/// Words in lines that a terminal shows whole, with a line break at the end.
pub(super) fn paragraph(words: &str) -> String {
    let mut text = String::with_capacity(words.len() + 1);
    let mut column = 0;
    for word in words.split(' ') {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > LINE {
            text.push('\n');
            column = 0;
        } else if column > 0 {
            text.push(' ');
            column += 1;
        }
        text.push_str(word);
        column += length;
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::{LINE, paragraph};

    #[test]
    fn lines_are_filled_and_not_overfilled() {
        let words = "gyro_x.bias, ".repeat(40);
        let text = paragraph(words.trim_end());
        assert_eq!(text.replace('\n', " "), words);
        for (index, line) in text.lines().enumerate() {
            let length = line.chars().count();
            assert!(length <= LINE, "{length}");
            // A further word has 12 letters and a space before it.
            assert!(
                length + 13 > LINE || index + 1 == text.lines().count(),
                "{length}"
            );
        }
        assert_eq!(paragraph(&"w".repeat(200)), "w".repeat(200) + "\n");
    }
}
