//! Numbers as text: p-values, estimates with their standard deviation, rounded numbers.

/// A p-value, always in one form: `p = 0.32`, `p = 0.002`, `p = 3e-59`, `p > 0.99` where rounding
/// would print 1, `p < 1e-300` where it underflows, `p undefined` if it is not a number.
#[must_use]
pub fn p_value(p: f64) -> String {
    related("=", p)
}

/// An upper bound of a p-value: `p <= 0.32`, otherwise as [`p_value`].
#[must_use]
pub fn p_bound(p: f64) -> String {
    related("<=", p)
}

fn related(sign: &str, p: f64) -> String {
    let text = p_cell(p);
    if text.starts_with(|first: char| first.is_ascii_digit()) {
        format!("p {sign} {text}")
    } else {
        format!("p {text}")
    }
}

/// A p-value for a column of a table whose heading is p: as [`p_value`] without `p` and `=`.
#[must_use]
pub fn p_cell(p: f64) -> String {
    match p {
        p if p.is_nan() => "undefined".to_owned(),
        p if p >= 0.995 => "> 0.99".to_owned(),
        p if p >= 0.01 => format!("{p:.2}"),
        p if p >= 0.001 => format!("{p:.3}"),
        p if p >= 1e-300 => format!("{p:.0e}"),
        _ => "< 1e-300".to_owned(),
    }
}

/// An estimate and its standard deviation, both rounded to the place of the second significant digit of the latter:
/// `0.41235`, `0.00012`; `1230`, `120`.
#[must_use]
pub fn estimate(estimate: f64, sigma: f64) -> [String; 2] {
    // Scientific notation rounds first, so that 0.0996 counts as 0.10.
    let scientific = format!("{sigma:.1e}");
    match exponent(&scientific) {
        Some(exponent) if sigma > 0.0 && (-12..=12).contains(&exponent) => {
            let decimals = usize::try_from(1 - exponent).unwrap_or(0);
            let place = 10_f64.powi((exponent - 1).max(0));
            [estimate, sigma].map(|value| match place > 1.0 {
                // The sum turns a negative zero into a positive one.
                true => format!("{:.0}", place * (value / place).round() + 0.0),
                false => format!("{value:.decimals$}"),
            })
        }
        _ => [format!("{estimate:e}"), scientific],
    }
}

/// An estimate with its standard deviation, for a sentence: `12.3 ± 0.4`, and with a common power of
/// ten where both are small or large: `(1.33 ± 0.08)e-3`.
#[must_use]
pub fn with_sigma(value: f64, sigma: f64) -> String {
    let larger = value.abs().max(sigma);
    let power = exponent(&format!("{larger:.3e}")).filter(|_| sigma > 0.0 && larger.is_finite());
    match power {
        Some(power) if !(-2..6).contains(&power) => {
            let scale = 10_f64.powi(-power);
            let [value, sigma] = estimate(value * scale, sigma * scale);
            format!("({value} ± {sigma})e{power}")
        }
        _ => estimate(value, sigma).join(" ± "),
    }
}

