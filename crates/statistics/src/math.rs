//! Elementary functions of one implementation, so that results do not depend on the mathematics
//! library of the machine.
//!
//! Sine, cosine and exponential are those of the kernel (`gyrocal-scalar`), the others those of
//! `libm`. The square root of the standard library is exact everywhere and needs no other.

use gyrocal_scalar::{exp_f64, sin_cos_f64};

/// e to the power of `x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    exp_f64(x)
}

/// e to the power of `x`, less one, without losing digits near zero.
#[must_use]
pub fn exp_m1(x: f64) -> f64 {
    libm::expm1(x)
}

/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Natural logarithm of one plus `x`, without losing digits near zero.
#[must_use]
pub fn ln_1p(x: f64) -> f64 {
    libm::log1p(x)
}

/// `base` to the power of `exponent`.
#[must_use]
pub fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// Sine and cosine of an angle \[rad\].
#[must_use]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    sin_cos_f64(angle)
}

/// Sine of an angle \[rad\].
#[must_use]
pub fn sin(angle: f64) -> f64 {
    sin_cos_f64(angle).0
}

/// Cosine of an angle \[rad\].
#[must_use]
pub fn cos(angle: f64) -> f64 {
    sin_cos_f64(angle).1
}

/// Angle whose sine is `x` \[rad\].
#[must_use]
pub fn asin(x: f64) -> f64 {
    libm::asin(x)
}

/// Angle whose cosine is `x` \[rad\].
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// Angle of the point (`x`, `y`), from -π to π \[rad\].
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Root of the sum of two squares, without overflow.
#[must_use]
pub fn hypot(x: f64, y: f64) -> f64 {
    libm::hypot(x, y)
}

/// Complementary error function.
#[must_use]
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

/// Natural logarithm of the gamma function.
#[must_use]
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_those_of_their_names() {
        // Values of tables, rounded to doubles; a unit in the last place or two.
        let near = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 5e-16, "{found} {expected}");
        };
        near(exp(1.0), core::f64::consts::E);
        near(exp_m1(1e-10), 1.000_000_000_05e-10);
        near(ln(2.0), core::f64::consts::LN_2);
        near(ln_1p(1e-10), 0.999_999_999_95e-10);
        near(pow(2.0, 0.5), core::f64::consts::SQRT_2);
        near(sin(1.0), 0.841_470_984_807_896_5);
        near(cos(1.0), 0.540_302_305_868_139_7);
        assert_eq!(sin_cos(1.0), (sin(1.0), cos(1.0)));
        near(asin(0.5), core::f64::consts::FRAC_PI_6);
        near(acos(0.5), core::f64::consts::FRAC_PI_3);
        near(atan2(-1.0, -1.0), -3.0 * core::f64::consts::FRAC_PI_4);
        near(hypot(3e200, 4e200), 5e200);
        near(erfc(1.0), 0.157_299_207_050_285_13);
        near(ln_gamma(0.5), 0.572_364_942_924_700_1);
    }
}
