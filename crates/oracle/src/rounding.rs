//! Running bound of the rounding error of a result, operation by operation.
//!
//! A relative tolerance fails where terms cancel. The derivative of a drift by a mass unbalance is
//! the specific force a along an axis. With the axis nearly horizontal, a = 1e-4 is the difference
//! of terms near 1 with their rounding error of 1e-16, which is 1e-12 of it. No arithmetic of the
//! same precision is better, so a comparison must allow this error there, and only there.
//! [`RunningError`] computes it for the operations of the generated function.

use core::ops::{Add, Div, Mul, Neg, Sub};

use gyrocal_scalar::Scalar;

use crate::error_function;

/// Unit roundoff of `f64`: the largest relative error of one correctly rounded operation.
pub const ROUNDOFF_F64: f64 = f64::EPSILON / 2.0;
/// Unit roundoff of `f32`.
pub const ROUNDOFF_F32: f64 = f32::EPSILON as f64 / 2.0;

/// A number with a bound on its accumulated rounding error, in unit roundoffs.
///
/// The bound is of first order (products of errors are neglected), so one evaluation serves every
/// precision: multiply [`RunningError::bound`] by its unit roundoff. Comparisons are taken as exact.
#[derive(Clone, Copy, Debug)]
pub struct RunningError {
    value: f64,
    bound: f64,
}

impl RunningError {
    /// A number without error.
    #[must_use]
    pub fn exact(value: f64) -> Self {
        Self { value, bound: 0.0 }
    }

    /// The number.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Bound of its absolute error, divided by the unit roundoff.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.bound
    }

    /// A basic operation: correctly rounded, so half a unit in the last place.
    fn rounded(value: f64, inherited: f64) -> Self {
        Self {
            value,
            bound: inherited + value.abs(),
        }
    }

    /// A function with derivative `slope`: at most one unit in the last place.
    fn function(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            bound: inherited(slope, self.bound) + 2.0 * value.abs(),
        }
    }
}

/// Error propagated by a factor; zero for an exact operand.
fn inherited(slope: f64, bound: f64) -> f64 {
    if bound == 0.0 {
        0.0
    } else {
        slope.abs() * bound
    }
}

// Inlined into generated code these operations would take minutes to compile.

impl Add for RunningError {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        Self::rounded(self.value + other.value, self.bound + other.bound)
    }
}

impl Sub for RunningError {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        Self::rounded(self.value - other.value, self.bound + other.bound)
    }
}

impl Mul for RunningError {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let inherited = inherited(other.value, self.bound) + inherited(self.value, other.bound);
        Self::rounded(self.value * other.value, inherited)
    }
}

impl Div for RunningError {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let slope = 1.0 / other.value;
        let inherited = inherited(slope, self.bound) + inherited(value * slope, other.bound);
        Self::rounded(value, inherited)
    }
}

impl Neg for RunningError {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            bound: self.bound,
        }
    }
}

