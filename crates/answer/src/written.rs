//! Writing an answer.

use core::fmt;

use crate::Answer;

/// An answer that does not read back: one of its numbers is not finite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotWritable {
    /// What reading it back says.
    pub reason: String,
}

impl fmt::Display for NotWritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the answer has a number that is not finite, and is not written ({}); please report it with the inputs",
            self.reason
        )
    }
}

impl core::error::Error for NotWritable {}

/// The answer as JSON with a line break at its end.
///
/// # Errors
/// [`NotWritable`] if it does not read back: JSON has no number that is not finite, and has `null` in its place.
pub fn write_text(answer: &Answer) -> Result<String, NotWritable> {
    let refused = |error: &serde_json::Error| NotWritable {
        reason: error.to_string(),
    };
    let mut text = serde_json::to_string_pretty(answer).map_err(|error| refused(&error))?;
    serde_json::from_str::<Answer>(&text).map_err(|error| refused(&error))?;
    text.push('\n');
    Ok(text)
}