/// A number to some significant digits, those of a large integer kept: `0.00342`, `86400`,
/// `3.1e-7`. Scientific below 0.001 and from a million on.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let places = digits.max(1) - 1;
    let scientific = format!("{value:.places$e}");
    match exponent(&scientific) {
        _ if value == 0.0 => "0".to_owned(),
        Some(exponent) if (-3..6).contains(&exponent) => {
            let decimals = usize::try_from(places as i32 - exponent).unwrap_or(0);
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

/// A number to at most some significant digits: as [`significant`] without trailing zeros.
#[must_use]
pub fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (mantissa, exponent) = text.split_at(text.find('e').unwrap_or(text.len()));
    if !mantissa.contains('.') {
        return text;
    }
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    format!("{mantissa}{exponent}")
}

/// A probability in percent: `1 %`, `0.05 %`.
#[must_use]
pub fn percent(probability: f64) -> String {
    format!("{} %", short(100.0 * probability, 4))
}

fn exponent(scientific: &str) -> Option<i32> {
    scientific.split_once('e')?.1.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_p_value_has_one_form() {
        let cases = [
            (1.0, "p > 0.99"),
            (0.996, "p > 0.99"),
            (0.994, "p = 0.99"),
            (0.317, "p = 0.32"),
            (0.034, "p = 0.03"),
            (0.0021, "p = 0.002"),
            (2.3e-4, "p = 2e-4"),
            (2.6e-59, "p = 3e-59"),
            (0.0, "p < 1e-300"),
            (f64::NAN, "p undefined"),
        ];
        for (p, expected) in cases {
            assert_eq!(p_value(p), expected);
            assert_eq!(p_bound(p), expected.replace("p =", "p <="));
        }
        assert_eq!(p_cell(0.317), "0.32");
        assert_eq!(p_cell(1.0), "> 0.99");
    }

    #[test]
    fn sigma_has_two_digits_and_the_estimate_as_many_decimals() {
        let cases = [
            ((0.412_345_678, 0.000_123_4), ["0.41235", "0.00012"]),
            ((-0.287, 0.099_6), ["-0.29", "0.10"]),
            ((-0.287, 0.994), ["-0.29", "0.99"]),
            ((-0.287, 0.996), ["-0.3", "1.0"]),
            ((123.456, 34.56), ["123", "35"]),
            ((123.456, 345.6), ["120", "350"]),
            ((1234.5, 123.4), ["1230", "120"]),
            ((-3.0, 996.0), ["0", "1000"]),
            ((12_345.678, 99.6), ["12350", "100"]),
            ((1.5, 2e-15), ["1.5e0", "2.0e-15"]),
            ((1.5, 0.0), ["1.5e0", "0.0e0"]),
            ((1.5, f64::NAN), ["1.5e0", "NaN"]),
        ];
        for ((value, sigma), expected) in cases {
            assert_eq!(estimate(value, sigma), expected, "{value} {sigma}");
        }
    }

    #[test]
    fn small_and_large_values_have_a_common_power_of_ten() {
        for ((value, sigma), expected) in [
            ((0.001_329, 0.000_075), "(1.329 ± 0.075)e-3"),
            ((-0.287, 0.099_6), "-0.29 ± 0.10"),
            ((0.0, 0.000_2), "(0.0 ± 2.0)e-4"),
            ((123.456, 34.56), "123 ± 35"),
            ((12_345_678.0, 100_000.0), "(1.235 ± 0.010)e7"),
            ((1.5, 0.0), "1.5e0 ± 0.0e0"),
            ((f64::NAN, 1.0), "NaN ± 1.0"),
        ] {
            assert_eq!(with_sigma(value, sigma), expected, "{value} {sigma}");
        }
    }

    #[test]
    fn numbers_have_their_digits() {
        let cases = [
            (86_400.0, 4, "86400", "86400"),
            (12.345_67, 4, "12.35", "12.35"),
            (0.5, 4, "0.5000", "0.5"),
            (1e-7, 4, "1.000e-7", "1e-7"),
            (0.0, 3, "0", "0"),
            (100.0, 4, "100.0", "100"),
            (0.003_421, 3, "0.00342", "0.00342"),
            (-12.34, 2, "-12", "-12"),
            (3.14e-6, 2, "3.1e-6", "3.1e-6"),
            (9.996, 3, "10.0", "10"),
            (f64::NAN, 3, "NaN", "NaN"),
        ];
        for (value, digits, whole, trimmed) in cases {
            assert_eq!(significant(value, digits), whole);
            assert_eq!(short(value, digits), trimmed);
        }
        assert_eq!(percent(0.01), "1 %");
        assert_eq!(percent(0.0005), "0.05 %");
    }
}
