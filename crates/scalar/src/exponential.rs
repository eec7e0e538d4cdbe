//! The natural exponential without a branch for the arguments that models have.
//!
//! x = k ln 2 + r with |r| <= ln 2 / 2, and e^x = 2^k e^r; e^r from the rational approximation
//! published with FreeBSD's msun (`e_exp.c`), error below 2^-59. What overflows, underflows or is
//! no number goes to `libm`.

/// Largest argument for which neither 2^k nor the result leaves the normal numbers.
const LARGEST: f64 = 708.0;
/// ln 2, its leading 32 bits: products with integers of eleven bits are exact.
const LN_2_HIGH: f64 = 6.931_471_803_691_238e-1;
/// The rest of ln 2.
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;
/// 1.5 · 2^52: adding and taking it away rounds to an integer.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

const P: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238e-8,
];

/// e to the power `x`, to 1 ulp, the same bits on every machine.
#[inline(always)]
#[must_use]
pub fn exp_f64(x: f64) -> f64 {
    // NaN takes the other branch: libm hands it back.
    if x.abs() <= LARGEST {
        inside(x)
    } else {
        libm::exp(x)
    }
}

#[inline(always)]
fn inside(x: f64) -> f64 {
    let k = (x * core::f64::consts::LOG2_E + ROUNDER) - ROUNDER;
    let (high, low) = (x - k * LN_2_HIGH, k * LN_2_LOW);
    let r = high - low;
    let t = r * r;
    let c = r - t * (P[0] + t * (P[1] + t * (P[2] + t * (P[3] + t * P[4]))));
    let e_r = 1.0 - ((low - (r * c) / (2.0 - c)) - high);
    // |k| <= 1022: the exponent of a normal number.
    e_r * f64::from_bits(((k as i64 + 1023) << 52) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_libm_to_an_ulp() {
        let mut x = -708.5;
        while x < 709.0 {
            for x in [x, x * 1e-3, x * 1e-9] {
                let (value, reference) = (exp_f64(x), libm::exp(x));
                let apart = value.to_bits().abs_diff(reference.to_bits());
                // Both are good to just under an ulp, so two roundings may differ by one.
                assert!(apart <= 1, "exp({x}) = {value:e}, {reference:e}");
            }
            x += 0.003_17;
        }
    }

    #[test]
    fn is_exact_at_zero_and_hands_on_what_is_beyond() {
        assert_eq!(exp_f64(0.0), 1.0);
        assert_eq!(exp_f64(-1e9), 0.0);
        assert_eq!(exp_f64(710.0), f64::INFINITY);
        assert_eq!(exp_f64(f64::INFINITY), f64::INFINITY);
        assert_eq!(exp_f64(f64::NEG_INFINITY), 0.0);
        assert!(exp_f64(f64::NAN).is_nan());
    }
}
