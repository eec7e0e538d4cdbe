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

/// Parses an angle of one turn at most, either way.
pub(crate) fn angle_deg(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.abs() <= 360.0 => Ok(value),
        _ => Err("expected an angle in degrees, from -360 to 360".to_owned()),
    }
}

/// Parses the standard deviation of an angle; with 180 deg nothing is known of it.
pub(crate) fn angle_sigma_deg(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 180.0 => Ok(value),
        _ => Err("expected degrees, greater than 0 and at most 180".to_owned()),
    }
}

/// A number that is not negative.
pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number >= 0.0 => Ok(number),
        _ => Err("expected a number that is not negative".to_owned()),
    }
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
