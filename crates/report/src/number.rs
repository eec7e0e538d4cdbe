//! Numbers and units as text.

use gyrocal_statistics::format;

/// A number to some significant digits: `0.00342`, `−12`, `3.1·10⁻⁶`.
pub(crate) fn short(value: f64, digits: usize) -> String {
    if value.is_finite() {
        typographic(&format::significant(value, digits))
    } else {
        "not a number".to_owned()
    }
}

/// A value and its uncertainty, both to the place of the second digit of the uncertainty; with a common power of
/// ten where fixed point would have many zeros.
pub(crate) fn with_uncertainty(value: f64, uncertainty: f64) -> String {
    match uncertainty {
        fixed if (1e-6..100.0).contains(&fixed) => {
            typographic(&format::estimate(value, fixed).join(" ± "))
        }
        sigma if sigma > 0.0 && sigma.is_finite() => typographic(&format::with_sigma(value, sigma)),
        other => format!("{} ± {}", short(value, 3), short(other, 2)),
    }
}

/// A number with a true minus sign and a power of ten in place of `e`.
fn typographic(number: &str) -> String {
    let text = match number.split_once('e') {
        Some((mantissa, exponent)) => {
            let exponent = exponent.parse().unwrap_or(0);
            format!("{mantissa}·10{}", superscript(exponent))
        }
        None => number.to_owned(),
    };
    text.replace('-', "−")
}

/// An integer with groups of three digits, if it has more than four.
pub(crate) fn count(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) && digits.len() > 4 {
            text.push('\u{A0}');
        }
        text.push(digit);
    }
    text
}

/// An integer in superscript digits.
pub(crate) fn superscript(number: i32) -> String {
    number
        .to_string()
        .chars()
        .map(|letter| match letter {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            _ => '⁹',
        })
        .collect()
}

/// A factor and its unit, in which the largest of the values has few digits: 3e-5 g is 30 µg,
/// 3e-5 deg/h is 30 · 10⁻⁶ deg/h.
pub(crate) fn readable_unit(unit: &str, largest: f64) -> (f64, String) {
    if !(largest.is_finite() && largest > 0.0) || (0.01..10_000.0).contains(&largest) {
        return (1.0, unit.to_owned());
    }
    let power = (largest.log10() / 3.0).floor() as i32 * 3;
    let factor = 10f64.powi(-power);
    let name = match (unit, power) {
        ("g", -3) => "mg".to_owned(),
        ("g", -6) => "µg".to_owned(),
        ("g", -9) => "ng".to_owned(),
        ("", _) => format!("10{}", superscript(power)),
        _ => format!("10{} {unit}", superscript(power)),
    };
    (factor, name)
}

/// `quantity [unit]`, or one of them alone.
pub(crate) fn with_unit(quantity: &str, unit: &str) -> String {
    match (quantity, unit) {
        ("", only) | (only, "") => only.to_owned(),
        _ => format!("{quantity} [{unit}]"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        assert_eq!(short(0.003_421, 3), "0.00342");
        assert_eq!(short(-12.34, 2), "−12");
        assert_eq!(short(3.14e-6, 2), "3.1·10⁻⁶");
        assert_eq!(short(0.0, 3), "0");
        assert_eq!(with_uncertainty(-0.026_251, 1.62e-4), "−0.02625 ± 0.00016");
        assert_eq!(with_uncertainty(12.3, 0.0), "12.3 ± 0");
        assert_eq!(
            with_uncertainty(0.123_456_789, 1.2e-8),
            "0.123456789 ± 0.000000012"
        );
        assert_eq!(
            with_uncertainty(-1.234e-5, 5.6e-8),
            "(−1.2340 ± 0.0056)·10⁻⁵"
        );
        assert_eq!(with_uncertainty(12_345.678, 345.6), "12350 ± 350");
        assert_eq!(count(4320), "4320");
        assert_eq!(count(1_000_000), "1\u{A0}000\u{A0}000");
    }

    #[test]
    fn units_follow_the_size() {
        let (factor, unit) = readable_unit("g", 3e-5);
        assert!((factor - 1e6).abs() < 1e-6);
        assert_eq!(unit, "µg");
        assert_eq!(readable_unit("deg/h", 0.02).1, "deg/h");
        assert_eq!(readable_unit("deg/h", 0.002).1, "10⁻³ deg/h");
        assert_eq!(readable_unit("deg/h", f64::NAN).1, "deg/h");
    }
}
