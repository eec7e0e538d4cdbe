//! Numbers of the command line.

/// Parses a number between 0 and 1.
pub(crate) fn probability(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => Err("expected a number greater than 0 and less than 1".to_owned()),
    }
}

/// Parses a number greater than 0.
pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a number greater than 0".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::{positive, probability};

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
    }
}
