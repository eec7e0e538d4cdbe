use gyrocal_scalar::Real;

use crate::covariance::Covariance;
use crate::factor::Factors;
use crate::form::Form;

/// A number type with the form of the covariance that suits its precision: the form of a filter
/// that does not name one.
///
/// From wide priors an update cancels more digits than `f32` has, and [`Covariance`] stops with an
/// error. [`Factors`] cannot lose definiteness, so they are the form of `f32`. In `f64` both hold,
/// and [`Covariance`] is the faster.
pub trait Precision: Real {
    /// The form of a filter of such numbers.
    type Form: Form<Self> + Copy + core::fmt::Debug;
}

impl Precision for f64 {
    type Form = Covariance;
}

impl Precision for f32 {
    type Form = Factors;
}
