//! Inverse functions and the root of a sum of squares.

use crate::exact::sqrtf;

/// Inverse sine in radians, without `f64`, to 0.8 ulp; NaN beyond ±1.
///
/// Up to a half the rational approximation of FreeBSD's msun (`e_asinf.c`), beyond it
/// pi/2 - 2 asin(√((1 - x) / 2)).
#[must_use]
pub fn asin_f32(x: f32) -> f32 {
    let size = x.abs();
    if size <= 0.5 {
        return x + x * rational(x * x);
    }
    if size > 1.0 {
        return f32::NAN;
    }
    // Exact: 1 - size for size from 1/2 to 1. NaN comes here too and stays NaN.
    let z = (1.0 - size) * 0.5;
    let root = sqrtf(z);
    // What the rounding of the root leaves of z, in its leading twelve bits exact.
    let head = f32::from_bits(root.to_bits() & 0xffff_f000);
    let tail = if root > 0.0 {
        (z - head * head) / (root + head)
    } else {
        0.0
    };
    let rest = 2.0 * root * rational(z) - (HALF_PI_LOW - 2.0 * tail);
    (HALF_PI_HIGH - 2.0 * head - rest).copysign(x)
}

const HALF_PI_HIGH: f32 = 1.570_796_4;
/// pi/2 less [`HALF_PI_HIGH`].
const HALF_PI_LOW: f32 = -4.371_139e-8;

/// (asin √z - √z) / √z for z up to 1/4.
#[inline(always)]
fn rational(z: f32) -> f32 {
    let p = z * (0.166_665_87 + z * (-0.042_743_42 + z * -0.008_656_363));
    p / (1.0 + z * -0.706_629_63)
}

/// The number whose error function is `x`, without `f64`, to 4 ulp; infinite at ±1, NaN beyond.
///
/// Giles' approximation for single precision (GPU Computing Gems 2, 2011, chapter 10).
#[must_use]
pub fn erf_inv_f32(x: f32) -> f32 {
    let size = x.abs();
    if size >= 1.0 {
        return if size == 1.0 {
            f32::INFINITY.copysign(x)
        } else {
            f32::NAN
        };
    }
    // -ln(1 - x²), without loss of digits near zero and near one.
    let w = if size < 0.5 {
        -libm::log1pf(-x * x)
    } else {
        -libm::logf((1.0 - size) * (1.0 + size))
    };
    let (argument, coefficients) = if w < 5.0 {
        (w - 2.5, &CENTRAL)
    } else {
        (sqrtf(w) - 3.0, &TAIL)
    };
    let mut sum = 0.0;
    for coefficient in coefficients {
        sum = sum * argument + coefficient;
    }
    sum * x
}

const CENTRAL: [f32; 9] = [
    2.810_226_4e-8,
    3.432_739_3e-7,
    -3.523_387_7e-6,
    -4.391_506_5e-6,
    0.000_218_580_87,
    -0.001_253_725,
    -0.004_177_681_6,
    0.246_640_73,
    1.501_409_4,
];
const TAIL: [f32; 9] = [
    -0.000_200_214_26,
    0.000_100_950_56,
    0.001_349_343_2,
    -0.003_673_428_4,
    0.005_739_507_7,
    -0.007_622_461_3,
    0.009_438_870_5,
    1.001_674,
    2.832_976_8,
];

/// Root of the sum of the squares, without `f64` and without overflow in between, to 1.3 ulp.
pub(crate) fn hypot_f32(x: f32, y: f32) -> f32 {
    let (x, y) = (x.abs(), y.abs());
    if x == f32::INFINITY || y == f32::INFINITY {
        return f32::INFINITY;
    }
    // Of a NaN and a number the comparison takes either; the sum is NaN.
    let larger = if x > y { x } else { y };
    // Powers of two: multiplication is exact but for what is far below the larger.
    let (down, up) = if larger > 1.0e18 {
        (f32::from_bits(0x1f80_0000), f32::from_bits(0x5f80_0000))
    } else if larger < 1.0e-18 {
        (f32::from_bits(0x5f80_0000), f32::from_bits(0x1f80_0000))
    } else {
        (1.0, 1.0)
    };
    let (x, y) = (x * down, y * down);
    sqrtf(x * x + y * y) * up
}
