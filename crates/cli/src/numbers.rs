//! Numbers of the command line, and names of values.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

fn number(text: &str, holds: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| holds(*value));
    value.ok_or_else(|| format!("expected {expected}"))
}

/// Parses a number between 0 and 1.
pub(crate) fn probability(text: &str) -> Result<f64, String> {
    let expected = "a number greater than 0 and less than 1";
    number(text, |value| value > 0.0 && value < 1.0, expected)
}

/// Parses a number greater than 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    let holds = |value: f64| value > 0.0 && value.is_finite();
    number(text, holds, "a number greater than 0")
}

/// Parses an angle of one turn at most, either way.
pub(crate) fn angle_deg(text: &str) -> Result<f64, String> {
    let expected = "an angle in degrees, from -360 to 360";
    number(text, |value| value.abs() <= 360.0, expected)
}

/// Parses the standard deviation of an angle; with 180 deg nothing is known of it.
pub(crate) fn angle_sigma_deg(text: &str) -> Result<f64, String> {
    let expected = "degrees, greater than 0 and at most 180";
    number(text, |value| value > 0.0 && value <= 180.0, expected)
}

/// A number that is not negative.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    let holds = |value: f64| value.is_finite() && value >= 0.0;
    number(text, holds, "a number that is not negative")
}

/// One value of an option, with its name there and what help says of it.
pub(crate) type Choice<T> = (&'static str, &'static str, T);

/// Parses the name of one of some values.
pub(crate) fn one_of<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let names = choices.iter();
    let names = names.map(|(name, help, _)| PossibleValue::new(*name).help(*help));
    PossibleValuesParser::new(names).try_map(move |given| {
        let chosen = choices.iter().find(|(name, ..)| *name == given);
        chosen.map(|(.., value)| *value).ok_or("no such value")
    })
}

#[cfg(test)]
mod tests {
    use super::{angle_deg, angle_sigma_deg, positive, probability};

    #[test]
    fn what_is_no_such_number_is_refused() {
        assert_eq!(probability("0.01"), Ok(0.01));
        for wrong in ["", "0", "1", "-0.1", "nan", "1 %"] {
            assert!(probability(wrong).is_err(), "{wrong}");
        }
        assert_eq!(positive("60"), Ok(60.0));
        for wrong in ["", "0", "-1", "nan", "inf", "60 s"] {
            assert!(positive(wrong).is_err(), "{wrong}");
        }
        assert_eq!(angle_deg("-30"), Ok(-30.0));
        for wrong in ["", "nan", "inf", "1e300", "360.1", "30 deg"] {
            assert!(angle_deg(wrong).is_err(), "{wrong}");
        }
        assert_eq!(angle_sigma_deg("180"), Ok(180.0));
        for wrong in ["", "0", "-1", "nan", "inf", "180.1"] {
            assert!(angle_sigma_deg(wrong).is_err(), "{wrong}");
        }
    }
}
