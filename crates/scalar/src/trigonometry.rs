//! Sine and cosine for the small angles of a filter step.
//!
//! Up to 1/32, where the angles of a step of a few minutes are, both are Taylor polynomials of
//! degree 7 and 8: what follows is below 2^-57 of the sine and 2^-71 of the cosine. Up to pi/4
//! they are polynomials of degree 13 and 14; up to 5/4 pi those of the angle less pi/2 or pi, with the
//! bits of `libm`; beyond, both come from `libm`, whose argument reduction is exact. Coefficients up to
//! pi/4: minimax approximations on [0, (pi/4)²] published with FreeBSD's msun (`k_sin.c`, `k_cos.c`),
//! error below 2^-57.
//!
//! With the feature `fused` the polynomials use fused multiply-add where the target has it: faster,
//! as good to an ulp, and with other last bits than elsewhere. Without it, all machines agree.

const TINY: f64 = 1.0 / 32.0;
/// pi/4, 3/4 pi and 5/4 pi, rounded up as FreeBSD's msun compares: by the upper 32 bits.
const QUARTER_PI: f64 = f64::from_bits(0x3fe9_21fb_ffff_ffff);
const THREE_QUARTERS_PI: f64 = f64::from_bits(0x4002_d97c_ffff_ffff);
const FIVE_QUARTERS_PI: f64 = f64::from_bits(0x400f_6a7a_ffff_ffff);
/// The bit of the sign.
const SIGN: u64 = 1 << 63;
/// Closer to a multiple of pi/2 the reduction to 85 bits is not enough.
const NEAR: f64 = 1.0 / 1_048_576.0;
/// pi/2, its leading 33 bits: products with integers of 20 bits are exact.
const HALF_PI_HIGH: f64 = 1.570_796_326_734_125_6;
/// The rest of pi/2.
const HALF_PI_LOW: f64 = 6.077_100_506_506_192e-11;

const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Sine and cosine of `angle` in radians, to 1 ulp, the same bits on every machine.
#[inline(always)]
#[must_use]
pub fn sin_cos_f64(angle: f64) -> (f64, f64) {
    let size = angle.abs();
    if size <= TINY {
        tiny(angle)
    } else if size <= QUARTER_PI {
        small(angle)
    } else {
        // NaN comes here too: libm hands it back.
        large(angle)
    }
}

/// `a * b + c`, in one rounding where the feature `fused` and the target allow it.
#[inline(always)]
fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
    #[cfg(all(
        feature = "fused",
        feature = "std",
        any(target_feature = "fma", target_arch = "aarch64")
    ))]
    {
        a.mul_add(b, c)
    }
    #[cfg(not(all(
        feature = "fused",
        feature = "std",
        any(target_feature = "fma", target_arch = "aarch64")
    )))]
    {
        a * b + c
    }
}

#[inline(always)]
fn tiny(x: f64) -> (f64, f64) {
    let z = x * x;
    let w = z * z;
    let sine = multiply_add(w, -1.0 / 5040.0, multiply_add(z, 1.0 / 120.0, -1.0 / 6.0));
    let last = multiply_add(z, -1.0 / 40320.0, 1.0 / 720.0);
    let cosine = multiply_add(w, last, multiply_add(z, -1.0 / 24.0, 0.5));
    // The sum drops the sign of -0; on this interval the sine has that of its angle.
    let sine = multiply_add(z * x, sine, x).copysign(x);
    (sine, multiply_add(-z, cosine, 1.0))
}

#[inline(always)]
fn small(x: f64) -> (f64, f64) {
    let z = x * x;
    let w = z * z;
    let low = multiply_add(z, multiply_add(z, SINE[3], SINE[2]), SINE[1]);
    let sine = multiply_add(z * w, multiply_add(z, SINE[5], SINE[4]), low);
    let sine = multiply_add(z * x, multiply_add(z, sine, SINE[0]), x);
    let low = multiply_add(z, multiply_add(z, COSINE[2], COSINE[1]), COSINE[0]);
    // Of the opposite sign, so that both halves add: compilers then pair them in vectors.
    let high = multiply_add(z, multiply_add(z, -COSINE[5], -COSINE[4]), -COSINE[3]);
    let cosine = multiply_add(-(w * w), high, z * low);
    let half = 0.5 * z;
    let leading = 1.0 - half;
    let rest = multiply_add(z, cosine, (1.0 - leading) - half);
    (sine, leading + rest)
}

