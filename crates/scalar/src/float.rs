//! `f32` and `f64` as [`Scalar`]. Sine, cosine and exponential are those of this crate, other
//! elementary functions those of `libm`, so that bits are the same on every machine, with and
//! without the standard library.
//!
//! The square root is correctly rounded in both libraries, and rounding to integers is exact. With the standard library it is one
//! instruction in the encoding of its surroundings; that of `libm` is inline assembly in the legacy
//! SSE encoding, which stalls some processors between 256-bit instructions. Without the standard
//! library it remains the only one.

use crate::exact;
use crate::{Real, Scalar, exp_f64, sin_cos_f32, sin_cos_f64};
// emit: off
use crate::single::hypot_f32;
use crate::{asin_f32, erf_inv_f32, erf_inv_f64, tan_f32};

/// Functions of `libm` with NaN outside of their domain.
mod domain {
    /// That of `libm` gives numbers below -1.
    #[inline]
    pub(super) fn acosh(x: f64) -> f64 {
        if x < 1.0 { f64::NAN } else { libm::acosh(x) }
    }

    #[inline]
    pub(super) fn acoshf(x: f32) -> f32 {
        if x < 1.0 { f32::NAN } else { libm::acoshf(x) }
    }
}
// emit: on

macro_rules! impl_float {
    ($float:ident, $sin_cos:path, $($method:ident => $function:path),* $(,)? ;
     $($binary:ident => $of_two:path),* $(,)?) => {
        impl Scalar for $float {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            $(
                #[inline]
                fn $method(self) -> Self {
                    $function(self)
                }
            )*
            $(
                #[inline]
                fn $binary(self, other: Self) -> Self {
                    $of_two(self, other)
                }
            )*
            #[inline(always)]
            fn copysign(self, sign: Self) -> Self {
                $float::copysign(self, sign)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }
            #[inline(always)]
            fn sign(self) -> Self {
                if self > 0.0 { 1.0 } else if self < 0.0 { -1.0 } else { self }
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                $float::min(self, other)
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                $float::max(self, other)
            }
            #[inline(always)]
            fn less(self, other: Self) -> Self {
                if self < other { 1.0 } else { 0.0 }
            }
            #[inline(always)]
            fn less_or_equal(self, other: Self) -> Self {
                if self <= other { 1.0 } else { 0.0 }
            }
            #[inline(always)]
            fn equal(self, other: Self) -> Self {
                if self == other { 1.0 } else { 0.0 }
            }
            #[inline(always)]
            fn if_else_zero(self, value: Self) -> Self {
                if self == 0.0 { 0.0 } else { value }
            }
            #[cfg(all(feature = "std", any(target_feature = "fma", target_arch = "aarch64")))]
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                $float::mul_add(self, factor, addend)
            }
        }

        impl Real for $float {
            const ZERO: Self = 0.0;
            #[inline(always)]
            fn from_u32(count: u32) -> Self {
                count as $float
            }
            #[inline(always)]
            fn to_u32(self) -> u32 {
                self as u32
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn epsilon() -> Self {
                $float::EPSILON
            }
            #[inline(always)]
            fn is_nan(self) -> bool {
                $float::is_nan(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

impl_float!(f64, sin_cos_f64,
    exp => exp_f64, sqrt => exact::sqrt,
    // emit: off
    tan => libm::tan, asin => libm::asin, acos => libm::acos, atan => libm::atan,
    sinh => libm::sinh, cosh => libm::cosh, tanh => libm::tanh,
    asinh => libm::asinh, acosh => domain::acosh, atanh => libm::atanh,
    exp_m1 => libm::expm1, ln => libm::log, ln_1p => libm::log1p,
    erf => libm::erf, erf_inv => erf_inv_f64,
    floor => exact::floor, ceil => exact::ceil,
    // emit: on
    ;
    // emit: off
    atan2 => libm::atan2, powf => libm::pow, hypot => libm::hypot,
    fmod => libm::fmod, remainder => libm::remainder,
    // emit: on
);
impl_float!(f32, sin_cos_f32,
    exp => libm::expf, sqrt => exact::sqrtf,
    // emit: off
    tan => tan_f32, asin => asin_f32, acos => libm::acosf, atan => libm::atanf,
    sinh => libm::sinhf, cosh => libm::coshf, tanh => libm::tanhf,
    asinh => libm::asinhf, acosh => domain::acoshf, atanh => libm::atanhf,
    exp_m1 => libm::expm1f, ln => libm::logf, ln_1p => libm::log1pf,
    erf => libm::erff, erf_inv => erf_inv_f32,
    floor => exact::floorf, ceil => exact::ceilf,
    // emit: on
    ;
    // emit: off
    atan2 => libm::atan2f, powf => libm::powf, hypot => hypot_f32,
    fmod => libm::fmodf, remainder => libm::remainderf,
    // emit: on
);

#[cfg(test)]
mod tests {
    use crate::Scalar;

    /// Numbers whose bits are drawn from a seed (xorshift64*), so of every exponent and sign.
    fn patterns() -> impl Iterator<Item = u64> {
        let mut state = 1_u64;
        core::iter::repeat_with(move || {
            state ^= state >> 12;
            state ^= state << 25;
            state ^= state >> 27;
            state.wrapping_mul(0x2545_f491_4f6c_dd1d)
        })
    }

    #[test]
    fn roots_and_integers_have_the_bits_of_libm() {
        let edges = [
            0.0,
            -0.0,
            1.0,
            0.5,
            -2.5,
            f64::MIN_POSITIVE,
            f64::from_bits(1),
            f64::MAX,
            f64::INFINITY,
        ];
        let drawn = patterns().take(200_000).map(f64::from_bits);
        for x in edges.into_iter().chain(drawn) {
            for (found, reference) in [
                (Scalar::sqrt(x), libm::sqrt(x)),
                (Scalar::floor(x), libm::floor(x)),
                (Scalar::ceil(x), libm::ceil(x)),
            ] {
                // The payload of what is not a number is nobody's.
                let equal = found.to_bits() == reference.to_bits();
                assert!(
                    equal || (found.is_nan() && reference.is_nan()),
                    "{x:e}: {found:e}"
                );
            }
            let x = x as f32;
            for (found, reference) in [
                (Scalar::sqrt(x), libm::sqrtf(x)),
                (Scalar::floor(x), libm::floorf(x)),
                (Scalar::ceil(x), libm::ceilf(x)),
            ] {
                let equal = found.to_bits() == reference.to_bits();
                assert!(
                    equal || (found.is_nan() && reference.is_nan()),
                    "{x:e}: {found:e}"
                );
            }
        }
    }
}
