//! Elementary functions of single precision that use single precision and integers only: a
//! processor with a single-precision unit computes them without software for `f64`.
//!
//! They take the place of functions of `libm` that compute in `f64` and round. Their bits are the
//! same on every machine. Each states its largest error in units of the last place (ulp) of the
//! result; the tests find it against `f64` (`tests/single_precision.rs`).

mod circular;
mod reduction;

pub use circular::{sin_cos_f32, tan_f32};

// emit: off
mod inverse;
pub(crate) use inverse::hypot_f32;
pub use inverse::{asin_f32, erf_inv_f32};
// emit: on
