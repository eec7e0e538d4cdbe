//! Largest errors of the functions of single precision, against `f64` of `libm`, whose own errors
//! are 2^-29 of those: over all exponents, and around multiples of a right angle, where the
//! reduction cancels most.
//!
//! Every 1009th number, a prime, so that mantissas of all patterns occur.

use gyrocal_scalar::{Scalar, asin_f32, erf_inv_f32, erf_inv_f64, sin_cos_f32, tan_f32};

const STRIDE: usize = 1009;

/// Distance in units of the last place of `reference` in `f32`.
fn ulps(value: f32, reference: f64) -> f64 {
    let size = reference.abs() as f32;
    let place = f64::from(f32::from_bits(size.to_bits() + 1)) - f64::from(size);
    ((f64::from(value) - reference) / place).abs()
}

/// The largest error over the arguments.
fn worst(arguments: impl Iterator<Item = f32>, error: impl Fn(f32) -> f64) -> f64 {
    arguments.fold(0.0, |worst, x| {
        let error = error(x);
        assert!(!error.is_nan(), "{x:e}");
        worst.max(error)
    })
}

/// Every 1009th positive number from `low` to `high`.
fn between(low: f32, high: f32) -> impl Iterator<Item = f32> {
    (low.to_bits()..=high.to_bits())
        .step_by(STRIDE)
        .map(f32::from_bits)
}

fn sine_error(x: f32) -> f64 {
    ulps(sin_cos_f32(x).0, libm::sin(f64::from(x)))
}

fn cosine_error(x: f32) -> f64 {
    ulps(sin_cos_f32(x).1, libm::cos(f64::from(x)))
}

#[test]
fn sine_and_cosine_keep_their_stated_errors() {
    for (low, high, stated) in [
        (0.0, 1.0 / 32.0, 0.51),
        (1.0 / 32.0, core::f32::consts::FRAC_PI_4, 0.8),
        (core::f32::consts::FRAC_PI_4, f32::MAX, 0.9),
    ] {
        let sine = worst(between(low, high), sine_error);
        let cosine = worst(between(low, high), cosine_error);
        assert!(
            sine <= stated && cosine <= stated,
            "{low:e}: {sine} {cosine}"
        );
    }
}

#[test]
fn the_reduction_holds_around_multiples_of_a_right_angle() {
    let multiples = (1..200_000_u32).chain((18..31).map(|k| 1 << k));
    let near = multiples.flat_map(|k| {
        let nearest = (f64::from(k) * core::f64::consts::FRAC_PI_2) as f32;
        [-1, 0, 1].map(|step| f32::from_bits(nearest.to_bits().wrapping_add_signed(step)))
    });
    let error = worst(near, |x| sine_error(x).max(cosine_error(x)));
    assert!(error <= 0.9, "{error}");
    // Of all numbers the one nearest to a multiple (Muller, Elementary Functions, table 11.1).
    let hardest = 16_367_173.0 * 2.0_f32.powi(72);
    let (sine, cosine) = sin_cos_f32(hardest);
    assert!(sine.abs().min(cosine.abs()) < 1.7e-9);
    assert!(sine_error(hardest) <= 0.9 && cosine_error(hardest) <= 0.9);
}

#[test]
fn sine_and_cosine_are_odd_and_even_and_hand_back_what_is_not_finite() {
    for x in between(0.0, f32::MAX).step_by(100) {
        let ((sine, cosine), (mirrored, same)) = (sin_cos_f32(x), sin_cos_f32(-x));
        assert_eq!(
            (sine.to_bits(), cosine),
            ((-mirrored).to_bits(), same),
            "{x:e}"
        );
    }
    assert_eq!(sin_cos_f32(0.0), (0.0, 1.0));
    assert!(sin_cos_f32(-0.0).0.is_sign_negative());
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(sin_cos_f32(x).0.is_nan() && sin_cos_f32(x).1.is_nan());
    }
}

#[test]
fn the_other_functions_keep_their_stated_errors() {
    let all = || between(1e-30, f32::MAX);
    let below_one = || between(1e-30, 1.0 - f32::EPSILON / 2.0);
    let large = || (0..5000_u32).map(|k| f32::from_bits(0x3f7f_ffff - k));
    for (name, stated, error) in [
        (
            "tan",
            2.2,
            worst(all(), |x| ulps(tan_f32(x), libm::tan(x.into()))),
        ),
        (
            "asin",
            0.8,
            worst(below_one().chain(large()), |x| {
                ulps(asin_f32(x), libm::asin(x.into()))
            }),
        ),
        (
            "erf_inv",
            4.0,
            worst(below_one().chain(large()), |x| {
                ulps(erf_inv_f32(x), erf_inv_f64(x.into()))
            }),
        ),
        (
            "exp",
            1.0,
            worst(between(1e-10, 88.7), |x| {
                ulps(Scalar::exp(x), libm::exp(x.into()))
                    .max(ulps(Scalar::exp(-0.98 * x), libm::exp((-0.98 * x).into())))
            }),
        ),
        (
            "hypot",
            1.3,
            worst(all(), |x| {
                [1e-7, 0.3, 1.0, 2.5]
                    .into_iter()
                    .fold(0.0, |worst: f64, ratio| {
                        let y = x * ratio;
                        let reference = libm::hypot(x.into(), y.into());
                        if reference > f32::MAX.into() {
                            return worst;
                        }
                        worst.max(ulps(Scalar::hypot(x, -y), reference))
                    })
            }),
        ),
    ] {
        assert!(error <= stated, "{name}: {error}");
    }
}

#[test]
fn the_other_functions_end_where_they_should() {
    assert_eq!(asin_f32(1.0), core::f32::consts::FRAC_PI_2);
    assert_eq!(asin_f32(-1.0), -core::f32::consts::FRAC_PI_2);
    assert!(asin_f32(-0.0).is_sign_negative());
    assert!(asin_f32(1.000_001).is_nan() && asin_f32(f32::NAN).is_nan());
    assert_eq!(erf_inv_f32(1.0), f32::INFINITY);
    assert_eq!(erf_inv_f32(-1.0), f32::NEG_INFINITY);
    assert!(erf_inv_f32(-0.0).is_sign_negative());
    assert!(erf_inv_f32(1.5).is_nan() && erf_inv_f32(f32::NAN).is_nan());
    assert_eq!(Scalar::hypot(f32::INFINITY, f32::NAN), f32::INFINITY);
    assert!(Scalar::hypot(1.0_f32, f32::NAN).is_nan() && Scalar::hypot(f32::NAN, 1.0).is_nan());
    assert_eq!(Scalar::hypot(0.0_f32, -3.0), 3.0);
    assert_eq!(Scalar::exp(100.0_f32), f32::INFINITY);
    assert_eq!(Scalar::exp(1.0_f32), core::f32::consts::E);
}
