//! Writing an answer.

use core::fmt;

use crate::Answer;

/// An answer that has a number that is not finite.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotWritable {
    /// The key that has it.
    pub key: String,
}

impl fmt::Display for NotWritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "`{}` of the answer is not finite, and the answer is not written; please report it with the inputs",
            self.key
        )
    }
}

impl core::error::Error for NotWritable {}

/// The answer as JSON with a line break at its end.
///
/// # Errors
/// [`NotWritable`] if a number is not finite: JSON has no such number, and has `null` in its place, which may say that
/// it was not computed.
pub fn write_text(answer: &Answer) -> Result<String, NotWritable> {
    if let Some(key) = not_finite(&format!("{answer:?}")) {
        return Err(NotWritable { key });
    }
    let text = serde_json::to_string_pretty(answer).map_err(|error| NotWritable {
        key: error.to_string(),
    })?;
    Ok(text + "\n")
}

/// The field of the first number that is not finite, in an answer as it is written for developers.
fn not_finite(debug: &str) -> Option<String> {
    let mut field = "";
    // Words stand between quotation marks, those within them escaped.
    let plain = debug.replace("\\\\", "").replace("\\\"", "");
    for numbers in plain.split('"').step_by(2) {
        let between = |letter: char| letter.is_whitespace() || ",[](){}".contains(letter);
        for word in numbers.split(between) {
            if let Some(name) = word.strip_suffix(':') {
                field = name;
            } else if ["NaN", "inf", "-inf"].contains(&word) {
                return Some(field.to_owned());
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_that_is_not_finite_is_named_by_its_key() {
        let of = |p: Option<f64>, sigma: f64| {
            let debug = format!(
                "{:?}",
                (
                    "p: NaN, \"inf\" ",
                    Some(crate::OutputTest {
                        output: "a \\ of NaN".to_owned(),
                        p_value: p.unwrap_or(0.5),
                    }),
                    crate::Estimated {
                        estimate: 1.0,
                        sigma
                    }
                )
            );
            not_finite(&debug)
        };
        assert_eq!(of(None, 0.1), None);
        assert_eq!(of(Some(f64::NAN), 0.1).as_deref(), Some("p_value"));
        assert_eq!(of(None, f64::NEG_INFINITY).as_deref(), Some("sigma"));
        let absent = crate::Starts {
            tried: 1,
            agreeing: 1,
        };
        assert_eq!(
            not_finite(&format!("{absent:?} Some({:?})", f64::INFINITY)).as_deref(),
            Some("agreeing")
        );
    }
}
