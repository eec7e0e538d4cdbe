//! Error function and its inverse by textbook expansions, which share nothing with `libm`.

use core::f64::consts::FRAC_2_SQRT_PI;

/// Terms of the series, and levels of the continued fraction: enough for either side of [`JOIN`].
const TERMS: u32 = 200;
/// Up to it the series is summed; its terms stay below 100, and so do its errors below 1e-14 of a
/// value near 1. Beyond, the complement is below 5e-3 and needs no more digits than a few.
const JOIN: f64 = 2.0;

/// The error function, to some 1e-15.
pub(crate) fn erf(x: f64) -> f64 {
    let size = x.abs();
    if size > JOIN {
        return (1.0 - complement(size)).copysign(x);
    }
    // 2/sqrt(pi) exp(-x²) Σ 2^n x^(2n+1) / (2n+1)!!, all terms of one sign.
    let mut term = x;
    let mut sum = x;
    for n in 1..TERMS {
        term *= 2.0 * x * x / f64::from(2 * n + 1);
        sum += term;
    }
    FRAC_2_SQRT_PI * (-x * x).exp() * sum
}

/// The derivative of the error function.
pub(crate) fn slope(x: f64) -> f64 {
    FRAC_2_SQRT_PI * (-x * x).exp()
}

/// The inverse of the error function by bisection, on the complement beyond a half.
pub(crate) fn erf_inv(x: f64) -> f64 {
    let size = x.abs();
    if size.is_nan() || size > 1.0 {
        return f64::NAN;
    }
    if size == 1.0 {
        return f64::INFINITY.copysign(x);
    }
    // Near zero the error function is its slope there, to the last bit.
    if size < 1e-9 {
        return x / FRAC_2_SQRT_PI;
    }
    let below = |y: f64| match size <= 0.5 || y <= JOIN {
        true => erf(y) < size,
        false => complement(y) > 1.0 - size,
    };
    let (mut low, mut high) = (0.0_f64, 6.0_f64);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle.copysign(x);
        }
        if below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// erfc(x) for x above [`JOIN`]: exp(-x²)/sqrt(pi) / (x + (1/2)/(x + (2/2)/(x + ...))).
fn complement(x: f64) -> f64 {
    let tail = (1..TERMS)
        .rev()
        .fold(x, |below, k| x + 0.5 * f64::from(k) / below);
    0.5 * FRAC_2_SQRT_PI * (-x * x).exp() / tail
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm() {
        let mut x = -6.0;
        while x < 6.0 {
            // Some hundred roundings of positive terms.
            assert!((erf(x) - libm::erf(x)).abs() <= 4e-15, "{x}");
            x += 0.013;
        }
        assert_eq!(erf(0.0), 0.0);
    }

    #[test]
    fn the_inverse_is_one() {
        for x in [-0.999_999, -0.7, -1e-12, 0.0, 0.3, 0.9, 1.0 - 1e-13] {
            assert!((erf(erf_inv(x)) - x).abs() <= 4e-15, "{x}");
        }
        assert_eq!(erf_inv(-1.0), f64::NEG_INFINITY);
        assert!(erf_inv(1.1).is_nan());
    }
}
