//! Elementary functions from `core` alone, in the place of `libm`'s: square roots, correctly rounded;
//! sine, cosine and exponential where the kernels of `scalar` end.

use gyrocal_scalar::{exp_f64, sin_cos_f64};

/// Square root, correctly rounded: from the root of an integer with one bit more than the result has.
/// Its last bit rounds; no root lies half-way, as the square of such a number has more bits than the
/// argument.
#[must_use]
pub(crate) fn sqrt(x: f64) -> f64 {
    if !x.is_finite() || x <= 0.0 {
        return if x < 0.0 { f64::NAN } else { x };
    }
    // Subnormal numbers are scaled by 2^54, their roots back by 2^-27.
    if x < f64::MIN_POSITIVE {
        return sqrt(x * 18_014_398_509_481_984.0) / 134_217_728.0;
    }
    let bits = x.to_bits();
    let exponent = (bits >> 52) as i64 - 1023;
    let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    let odd = exponent & 1;
    let root = (mantissa << (54 + odd)).isqrt() as u64;
    let biased = ((exponent - odd) / 2 + 1022) as u64;
    f64::from_bits((biased << 52) + ((root + 1) >> 1))
}

/// Square root, correctly rounded, as [`sqrt`].
#[must_use]
pub(crate) fn sqrtf(x: f32) -> f32 {
    if !x.is_finite() || x <= 0.0 {
        return if x < 0.0 { f32::NAN } else { x };
    }
    // Subnormal numbers are scaled by 2^24, their roots back by 2^-12.
    if x < f32::MIN_POSITIVE {
        return sqrtf(x * 16_777_216.0) / 4_096.0;
    }
    let bits = x.to_bits();
    let exponent = (bits >> 23) as i32 - 127;
    let mantissa = u64::from((bits & ((1 << 23) - 1)) | (1 << 23));
    let odd = exponent & 1;
    let root = (mantissa << (25 + odd)).isqrt() as u32;
    let biased = ((exponent - odd) / 2 + 126) as u32;
    f32::from_bits((biased << 23) + ((root + 1) >> 1))
}

/// Largest angle whose multiple of pi/2 is found: 2^20 of them.
const MOST: f64 = 1_647_099.0;
/// pi/2 in parts of 33 bits (FreeBSD's msun, `e_rem_pio2.c`).
const HALF_PI: [f64; 3] = [
    1.570_796_326_734_125_6,
    6.077_100_506_303_966e-11,
    2.022_266_248_795_950_6e-21,
];
/// 1.5 · 2^52: adding and taking it away rounds to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine of any angle up to 1.6 million rad, to two units of the last place; NaN beyond.
#[must_use]
pub(crate) fn sincos(angle: f64) -> (f64, f64) {
    if angle.is_nan() || angle.abs() > MOST {
        return (f64::NAN, f64::NAN);
    }
    let count = (angle * core::f64::consts::FRAC_2_PI + ROUNDER) - ROUNDER;
    let [first, second, third] = HALF_PI;
    let high = angle - count * first;
    let middle = count * second;
    let sum = high - middle;
    let low = count * third - ((high - sum) - middle);
    let rest = sum - low;
    let tail = (sum - rest) - low;
    let (sine, cosine) = sin_cos_f64(rest);
    let (sine, cosine) = (sine + tail * cosine, cosine - tail * sine);
    match count as i64 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// e to a power beyond ±708, or NaN.
#[must_use]
pub(crate) fn exp(x: f64) -> f64 {
    if x > 710.0 {
        f64::INFINITY
    } else if x < -746.0 {
        0.0
    } else if x.is_nan() {
        x
    } else {
        let half = exp_f64(0.5 * x);
        half * half
    }
}

/// e to the power `x`, to two units of the last place; coefficients of Cephes (`expf.c`).
#[must_use]
pub(crate) fn expf(x: f32) -> f32 {
    if x > 89.0 {
        return f32::INFINITY;
    }
    if x < -104.0 {
        return 0.0;
    }
    if x.is_nan() {
        return x;
    }
    let count = (x * core::f32::consts::LOG2_E + 12_582_912.0) - 12_582_912.0;
    let r = x - count * 0.693_359_4 + count * 2.121_944_4e-4;
    let p = 1.987_569_1e-4 * r + 1.398_2e-3;
    let p = (p * r + 8.333_452e-3) * r + 4.166_579_6e-2;
    let p = (p * r + 1.666_666_5e-1) * r + 0.5;
    let e_r = p * r * r + r + 1.0;
    // In two factors, each of a normal number.
    let count = count as i32;
    let half = count / 2;
    let power = |count: i32| f32::from_bits(((count + 127) << 23) as u32);
    e_r * power(half) * power(count - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers whose bits are drawn from a seed (xorshift64*).
    fn patterns() -> impl Iterator<Item = u64> {
        let mut state = 7_u64;
        core::iter::repeat_with(move || {
            state ^= state >> 12;
            state ^= state << 25;
            state ^= state >> 27;
            state.wrapping_mul(0x2545_f491_4f6c_dd1d)
        })
    }

    #[test]
    fn roots_have_the_bits_of_libm() {
        let edges = [
            0.0,
            -0.0,
            1.0,
            2.0,
            -1.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            f64::INFINITY,
        ];
        let small = [f64::from_bits(1), f64::from_bits(0xf_ffff_ffff_ffff)];
        let drawn = patterns().take(100_000).map(f64::from_bits);
        for x in edges.into_iter().chain(small).chain(drawn) {
            let (found, expected) = (sqrt(x), libm::sqrt(x));
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{x:e}: {found:e} {expected:e}");
        }
        let drawn = patterns()
            .take(200_000)
            .map(|bits| f32::from_bits(bits as u32));
        for x in drawn.chain([0.0, -0.0, f32::from_bits(1), f32::MAX, f32::INFINITY]) {
            let (found, expected) = (sqrtf(x), libm::sqrtf(x));
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{x:e}: {found:e} {expected:e}");
        }
    }

    #[test]
    fn sine_and_cosine_hold_to_a_million_radians() {
        for bits in patterns().take(100_000) {
            let angle = (bits as f64 / u64::MAX as f64 - 0.5) * 2e6;
            let (found, expected) = (sincos(angle), libm::sincos(angle));
            // An ulp of one, and the rounding of both libraries.
            assert!((found.0 - expected.0).abs() < 4e-16, "{angle}");
            assert!((found.1 - expected.1).abs() < 4e-16, "{angle}");
        }
        assert!(sincos(f64::NAN).0.is_nan() && sincos(1e9).1.is_nan());
    }

    #[test]
    fn exponentials_agree_with_libm() {
        for bits in patterns().take(50_000) {
            let x = (bits as f64 / u64::MAX as f64 - 0.5) * 220.0;
            let (found, expected) = (expf(x as f32), libm::expf(x as f32));
            // Two units of the last place, and one of a subnormal number.
            let most = 2.5e-7 * expected + 3e-45;
            assert!((found - expected).abs() <= most || found == expected, "{x}");
        }
        for x in [-800.0, -744.0, -720.0, 709.5, 720.0] {
            let (found, expected) = (exp(x), libm::exp(x));
            // Half the argument, squared: some units of the last place, and one of a subnormal.
            let close = (found - expected).abs() <= 1e-15 * expected + 1e-323;
            assert!(close || found == expected, "{x}: {found:e} {expected:e}");
        }
        assert!(exp(f64::NAN).is_nan() && expf(f32::NAN).is_nan());
    }
}
