//! The inverse of the error function.
//!
//! Halley's iteration on the error function of `libm`, or on its complement where the argument is
//! beyond a half: 1 - |x| is exact there, so that no digit is lost near ±1. The iteration starts
//! from Giles' approximation for single precision (GPU Computing Gems 2, 2011, chapter 10), or near
//! ±1 from the leading term of the asymptotic series.

/// The start is good to 1e-2, and a step cubes the error.
const STEPS: usize = 3;
/// Polynomial in -ln(1 - x²) - 2.5.
const CENTRAL: [f64; 9] = [
    2.810_226_36e-8,
    3.432_739_39e-7,
    -3.523_387_7e-6,
    -4.391_506_54e-6,
    2.185_808_7e-4,
    -1.253_725_03e-3,
    -4.177_681_64e-3,
    0.246_640_727,
    1.501_409_41,
];
/// The number whose error function is `x`; infinite at ±1, NaN beyond.
#[must_use]
pub fn erf_inv_f64(x: f64) -> f64 {
    let size = x.abs();
    // Zero keeps its sign; NaN takes the last branch.
    if size == 0.0 {
        return x;
    }
    if size < 1.0 {
        return positive(size).copysign(x);
    }
    if size == 1.0 {
        f64::INFINITY.copysign(x)
    } else {
        f64::NAN
    }
}

fn positive(x: f64) -> f64 {
    let mut y = start(x);
    for _ in 0..STEPS {
        let difference = if x <= 0.5 {
            libm::erf(y) - x
        } else {
            (1.0 - x) - libm::erfc(y)
        };
        let slope = core::f64::consts::FRAC_2_SQRT_PI * libm::exp(-y * y);
        let newton = difference / slope;
        y -= newton / (1.0 + y * newton);
    }
    y
}

fn start(x: f64) -> f64 {
    let w = -libm::log((1.0 - x) * (1.0 + x));
    if w < 5.0 {
        return CENTRAL.iter().fold(0.0, |sum, c| sum * (w - 2.5) + c) * x;
    }
    // erfc(y) = exp(-y²) / (y √π), with the first estimate of y on the right.
    const ROOT_PI: f64 = 1.772_453_850_905_516;
    let complement = 1.0 - x;
    let y = libm::sqrt(-libm::log(complement));
    libm::sqrt(-libm::log(complement * ROOT_PI * y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_the_inverse() {
        let mut x = 1e-300;
        while x < 1.0 - 1e-16 {
            for x in [x, 1.0 - x] {
                let y = erf_inv_f64(x);
                // Errors of an ulp in y and in the error function, relative to what is inverted:
                // the complement where x is near 1, whose relative slope is 2 y (y + 1) at most.
                let (found, wanted) = if x <= 0.5 {
                    (libm::erf(y), x)
                } else {
                    (libm::erfc(y), 1.0 - x)
                };
                let allowed = 2.0 * f64::EPSILON * (1.0 + 2.0 * y * (y + 1.0)) * wanted;
                assert!(
                    (found - wanted).abs() <= allowed || wanted == 0.0,
                    "{x:e}: {y:e}"
                );
            }
            x = if x < 1e-3 { x * 1.7 } else { x + 1.234_5e-3 };
        }
    }

    #[test]
    fn has_the_values_of_mpmath() {
        // mpmath.erfinv to 40 digits, rounded.
        let cases: [(f64, f64); 10] = [
            (1e-310, 8.8622692545277e-311),
            (1e-20, 8.86226925452758e-21),
            (0.1, 0.08885599049425769),
            (0.5, 0.4769362762044699),
            (0.7, 0.7328690779592167),
            (0.9, 1.1630871536766743),
            (0.99, 1.8213863677184494),
            (0.999999, 3.458910737275499),
            (0.999999999999, 5.042031898572696),
            (0.9999999999999999, 5.8635847487551676),
        ];
        for (x, expected) in cases {
            let found = erf_inv_f64(x);
            assert!(
                found.to_bits().abs_diff(expected.to_bits()) <= 2,
                "{x:e}: {found:e}, expected {expected:e}"
            );
            assert_eq!(erf_inv_f64(-x), -found);
        }
    }

    #[test]
    fn ends_at_one_and_keeps_the_sign_of_zero() {
        assert_eq!(erf_inv_f64(1.0), f64::INFINITY);
        assert_eq!(erf_inv_f64(-1.0), f64::NEG_INFINITY);
        assert!(erf_inv_f64(1.5).is_nan() && erf_inv_f64(f64::NAN).is_nan());
        assert!(erf_inv_f64(-0.0).is_sign_negative());
    }
}
