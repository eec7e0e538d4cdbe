//! Word wrap for a terminal.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

use crate::width;

/// Longest lines of paragraphs.
const LINE: usize = 100;

/// Wrapped text with a line break at the end.
pub(crate) fn paragraph(words: &str) -> String {
    lines("", "", words)
}

/// An entry of a list.
pub(crate) fn bullet(words: &str) -> String {
    lines(" - ", "   ", words)
}

/// Wrapped to this width, without a line break at the end.
pub(crate) fn wrapped(width: usize, words: &str) -> String {
    textwrap::fill(words, options(width))
}

fn lines(first: &str, next: &str, words: &str) -> String {
    let columns = width::columns().unwrap_or(LINE).clamp(40, LINE);
    let options = options(columns)
        .initial_indent(first)
        .subsequent_indent(next);
    textwrap::fill(words, options) + "\n"
}

/// Breaks at spaces only; several spaces in a row, as in a path, are kept.
fn options<'a>(width: usize) -> Options<'a> {
    Options::new(width)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .wrap_algorithm(WrapAlgorithm::FirstFit)
}

#[cfg(test)]
mod tests {
    use super::{LINE, bullet, paragraph};

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
        assert_eq!(paragraph("a  b.csv"), "a  b.csv\n");
    }

    #[test]
    fn lines_are_broken_and_indented() {
        let words = "word ".repeat(40);
        let text = bullet(words.trim_end());
        let broken: Vec<&str> = text.lines().collect();
        assert_eq!(broken.len(), 3);
        assert!(broken[0].starts_with(" - word") && broken[1].starts_with("   word"));
        assert!(broken.iter().all(|line| line.len() <= LINE));
        assert_eq!(text.matches("word").count(), 40);
    }
}
