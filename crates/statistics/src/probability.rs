//! Tail probabilities of the normal and chi-square distributions, and their inverses.

use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, StudentsT};
use statrs::function::erf::{erf_inv, erfc_inv};

use crate::math::{erfc, exp, exp_m1, ln, ln_1p, ln_gamma};

/// The 97.5 % quantile of the standard normal distribution: half the width of a two-sided 95 %
/// interval, in standard deviations.
pub const NORMAL_97_5: f64 = 1.959_963_984_540_054;

/// The 99 % quantile of chi-square with one degree of freedom.
pub const CHI_SQUARE_99: f64 = 6.634_896_601_021_214;

/// Probability that a standard normal variable is as far from zero as `z` or farther.
#[must_use]
pub fn two_sided_p(z: f64) -> f64 {
    erfc(z.abs() / core::f64::consts::SQRT_2)
}

/// Probability that the least of several p-values is as small, if there is nothing to be found: exact of
/// independent tests (Šidák, J. Amer. Statist. Assoc. 62, 626, 1967), an upper bound of positively
/// dependent ones.
#[must_use]
pub fn p_of_least(least: f64, tests: f64) -> f64 {
    // 1 − (1 − p)^n without the loss of small p.
    -exp_m1(tests * ln_1p(-least.clamp(0.0, 1.0)))
}

/// Probability that a standard normal variable is at most `z`.
#[must_use]
pub fn normal_probability(z: f64) -> f64 {
    0.5 * erfc(-z / core::f64::consts::SQRT_2)
}

/// The `z` that a two-sided probability belongs to; at most 38, where doubles end.
#[must_use]
pub fn z_of_two_sided_p(p: f64) -> f64 {
    core::f64::consts::SQRT_2 * erfc_inv(p.clamp(f64::MIN_POSITIVE, 1.0))
}

/// Probability that chi-square exceeds a value; `None` if the degrees of freedom are not positive.
#[must_use]
pub fn chi_square_tail(value: f64, degrees_of_freedom: f64) -> Option<f64> {
    Some(ChiSquared::new(degrees_of_freedom).ok()?.sf(value))
}

/// Probability that chi-square is as far from its median as a value or farther, on either side;
/// `None` if the degrees of freedom are not positive.
#[must_use]
pub fn chi_square_two_sided_p(value: f64, degrees_of_freedom: f64) -> Option<f64> {
    let distribution = ChiSquared::new(degrees_of_freedom).ok()?;
    let tail = distribution.cdf(value).min(distribution.sf(value));
    Some((2.0 * tail).min(1.0))
}

/// The value that chi-square stays below with a probability; `None` if the degrees of freedom are
/// not positive.
#[must_use]
pub fn chi_square_quantile(probability: f64, degrees_of_freedom: f64) -> Option<f64> {
    Some(
        ChiSquared::new(degrees_of_freedom)
            .ok()?
            .inverse_cdf(probability),
    )
}

/// Probability that a variable of Student's distribution is as far from zero as `t` or farther;
/// `None` if the degrees of freedom are not positive.
#[must_use]
pub fn student_two_sided_p(t: f64, degrees_of_freedom: f64) -> Option<f64> {
    let distribution = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?;
    Some(2.0 * distribution.sf(t.abs()))
}

/// Probability that a variable of Student's distribution is below `t`; that of the normal distribution for
/// infinite degrees of freedom, `None` if they are not positive.
#[must_use]
pub fn student_probability(t: f64, degrees_of_freedom: f64) -> Option<f64> {
    if degrees_of_freedom == f64::INFINITY {
        return Some(normal_probability(t));
    }
    let distribution = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?;
    Some(distribution.cdf(t))
}

/// The value that a variable of Student's distribution stays below with a probability; that of the normal
/// distribution for infinite degrees of freedom, `None` if they are not positive.
#[must_use]
pub fn student_quantile(probability: f64, degrees_of_freedom: f64) -> Option<f64> {
    // At a million degrees the quantiles differ by 1e-6; far above, the iteration does not end.
    if degrees_of_freedom > 1e6 {
        return Some(normal_quantile(probability));
    }
    let distribution = StudentsT::new(0.0, 1.0, degrees_of_freedom).ok()?;
    Some(distribution.inverse_cdf(probability))
}

/// Probability that a variable of Fisher's F distribution exceeds a value; `None` if the degrees of
/// freedom, of numerator and denominator, are not positive.
#[must_use]
pub fn f_tail(value: f64, degrees_of_freedom: [f64; 2]) -> Option<f64> {
    let [numerator, denominator] = degrees_of_freedom;
    let distribution = FisherSnedecor::new(numerator, denominator).ok()?;
    Some(distribution.sf(value))
}

/// Natural logarithm of the probability that chi-square exceeds a value.
#[must_use]
pub fn ln_chi_square_tail(value: f64, degrees_of_freedom: f64) -> f64 {
    let tail = chi_square_tail(value, degrees_of_freedom).unwrap_or(1.0);
    if tail > LEAST_TAIL {
        return ln(tail);
    }
    // The first term of the tail's expansion.
    let half = 0.5 * degrees_of_freedom;
    (half - 1.0) * ln(0.5 * value) - 0.5 * value - ln_gamma(half)
}

/// The value of chi-square with one degree of freedom that is exceeded with a probability of this
/// natural logarithm: makes statistics of any kind comparable with that of one signature.
#[must_use]
pub fn chi_square_equivalent(ln_probability: f64) -> f64 {
    if ln_probability > ln(LEAST_TAIL) {
        return z_of_two_sided_p(exp(ln_probability.min(0.0))).powi(2);
    }
    // From ln p = -u/2 - ln(pi u/2)/2, the first term of the tail's expansion.
    let mut value = -2.0 * ln_probability;
    for _ in 0..4 {
        value = -2.0 * ln_probability - ln(core::f64::consts::FRAC_PI_2 * value);
    }
    value
}