impl Scalar for RunningError {
    fn from_f64(value: f64) -> Self {
        // Rounded in any precision below f64, unless it is short enough for f32.
        let short = f64::from(value as f32) == value;
        Self {
            value,
            bound: if short { 0.0 } else { value.abs() },
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        (self.function(sine, cosine), self.function(cosine, sine))
    }
    fn tan(self) -> Self {
        let value = self.value.tan();
        self.function(value, 1.0 + value * value)
    }
    fn asin(self) -> Self {
        self.function(
            self.value.asin(),
            1.0 / (1.0 - self.value * self.value).sqrt(),
        )
    }
    fn acos(self) -> Self {
        self.function(
            self.value.acos(),
            1.0 / (1.0 - self.value * self.value).sqrt(),
        )
    }
    fn atan(self) -> Self {
        self.function(self.value.atan(), 1.0 / (1.0 + self.value * self.value))
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let other = inherited(self.value / square, x.bound);
        let mut result = self.function(self.value.atan2(x.value), x.value / square);
        result.bound += other;
        result
    }
    fn sinh(self) -> Self {
        self.function(self.value.sinh(), self.value.cosh())
    }
    fn cosh(self) -> Self {
        self.function(self.value.cosh(), self.value.sinh())
    }
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.function(value, 1.0 - value * value)
    }
    fn asinh(self) -> Self {
        self.function(
            self.value.asinh(),
            1.0 / (1.0 + self.value * self.value).sqrt(),
        )
    }
    fn acosh(self) -> Self {
        self.function(
            self.value.acosh(),
            1.0 / (self.value * self.value - 1.0).sqrt(),
        )
    }
    fn atanh(self) -> Self {
        self.function(self.value.atanh(), 1.0 / (1.0 - self.value * self.value))
    }
    fn exp_m1(self) -> Self {
        self.function(self.value.exp_m1(), self.value.exp())
    }
    fn ln_1p(self) -> Self {
        self.function(self.value.ln_1p(), 1.0 / (1.0 + self.value))
    }
    fn erf(self) -> Self {
        let slope = error_function::slope(self.value);
        self.function(error_function::erf(self.value), slope)
    }
    fn erf_inv(self) -> Self {
        let value = error_function::erf_inv(self.value);
        self.function(value, 1.0 / error_function::slope(value))
    }
    fn floor(self) -> Self {
        Self::exact(self.value.floor())
    }
    fn ceil(self) -> Self {
        Self::exact(self.value.ceil())
    }
    fn fmod(self, divisor: Self) -> Self {
        let times = (self.value / divisor.value).trunc();
        let inherited = self.bound + inherited(times, divisor.bound);
        Self {
            value: self.value % divisor.value,
            bound: inherited,
        }
    }
    fn remainder(self, divisor: Self) -> Self {
        let times = (self.value / divisor.value).round_ties_even();
        let inherited = self.bound + inherited(times, divisor.bound);
        Self {
            value: Scalar::remainder(self.value, divisor.value),
            bound: inherited,
        }
    }
    fn hypot(self, other: Self) -> Self {
        let value = self.value.hypot(other.value);
        let bound = inherited(other.value / value, other.bound);
        let mut result = self.function(value, self.value / value);
        result.bound += bound;
        result
    }
    fn copysign(self, sign: Self) -> Self {
        Self {
            value: self.value.copysign(sign.value),
            ..self
        }
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.function(value, value)
    }
    fn ln(self) -> Self {
        self.function(self.value.ln(), 1.0 / self.value)
    }
    fn sqrt(self) -> Self {
        let value = self.value.sqrt();
        self.function(value, 0.5 / value)
    }
    fn powf(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let other = inherited(value * self.value.ln(), exponent.bound);
        let mut result = self.function(value, exponent.value * value / self.value);
        result.bound += other;
        result
    }
    fn abs(self) -> Self {
        Self {
            value: self.value.abs(),
            ..self
        }
    }
    fn sign(self) -> Self {
        Self::exact(Scalar::sign(self.value))
    }
    fn min(self, other: Self) -> Self {
        Self {
            value: self.value.min(other.value),
            bound: self.bound.max(other.bound),
        }
    }
    fn max(self, other: Self) -> Self {
        Self {
            value: self.value.max(other.value),
            bound: self.bound.max(other.bound),
        }
    }
    fn less(self, other: Self) -> Self {
        Self::exact(self.value.less(other.value))
    }
    fn less_or_equal(self, other: Self) -> Self {
        Self::exact(self.value.less_or_equal(other.value))
    }
    fn equal(self, other: Self) -> Self {
        Self::exact(self.value.equal(other.value))
    }
    fn if_else_zero(self, value: Self) -> Self {
        if self.value == 0.0 {
            Self::exact(0.0)
        } else {
            value
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation of the trait, strung together without running into a singularity.
    fn everything<T: Scalar>(x: T, y: T) -> [T; 6] {
        let c = T::from_f64;
        let (sine, cosine) = (x * y).sin_cos();
        let first = (sine / (cosine + c(1.5))).tan() + x.atan2(y) - x.tanh() * y.sinh();
        let second = (x.cosh() + y.abs()).ln() * (sine * c(0.3)).asin() + (cosine * c(0.3)).acos();
        let third = (x.exp() + c(0.1)).sqrt().powf(y * c(0.7)) - (-y).atan().mul_add(x, y);
        let fourth = (x - y).less(c(0.0)).if_else_zero(first) + x.min(y) * y.max(c(0.2)) * x.sign();
        let fifth = (x * y).asinh()
            + (x.hypot(y) + c(1.5)).acosh() * (sine * c(0.4)).atanh()
            + (x * c(0.1)).exp_m1() / y.ln_1p();
        let sixth = (x * c(0.3)).erf().copysign(cosine)
            + (sine * c(0.9)).erf_inv()
            + (x * y).floor() * y.ceil();
        [first, second, third, fourth, fifth, sixth]
    }

    #[test]
    fn single_precision_stays_inside_its_bound_and_comes_near_it() {
        let mut closest: f64 = 0.0;
        for i in 1..200_u16 {
            for j in 1..50_u16 {
                let (x, y) = (f32::from(i) / 128.0, f32::from(j) / 32.0);
                let bounds =
                    everything(RunningError::exact(x.into()), RunningError::exact(y.into()));
                let exact = everything(f64::from(x), f64::from(y));
                for ((single, exact), bound) in everything(x, y).iter().zip(exact).zip(bounds) {
                    let ratio = (f64::from(*single) - exact).abs() / (bound.bound() * ROUNDOFF_F32);
                    assert!(ratio <= 1.0, "{ratio} of the bound at ({x}, {y})");
                    closest = closest.max(ratio);
                }
            }
        }
        // A bound that is far too generous would let anything pass. Worst cases seldom meet
        // in one sum of some twenty errors; a tenth of it does occur.
        assert!(closest > 0.1, "never more than {closest} of the bound");
    }

    #[test]
    fn cancellation_keeps_the_error_of_the_terms() {
        let third = RunningError::exact(1.0) / RunningError::exact(3.0);
        let difference = third - RunningError::exact(0.333);
        assert!(difference.bound() > 1.0 / 3.0);
        assert!(difference.bound() / difference.value() > 999.0);
    }
}
