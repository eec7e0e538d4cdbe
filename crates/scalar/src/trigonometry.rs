//! Sine and cosine for the small angles of a filter step.
//!
//! Up to 1/32, where the angles of a step of a few minutes are, both are Taylor polynomials of
//! degree 7 and 8: what follows is below 2^-57 of the sine and 2^-71 of the cosine. Up to pi/4
//! they are polynomials of degree 13 and 14; beyond, both come from `libm`, whose argument
//! reduction is exact. Coefficients up to pi/4: minimax approximations on [0, (pi/4)²] published
//! with FreeBSD's msun (`k_sin.c`, `k_cos.c`), error below 2^-57.

const TINY: f64 = 1.0 / 32.0;
const QUARTER_PI: f64 = core::f64::consts::FRAC_PI_4;

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

/// Sine and cosine of `angle` in radians, computed in `f64` and rounded.
#[inline(always)]
#[must_use]
pub fn sin_cos_f32(angle: f32) -> (f32, f32) {
    let (sine, cosine) = sin_cos_f64(f64::from(angle));
    (sine as f32, cosine as f32)
}

#[inline(always)]
fn tiny(x: f64) -> (f64, f64) {
    let z = x * x;
    let w = z * z;
    let sine = (-1.0 / 6.0 + z * (1.0 / 120.0)) + w * (-1.0 / 5040.0);
    let cosine = (0.5 - z * (1.0 / 24.0)) + w * (1.0 / 720.0 - z * (1.0 / 40320.0));
    // The sum drops the sign of -0; on this interval the sine has that of its angle.
    ((x + (z * x) * sine).copysign(x), 1.0 - z * cosine)
}

#[inline(always)]
fn small(x: f64) -> (f64, f64) {
    let z = x * x;
    let w = z * z;
    let sine = SINE[1] + z * (SINE[2] + z * SINE[3]) + z * w * (SINE[4] + z * SINE[5]);
    let sine = x + (z * x) * (SINE[0] + z * sine);
    let cosine = z * (COSINE[0] + z * (COSINE[1] + z * COSINE[2]))
        + w * w * (COSINE[3] + z * (COSINE[4] + z * COSINE[5]));
    let half = 0.5 * z;
    let leading = 1.0 - half;
    (sine, leading + (((1.0 - leading) - half) + z * cosine))
}

#[cold]
#[inline(never)]
fn large(angle: f64) -> (f64, f64) {
    libm::sincos(angle)
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
    fn agrees_with_libm_to_an_ulp_on_both_sides_of_the_guard() {
        let mut angle = -1.0;
        while angle < 1.0 {
            let (sine, cosine) = sin_cos_f64(angle);
            let (reference_sine, reference_cosine) = libm::sincos(angle);
            // libm itself is good to just under an ulp, so two roundings may differ by one.
            assert!(ulps(sine, reference_sine) <= 1.0, "sin({angle})");
            assert!(ulps(cosine, reference_cosine) <= 1.0, "cos({angle})");
            angle += 1.000_1e-4;
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
