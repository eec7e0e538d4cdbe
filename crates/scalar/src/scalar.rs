use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number that generated code can compute with.
///
/// Comparisons return numbers (1 for true, 0 for false) instead of `bool`, so that lanes
/// and dual numbers can implement them and generated code has no branches.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The number nearest to `value`.
    #[must_use]
    fn from_f64(value: f64) -> Self;
    /// Sine and cosine of an angle in radians.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);
    /// Natural exponential.
    #[must_use]
    fn exp(self) -> Self;
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    // emit: off
    /// Tangent of an angle in radians.
    #[must_use]
    fn tan(self) -> Self;
    /// Inverse sine in radians.
    #[must_use]
    fn asin(self) -> Self;
    /// Inverse cosine in radians.
    #[must_use]
    fn acos(self) -> Self;
    /// Inverse tangent in radians.
    #[must_use]
    fn atan(self) -> Self;
    /// Angle of the point (`x`, `self`) in radians.
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// Hyperbolic sine.
    #[must_use]
    fn sinh(self) -> Self;
    /// Hyperbolic cosine.
    #[must_use]
    fn cosh(self) -> Self;
    /// Hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// Natural logarithm.
    #[must_use]
    fn ln(self) -> Self;
    /// `self` to a power that is not a small integer.
    #[must_use]
    fn powf(self, exponent: Self) -> Self;
    /// Inverse hyperbolic sine.
    #[must_use]
    fn asinh(self) -> Self;
    /// Inverse hyperbolic cosine.
    #[must_use]
    fn acosh(self) -> Self;
    /// Inverse hyperbolic tangent.
    #[must_use]
    fn atanh(self) -> Self;
    /// Natural exponential less one, without loss of digits near zero.
    #[must_use]
    fn exp_m1(self) -> Self;
    /// Natural logarithm of one plus `self`, without loss of digits near zero.
    #[must_use]
    fn ln_1p(self) -> Self;
    /// Error function.
    #[must_use]
    fn erf(self) -> Self;
    /// Inverse of the error function.
    #[must_use]
    fn erf_inv(self) -> Self;
    /// Largest integer that is not above `self`.
    #[must_use]
    fn floor(self) -> Self;
    /// Smallest integer that is not below `self`.
    #[must_use]
    fn ceil(self) -> Self;
    /// What the division by `divisor`, rounded to an integer towards zero, leaves; it has the sign
    /// of `self`. Exact.
    #[must_use]
    fn fmod(self, divisor: Self) -> Self;
    /// What the division by `divisor`, rounded to the nearest integer (half to even), leaves. Exact.
    #[must_use]
    fn remainder(self, divisor: Self) -> Self;
    /// Root of the sum of the squares, without overflow in between.
    #[must_use]
    fn hypot(self, other: Self) -> Self;
    // emit: on
    /// `self` with the sign of `sign`.
    #[must_use]
    fn copysign(self, sign: Self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// -1, 0 or 1.
    #[must_use]
    fn sign(self) -> Self;
    /// The smaller of two numbers.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The larger of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// 1 where `self < other`, else 0.
    #[must_use]
    fn less(self, other: Self) -> Self;
    /// 1 where `self <= other`, else 0.
    #[must_use]
    fn less_or_equal(self, other: Self) -> Self;
    /// 1 where `self == other`, else 0.
    #[must_use]
    fn equal(self, other: Self) -> Self;
    /// `value` where `self` is not 0, else 0, whatever `value` is there.
    #[must_use]
    fn if_else_zero(self, value: Self) -> Self;

    /// `self * factor + addend`, fused into one rounding only where the target does so fast.
    #[inline(always)]
    #[must_use]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
}

/// A real number with an order: what a filter needs beyond what generated code does.
pub trait Real: Scalar + PartialOrd + Default + core::fmt::Debug {
    /// Zero, as a constant: for filters in `static` memory.
    const ZERO: Self;
    /// The number nearest to `count`.
    #[must_use]
    fn from_u32(count: u32) -> Self;
    /// The number without its fraction; 0 below zero and for NaN, `u32::MAX` beyond it.
    #[must_use]
    fn to_u32(self) -> u32;
    /// The number as `f64`.
    #[must_use]
    fn to_f64(self) -> f64;
    /// Distance from 1 to the next larger number.
    #[must_use]
    fn epsilon() -> Self;
    /// True for a type whose rounding is not small against what a filter adds in a step: its sums are
    /// then carried with what rounding leaves. A constant for each type.
    #[inline(always)]
    #[must_use]
    fn is_coarse() -> bool {
        Self::epsilon() > Self::from_f64(1e-10)
    }
    /// Greater than zero; not so for NaN.
    #[inline(always)]
    #[must_use]
    fn is_positive(self) -> bool {
        self > Self::from_f64(0.0)
    }
    /// Not a number.
    #[must_use]
    fn is_nan(self) -> bool;
    /// Neither infinite nor NaN.
    #[must_use]
    fn is_finite(self) -> bool;
}
