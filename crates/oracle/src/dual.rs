//! Dual numbers as [`Scalar`]: a generated value function called with them returns its
//! exact derivatives, by the chain rule alone and independent of its Jacobian.

use core::ops::{Add, Div, Mul, Neg, Sub};

use gyrocal_scalar::Scalar;
use num_dual::{Derivative, DualNum, DualSVec64};

use crate::error_function;

/// A number with its derivatives with respect to `N` variables.
#[derive(Clone, Copy, Debug)]
pub struct Dual<const N: usize>(DualSVec64<N>);

impl<const N: usize> Dual<N> {
    /// A number that depends on no variable.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self(DualSVec64::from_re(value))
    }

    /// The variable with the given number, at `value`.
    ///
    /// # Panics
    /// If `variable` is not below `N`.
    #[must_use]
    pub fn variable(value: f64, variable: usize) -> Self {
        Self(DualSVec64::from_re(value).derivative(variable))
    }

    /// The number itself.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.0.re
    }

    /// Its derivatives with respect to the variables.
    #[must_use]
    pub fn gradient(&self) -> [f64; N] {
        core::array::from_fn(|variable| self.derivative(variable))
    }

    /// Its derivative with respect to one variable.
    ///
    /// # Panics
    /// If `variable` is not below `N`.
    #[must_use]
    pub fn derivative(&self, variable: usize) -> f64 {
        assert!(variable < N, "variable {variable} of {N}");
        self.0.eps.0.map_or(0.0, |eps| eps[variable])
    }
}

/// Jacobian of `function` with respect to the inputs whose places are `by`, row by row, and
/// `by.len()` columns.
///
/// # Panics
/// If `by` has more than `N` places, or one that `point` does not have.
#[must_use]
pub fn jacobian<const N: usize>(
    function: impl Fn(&[Dual<N>]) -> Vec<Dual<N>>,
    point: &[f64],
    by: &[usize],
) -> Vec<f64> {
    let mut inputs: Vec<Dual<N>> = point.iter().map(|&value| Dual::constant(value)).collect();
    for (variable, &place) in by.iter().enumerate() {
        inputs[place] = Dual::variable(point[place], variable);
    }
    function(&inputs)
        .iter()
        .flat_map(|output| (0..by.len()).map(|variable| output.derivative(variable)))
        .collect()
}