/// Beyond pi/4, with the bits of `libm`. Up to 5/4 pi the nearest multiple of pi/2 is taken away as
/// there (FreeBSD's msun, `e_rem_pio2.c`), to 85 bits; `libm` does the rest, and what is near pi/2 and pi.
#[cold]
#[inline(never)]
fn large(angle: f64) -> (f64, f64) {
    let size = angle.abs();
    if size <= THREE_QUARTERS_PI {
        let (rest, tail) = without(size, HALF_PI_HIGH, HALF_PI_LOW);
        if rest.abs() > NEAR {
            let (sine, cosine) = reduced(rest, tail);
            return (cosine.copysign(angle), -sine);
        }
    } else if size <= FIVE_QUARTERS_PI {
        let (rest, tail) = without(size, 2.0 * HALF_PI_HIGH, 2.0 * HALF_PI_LOW);
        if rest.abs() > NEAR {
            let (sine, cosine) = reduced(rest, tail);
            let signed = f64::from_bits(sine.to_bits() ^ !angle.to_bits() & SIGN);
            return (signed, -cosine);
        }
    }
    outside(angle)
}

#[cold]
#[inline(never)]
fn outside(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
}

/// `size` less a number that is the sum of two, and what the rounding of the difference left.
#[inline(always)]
fn without(size: f64, high: f64, low: f64) -> (f64, f64) {
    let difference = size - high;
    let rest = difference - low;
    (rest, (difference - rest) - low)
}

/// Sine and cosine of `x + tail` up to pi/4, where the tail is below an ulp of `x`.
#[inline(always)]
fn reduced(x: f64, tail: f64) -> (f64, f64) {
    let z = x * x;
    let w = z * z;
    let v = z * x;
    let low = multiply_add(z, multiply_add(z, SINE[3], SINE[2]), SINE[1]);
    let sine = multiply_add(z * w, multiply_add(z, SINE[5], SINE[4]), low);
    let sine = multiply_add(-v, sine, 0.5 * tail);
    let sine = x - multiply_add(-v, SINE[0], multiply_add(z, sine, -tail));
    let low = multiply_add(z, multiply_add(z, COSINE[2], COSINE[1]), COSINE[0]);
    // Of the opposite sign, so that both halves add: compilers then pair them in vectors.
    let high = multiply_add(z, multiply_add(z, -COSINE[5], -COSINE[4]), -COSINE[3]);
    let cosine = multiply_add(-(w * w), high, z * low);
    let half = 0.5 * z;
    let leading = 1.0 - half;
    let rest = ((1.0 - leading) - half) + multiply_add(z, cosine, -(x * tail));
    (sine, leading + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance in units of the last place of `reference`.
    fn ulps(value: f64, reference: f64) -> f64 {
        let spacing = f64::from_bits(reference.abs().to_bits() + 1) - reference.abs();
        ((value - reference) / spacing).abs()
    }

    #[test]
    fn agrees_with_libm_to_an_ulp_on_both_sides_of_the_guards() {
        let mut angle = -4.2;
        while angle < 4.2 {
            let (sine, cosine) = sin_cos_f64(angle);
            let (reference_sine, reference_cosine) = libm::sincos(angle);
            // libm itself is good to just under an ulp, so two roundings may differ by one.
            assert!(ulps(sine, reference_sine) <= 1.0, "sin({angle})");
            assert!(ulps(cosine, reference_cosine) <= 1.0, "cos({angle})");
            angle += 1.000_1e-4;
        }
    }

    /// Distances from multiples of pi/4 of all sizes, between them, and beyond.
    #[cfg(not(feature = "fused"))]
    #[test]
    fn has_the_bits_of_libm_beyond_a_quarter_of_pi() {
        let mut angles = std::vec![1e5, 1e300, f64::MAX];
        for quarters in 1..12 {
            let centre = f64::from(quarters) * QUARTER_PI;
            for power in 0..60 {
                let distance = 0.9 * 0.5_f64.powi(power);
                angles.extend([centre - distance, centre + distance]);
            }
        }
        angles.extend((0..100_000).map(|step| 0.7 + 1.7e-4 * f64::from(step)));
        angles.retain(|angle| angle.abs() > QUARTER_PI);
        for angle in angles.iter().flat_map(|angle| [*angle, -angle]) {
            let (found, expected) = (sin_cos_f64(angle), libm::sincos(angle));
            assert_eq!(found.0.to_bits(), expected.0.to_bits(), "sin({angle:e})");
            assert_eq!(found.1.to_bits(), expected.1.to_bits(), "cos({angle:e})");
        }
    }

    #[test]
    fn hands_back_what_is_not_finite_and_is_exact_at_zero() {
        assert!(sin_cos_f64(f64::NAN).0.is_nan());
        assert!(sin_cos_f64(f64::INFINITY).1.is_nan());
        assert_eq!(sin_cos_f64(0.0), (0.0, 1.0));
        assert!(sin_cos_f64(-0.0).0.is_sign_negative() && sin_cos_f64(0.0).0.is_sign_positive());
    }
}