/// The standard normal deviate whose tail is as probable as that of a chi-square value, negative
/// below the median; `None` if the degrees of freedom are not positive.
#[must_use]
pub fn chi_square_z(value: f64, degrees_of_freedom: f64) -> Option<f64> {
    let distribution = ChiSquared::new(degrees_of_freedom).ok()?;
    let (lower, upper) = (distribution.cdf(value), distribution.sf(value));
    if lower < upper {
        return Some(-z_of_two_sided_p(2.0 * lower));
    }
    if upper > LEAST_TAIL {
        return Some(z_of_two_sided_p(2.0 * upper));
    }
    // The sum of the expansion's terms, which fall like a geometric series.
    let ratio = (0.5 * degrees_of_freedom - 1.0) / (0.5 * value);
    let ln_tail = ln_chi_square_tail(value, degrees_of_freedom) - ln_1p(-ratio);
    Some(chi_square_equivalent(core::f64::consts::LN_2 + ln_tail).sqrt())
}

/// Below it, tails are taken by the first term of their expansions.
const LEAST_TAIL: f64 = 1e-200;

/// The value that a standard normal variable stays below with probability `p`.
#[must_use]
pub fn normal_quantile(p: f64) -> f64 {
    core::f64::consts::SQRT_2 * erf_inv(2.0 * p - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_p_value_of_the_least_is_uniform() {
        // 1 − 0.9³, and n p where p is small.
        assert!((p_of_least(0.1, 3.0) - 0.271).abs() < 1e-12);
        assert!((p_of_least(1e-20, 5.0) / 5e-20 - 1.0).abs() < 1e-12);
        assert!((p_of_least(1.0, 3.0) - 1.0).abs() < 1e-15);
    }

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
        // Both sides rounded to doubles.
        assert!((normal_quantile(0.975) - NORMAL_97_5).abs() < 1e-14);
        assert!((z_of_two_sided_p(0.01).powi(2) - CHI_SQUARE_99).abs() < 1e-13);
    }

    #[test]
    fn tails_of_ratios_are_those_of_tables() {
        // Two-sided 5 % point of t with 10 degrees of freedom, 5 % point of F(3, 20), 97.5 % and
        // 2.5 % points of chi-square with 100, as printed.
        for many in [1e9, f64::INFINITY] {
            assert_eq!(student_quantile(0.975, many), Some(normal_quantile(0.975)));
        }
        // Tables of Student's distribution: 97.5 % point 2.228 of ten degrees of freedom.
        assert!((student_probability(2.228, 10.0).unwrap_or(0.0) - 0.975).abs() < 5e-5);
        assert_eq!(
            student_probability(1.0, f64::INFINITY),
            Some(normal_probability(1.0))
        );
        assert_eq!(student_probability(1.0, 0.0), None);
        assert!((student_quantile(0.975, 10.0).unwrap_or(0.0) - 2.228).abs() < 1e-3);
        assert!((student_two_sided_p(-2.228, 10.0).unwrap_or(0.0) - 0.05).abs() < 1e-4);
        assert!((f_tail(3.098, [3.0, 20.0]).unwrap_or(0.0) - 0.05).abs() < 1e-4);
        for value in [129.561, 74.222] {
            let p = chi_square_two_sided_p(value, 100.0).unwrap_or(0.0);
            assert!((p - 0.05).abs() < 1e-4, "{p}");
        }
        assert_eq!(chi_square_tail(1.0, 0.0), None);
    }

    #[test]
    fn a_chi_square_has_the_z_of_its_tail() {
        let z = |value, degrees| chi_square_z(value, degrees).unwrap_or(f64::NAN);
        // 97.5 % and 2.5 % points of chi-square with 100 degrees of freedom, as printed.
        assert!((z(129.561, 100.0) - NORMAL_97_5).abs() < 1e-4);
        assert!((z(74.222, 100.0) + NORMAL_97_5).abs() < 1e-4);
        // The tail of a square is both tails of the variable; to the digits of the quantile.
        assert!((two_sided_p(z(900.0, 1.0)) / (2.0 * two_sided_p(30.0)) - 1.0).abs() < 1e-6);
        // The tail is expanded from 1e-200 on, near 17 270; a step of 50 is worth 0.25 there.
        let values = (0..12).map(|step| z(17_000.0 + 50.0 * f64::from(step), 12_000.0));
        let values: Vec<f64> = values.collect();
        for pair in values.windows(2) {
            assert!((pair[1] - pair[0] - 0.25).abs() < 0.01, "{values:?}");
        }
        assert_eq!(chi_square_z(1.0, 0.0), None);
    }

    #[test]
    fn equivalents_join_where_tails_are_expanded() {
        // One signature is equivalent to itself, near and far; the expansion is off by 1/u.
        for value in [5.0, 50.0, 900.0, 1_100.0, 40_000.0] {
            let equivalent = chi_square_equivalent(ln_chi_square_tail(value, 1.0));
            assert!(
                (equivalent - value).abs() < 3.0 / value + 1e-6,
                "{value} {equivalent}"
            );
        }
        // Three degrees of freedom are worth less, by ln(x) + ...: 10 is exceeded with 0.018566.
        assert!((ln_chi_square_tail(10.0, 3.0) - 0.018_566_f64.ln()).abs() < 1e-4);
        let (near, far) = (
            ln_chi_square_tail(920.0, 3.0),
            ln_chi_square_tail(930.0, 3.0),
        );
        assert!((near - far - 5.0).abs() < 0.01, "{near} {far}");
    }
}
