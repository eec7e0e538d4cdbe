//! Rounding of estimates to the digits that their standard deviation supports.

/// Estimate and sigma with the decimals that show two significant digits of the sigma.
pub(crate) fn rounded(estimate: f64, sigma: f64) -> [String; 2] {
    // Scientific notation rounds first, so that 0.0996 counts as 0.10.
    let scientific = format!("{sigma:.1e}");
    let exponent = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    match exponent {
        Some(exponent) if sigma > 0.0 && (-12..=12).contains(&exponent) => {
            let decimals = usize::try_from(1 - exponent).unwrap_or(0);
            [
                format!("{estimate:.decimals$}"),
                format!("{sigma:.decimals$}"),
            ]
        }
        _ => [format!("{estimate:e}"), scientific],
    }
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn sigma_has_two_digits_and_the_estimate_as_many_decimals() {
        let cases = [
            ((0.412_345_678, 0.000_123_4), ["0.41235", "0.00012"]),
            ((-0.287, 0.099_6), ["-0.29", "0.10"]),
            ((-0.287, 0.994), ["-0.29", "0.99"]),
            ((-0.287, 0.996), ["-0.3", "1.0"]),
            ((123.456, 34.56), ["123", "35"]),
            ((123.456, 345.6), ["123", "346"]),
            ((1.5, 2e-15), ["1.5e0", "2.0e-15"]),
            ((1.5, 0.0), ["1.5e0", "0.0e0"]),
            ((1.5, f64::NAN), ["1.5e0", "NaN"]),
        ];
        for ((estimate, sigma), expected) in cases {
            assert_eq!(rounded(estimate, sigma), expected, "{estimate} {sigma}");
        }
    }
}
