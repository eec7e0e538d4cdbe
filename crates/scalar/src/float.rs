//! `f32` and `f64` as [`Scalar`]. Sine, cosine and exponential are those of this crate, other
//! elementary functions those of `libm`, so that bits are the same on every machine, with and
//! without the standard library.
//!
//! The square root is correctly rounded in both libraries. With the standard library it is one
//! instruction in the encoding of its surroundings; that of `libm` is inline assembly in the legacy
//! SSE encoding, which stalls some processors between 256-bit instructions. Without the standard
//! library it remains the only one.

use crate::{Real, Scalar, exp_f32, exp_f64, sin_cos_f32, sin_cos_f64};

#[cfg(feature = "std")]
mod square_root {
    #[inline(always)]
    pub(super) fn f64(x: f64) -> f64 {
        x.sqrt()
    }

    #[inline(always)]
    pub(super) fn f32(x: f32) -> f32 {
        x.sqrt()
    }
}
#[cfg(not(feature = "std"))]
mod square_root {
    pub(super) use libm::{sqrt as f64, sqrtf as f32};
}

macro_rules! impl_float {
    ($float:ident, $sin_cos:path, $($method:ident => $function:path),* ; $atan2:path, $pow:path) => {
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
            #[inline]
            fn atan2(self, x: Self) -> Self {
                $atan2(self, x)
            }
            #[inline]
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
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
    tan => libm::tan, asin => libm::asin, acos => libm::acos, atan => libm::atan,
    sinh => libm::sinh, cosh => libm::cosh, tanh => libm::tanh,
    exp => exp_f64, ln => libm::log, sqrt => square_root::f64;
    libm::atan2, libm::pow);
impl_float!(f32, sin_cos_f32,
    tan => libm::tanf, asin => libm::asinf, acos => libm::acosf, atan => libm::atanf,
    sinh => libm::sinhf, cosh => libm::coshf, tanh => libm::tanhf,
    exp => exp_f32, ln => libm::logf, sqrt => square_root::f32;
    libm::atan2f, libm::powf);

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
    fn square_roots_have_the_bits_of_libm() {
        let edges = [
            0.0,
            -0.0,
            1.0,
            f64::MIN_POSITIVE,
            f64::from_bits(1),
            f64::MAX,
            f64::INFINITY,
        ];
        let drawn = patterns().take(200_000).map(f64::from_bits);
        for x in edges.into_iter().chain(drawn) {
            let (root, reference) = (Scalar::sqrt(x), libm::sqrt(x));
            // The payload of what is not a number is nobody's.
            let same =
                root.to_bits() == reference.to_bits() || (root.is_nan() && reference.is_nan());
            assert!(same, "sqrt({x:e}) = {root:e}, libm has {reference:e}");
            let x = x as f32;
            let (root, reference) = (Scalar::sqrt(x), libm::sqrtf(x));
            let same =
                root.to_bits() == reference.to_bits() || (root.is_nan() && reference.is_nan());
            assert!(same, "sqrt({x:e}) = {root:e}, libm has {reference:e}");
        }
    }
}
