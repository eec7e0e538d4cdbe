//! Between probabilities and standard deviations.

use statrs::function::erf::{erf_inv, erfc, erfc_inv};

/// Probability that a standard normal variable is as far from zero as `z` or farther.
#[must_use]
pub fn two_sided_p(z: f64) -> f64 {
    erfc(z.abs() / core::f64::consts::SQRT_2)
}

/// The `z` that a two-sided probability belongs to; at most 38, where doubles end.
#[must_use]
pub fn z_of_two_sided_p(p: f64) -> f64 {
    core::f64::consts::SQRT_2 * erfc_inv(p.clamp(f64::MIN_POSITIVE, 1.0))
}

/// The value that a standard normal variable stays below with probability `p`.
pub(crate) fn normal_quantile(p: f64) -> f64 {
    core::f64::consts::SQRT_2 * erf_inv(2.0 * p - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_those_of_tables() {
        // 95 % and 99.73 %: 1.959964 and 3, as printed.
        assert!((two_sided_p(1.959_964) - 0.05).abs() < 1e-7);
        assert!((two_sided_p(-3.0) - 0.002_699_796).abs() < 1e-9);
        for z in [0.1, 1.0, 5.0, 20.0] {
            // The inverse of a probability keeps its relative error over z.
            assert!(
                (z_of_two_sided_p(two_sided_p(z)) - z).abs() < 1e-8 * z,
                "{z}"
            );
        }
        assert!(z_of_two_sided_p(0.0).is_finite());
    }
}