macro_rules! operators {
    ($($operator:ident $method:ident),*) => {$(
        impl<const N: usize> $operator for Dual<N> {
            type Output = Self;
            // Inlined into generated code these would take minutes to compile.
            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                Self($operator::$method(self.0, other.0))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! by_num_dual {
    ($($method:ident)*) => {$(
        fn $method(self) -> Self {
            Self(DualNum::$method(&self.0))
        }
    )*};
}

impl<const N: usize> Dual<N> {
    /// A function of this number, by its value and slope.
    fn chained(self, value: f64, slope: f64) -> Self {
        Self(DualSVec64::new(value, self.0.eps * slope))
    }
}

impl<const N: usize> Scalar for Dual<N> {
    fn from_f64(value: f64) -> Self {
        Self::constant(value)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.0.sin_cos();
        (Self(sine), Self(cosine))
    }
    by_num_dual!(tan asin acos atan sinh cosh tanh asinh acosh atanh exp exp_m1 ln ln_1p sqrt);

    fn erf(self) -> Self {
        let x = self.0.re;
        self.chained(error_function::erf(x), error_function::slope(x))
    }
    fn erf_inv(self) -> Self {
        let y = error_function::erf_inv(self.0.re);
        self.chained(y, 1.0 / error_function::slope(y))
    }
    fn floor(self) -> Self {
        Self::constant(self.0.re.floor())
    }
    fn ceil(self) -> Self {
        Self::constant(self.0.re.ceil())
    }
    fn fmod(self, divisor: Self) -> Self {
        // Both are self less a multiple of the divisor that is constant nearby.
        self - divisor * Self::constant((self.0.re / divisor.0.re).trunc())
    }
    fn remainder(self, divisor: Self) -> Self {
        self - divisor * Self::constant((self.0.re / divisor.0.re).round_ties_even())
    }
    fn hypot(self, other: Self) -> Self {
        let value = self.0.re.hypot(other.0.re);
        let eps: Derivative<f64, _, _> =
            self.0.eps * (self.0.re / value) + other.0.eps * (other.0.re / value);
        Self(DualSVec64::new(value, eps))
    }
    fn copysign(self, sign: Self) -> Self {
        if self.0.re.is_sign_negative() == sign.0.re.is_sign_negative() {
            self
        } else {
            -self
        }
    }

    fn atan2(self, x: Self) -> Self {
        // Not num-dual's, which goes through the ratio and has no derivative at x = 0.
        let square = self.0.re * self.0.re + x.0.re * x.0.re;
        let eps: Derivative<f64, _, _> =
            self.0.eps * (x.0.re / square) - x.0.eps * (self.0.re / square);
        Self(DualSVec64::new(self.0.re.atan2(x.0.re), eps))
    }
    fn powf(self, exponent: Self) -> Self {
        if exponent.0.eps.0.is_none() {
            // A negative base has derivatives as long as the exponent is a constant.
            Self(DualNum::powf(&self.0, exponent.0.re))
        } else {
            (exponent * self.ln()).exp()
        }
    }
    fn abs(self) -> Self {
        if self.0.re < 0.0 { -self } else { self }
    }
    fn sign(self) -> Self {
        Self::constant(Scalar::sign(self.0.re))
    }
    fn min(self, other: Self) -> Self {
        if other.0.re < self.0.re { other } else { self }
    }
    fn max(self, other: Self) -> Self {
        if other.0.re > self.0.re { other } else { self }
    }
    fn less(self, other: Self) -> Self {
        Self::constant(self.0.re.less(other.0.re))
    }
    fn less_or_equal(self, other: Self) -> Self {
        Self::constant(self.0.re.less_or_equal(other.0.re))
    }
    fn equal(self, other: Self) -> Self {
        Self::constant(self.0.re.equal(other.0.re))
    }
    fn if_else_zero(self, value: Self) -> Self {
        if self.0.re == 0.0 {
            Self::constant(0.0)
        } else {
            value
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Function = fn(Dual<1>) -> Dual<1>;

    fn derivative(function: impl Fn(Dual<1>) -> Dual<1>, at: f64) -> f64 {
        function(Dual::variable(at, 0)).derivative(0)
    }

    #[test]
    fn derivatives_of_every_function_are_those_of_the_textbook() {
        let x: f64 = 0.6;
        let root = (1.0 - x * x).sqrt();
        let h = x.hypot(2.0);
        let cases: [(&str, Function, f64); 32] = [
            ("asinh", Scalar::asinh, 1.0 / (1.0 + x * x).sqrt()),
            (
                "acosh(x + 1)",
                |x| (x + c(1.0)).acosh(),
                1.0 / (x * (x + 2.0)).sqrt(),
            ),
            ("atanh", Scalar::atanh, 1.0 / (1.0 - x * x)),
            ("exp_m1", Scalar::exp_m1, x.exp()),
            ("ln_1p", Scalar::ln_1p, 1.0 / (1.0 + x)),
            (
                "erf",
                Scalar::erf,
                core::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp(),
            ),
            ("erf_inv(erf)", |x| x.erf().erf_inv(), 1.0),
            ("hypot(x, 2)", |x| x.hypot(c(2.0)), x / h),
            ("hypot(2, x)", |x| c(2.0).hypot(x), x / h),
            ("fmod(x, 0.25)", |x| x.fmod(c(0.25)), 1.0),
            ("fmod(2, x)", |x| c(2.0).fmod(x), -3.0),
            ("remainder(2, x)", |x| c(2.0).remainder(x), -3.0),
            ("copysign(x, -1)", |x| x.copysign(c(-1.0)), -1.0),
            ("sin", |x| x.sin_cos().0, x.cos()),
            ("cos", |x| x.sin_cos().1, -x.sin()),
            ("tan", Scalar::tan, 1.0 / x.cos().powi(2)),
            ("asin", Scalar::asin, 1.0 / root),
            ("acos", Scalar::acos, -1.0 / root),
            ("atan", Scalar::atan, 1.0 / (1.0 + x * x)),
            ("sinh", Scalar::sinh, x.cosh()),
            ("cosh", Scalar::cosh, x.sinh()),
            ("tanh", Scalar::tanh, 1.0 / x.cosh().powi(2)),
            ("exp", Scalar::exp, x.exp()),
            ("ln", Scalar::ln, 1.0 / x),
            ("sqrt", Scalar::sqrt, 0.5 / x.sqrt()),
            (
                "atan2(x, 2)",
                |x| x.atan2(Dual::constant(2.0)),
                2.0 / (4.0 + x * x),
            ),
            (
                "atan2(2, x)",
                |x| Dual::constant(2.0).atan2(x),
                -2.0 / (4.0 + x * x),
            ),
            ("x^2.5", |x| x.powf(Dual::constant(2.5)), 2.5 * x.powf(1.5)),
            ("x^x", |x| x.powf(x), x.powf(x) * (x.ln() + 1.0)),
            ("|x|", |x| (-x).abs(), 1.0),
            (
                "(x + 1) / (x - 3)",
                |x| (x + c(1.0)) / (x - c(3.0)),
                -4.0 / (x - 3.0).powi(2),
            ),
            ("if", |x| x.less(c(1.0)).if_else_zero(x * x), 2.0 * x),
        ];
        for (name, function, expected) in cases {
            let error = (derivative(function, x) / expected - 1.0).abs();
            // A handful of roundings of 1.1e-16 on either side.
            assert!(error <= 2e-15, "{name}: {error:e}");
        }
    }

    fn c(value: f64) -> Dual<1> {
        Dual::constant(value)
    }

    #[test]
    fn what_is_piecewise_constant_has_no_derivative() {
        let x = Dual::<1>::variable(0.5, 0);
        for number in [
            x.sign(),
            x.less(c(1.0)),
            x.less_or_equal(c(0.5)),
            x.equal(c(0.5)),
            x.ceil(),
            x.floor() + c(1.0),
        ] {
            assert_eq!((number.value(), number.derivative(0)), (1.0, 0.0));
        }
        // The branch that is not taken leaves nothing, not even what is not finite.
        let skipped = x.less(c(0.0)).if_else_zero(x / c(0.0));
        assert_eq!((skipped.value(), skipped.derivative(0)), (0.0, 0.0));
        let smaller = Scalar::min(x * x, x);
        assert_eq!((smaller.value(), smaller.derivative(0)), (0.25, 1.0));
        let larger = Scalar::max(x * x, x);
        assert_eq!((larger.value(), larger.derivative(0)), (0.5, 1.0));
    }

    #[test]
    fn the_angle_of_a_point_on_the_vertical_axis_has_a_derivative() {
        assert_eq!(derivative(|x| c(2.0).atan2(x), 0.0), -0.5);
    }

    #[test]
    fn a_jacobian_has_a_row_for_each_output_and_a_column_for_each_place() {
        // (u, v, w) -> (u v w, w²) by w and u.
        let function = |x: &[Dual<2>]| vec![x[0] * x[1] * x[2], x[2] * x[2]];
        let jacobian = jacobian(function, &[2.0, 3.0, 5.0], &[2, 0]);
        assert_eq!(jacobian, [6.0, 15.0, 10.0, 0.0]);
    }
}
