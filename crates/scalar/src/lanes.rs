use core::array;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Scalar;

/// `N` numbers computed side by side: one generated function serves `N` filters at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<T, const N: usize>(pub [T; N]);

impl<T: Scalar, const N: usize> Lanes<T, N> {
    #[inline(always)]
    fn map(self, function: impl Fn(T) -> T) -> Self {
        Self(self.0.map(function))
    }

    #[inline(always)]
    fn zip(self, other: Self, function: impl Fn(T, T) -> T) -> Self {
        Self(array::from_fn(|lane| function(self.0[lane], other.0[lane])))
    }
}

macro_rules! impl_operator {
    ($($operator:ident $method:ident),*) => {$(
        impl<T: Scalar, const N: usize> $operator for Lanes<T, N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, $operator::$method)
            }
        }
    )*};
}
impl_operator!(Add add, Sub sub, Mul mul, Div div);

impl<T: Scalar, const N: usize> Neg for Lanes<T, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(Neg::neg)
    }
}

macro_rules! lanewise {
    ($($unary:ident)* ; $($binary:ident)*) => {
        $(#[inline]
        fn $unary(self) -> Self {
            self.map(Scalar::$unary)
        })*
        $(#[inline]
        fn $binary(self, other: Self) -> Self {
            self.zip(other, Scalar::$binary)
        })*
    };
}

impl<T: Scalar, const N: usize> Scalar for Lanes<T, N> {
    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self([T::from_f64(value); N])
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let pairs = self.0.map(Scalar::sin_cos);
        (
            Self(pairs.map(|pair| pair.0)),
            Self(pairs.map(|pair| pair.1)),
        )
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        Self(array::from_fn(|lane| {
            self.0[lane].mul_add(factor.0[lane], addend.0[lane])
        }))
    }
    lanewise!(tan asin acos atan sinh cosh tanh asinh acosh atanh exp exp_m1 ln ln_1p sqrt
              erf erf_inv floor ceil abs sign;
              atan2 powf fmod remainder hypot copysign min max less less_or_equal equal
              if_else_zero);
}
