//! Sine, cosine and tangent.
//!
//! Up to 1/32, where the angles of a filter step are, Taylor polynomials of degree 5 and 4: what
//! follows is below 2^-42 of the sine and 2^-39 of the cosine. Up to pi/4 the minimax polynomials
//! published with FreeBSD's msun (`k_sinf.c`, `k_cosf.c`, error below 2^-34), coefficients rounded
//! to `f32`. Beyond, the same polynomials after an exact reduction of the argument.

use super::reduction::{Reduced, reduce};

const TINY: f32 = 1.0 / 32.0;
const QUARTER_PI: f32 = core::f32::consts::FRAC_PI_4;

const SINE: [f32; 4] = [
    -0.166_666_67,
    0.008_333_33,
    -0.000_198_393_35,
    0.000_002_718_311_5,
];
const COSINE: [f32; 3] = [0.041_666_623, -0.001_388_676_4, 0.000_024_390_449];

/// Sine and cosine of `angle` in radians, without `f64`: to 0.51 ulp up to 1/32, to 0.8 ulp up
/// to pi/4, to 0.9 ulp up to the largest finite angle.
#[inline(always)]
#[must_use]
pub fn sin_cos_f32(angle: f32) -> (f32, f32) {
    let size = angle.abs();
    if size <= TINY {
        tiny(angle)
    } else {
        beyond(angle)
    }
}

/// Tangent of `angle` in radians, without `f64`, to 2.2 ulp.
#[inline]
#[must_use]
pub fn tan_f32(angle: f32) -> f32 {
    let (sine, cosine) = sin_cos_f32(angle);
    sine / cosine
}

#[inline(always)]
fn tiny(x: f32) -> (f32, f32) {
    let z = x * x;
    let sine = x + (z * x) * (z * (1.0 / 120.0) + (-1.0 / 6.0));
    // The sum drops the sign of -0; on this interval the sine has that of its angle.
    (sine.copysign(x), 1.0 - z * (0.5 - z * (1.0 / 24.0)))
}

#[inline(never)]
fn beyond(x: f32) -> (f32, f32) {
    if x.abs() <= QUARTER_PI {
        return small(x, 0.0);
    }
    if !x.is_finite() {
        return (f32::NAN, f32::NAN);
    }
    let Reduced {
        quadrant,
        high,
        low,
    } = reduce(x);
    let (sine, cosine) = small(high, low);
    match quadrant & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// Sine and cosine of `x + low`, `low` being below the last place of `x`.
#[inline(always)]
fn small(x: f32, low: f32) -> (f32, f32) {
    let z = x * x;
    let half = 0.5 * z;
    let series = SINE[0] + z * (SINE[1] + z * (SINE[2] + z * SINE[3]));
    let sine = x + (z * x * series + (low - half * low));
    let series = COSINE[0] + z * (COSINE[1] + z * COSINE[2]);
    let leading = 1.0 - half;
    let cosine = leading + (((1.0 - leading) - half) + (z * z * series - x * low));
    (sine, cosine)
}
