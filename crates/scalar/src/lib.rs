//! The number and model traits that generated code names.
//!
//! Generated functions are generic over [`Scalar`], so one derivation serves `f64`, `f32`,
//! several filters side by side ([`Lanes`]) and dual numbers. A generated model implements
//! [`Model`], which is all that the filters of `gyrocal-estimation` know of it.
//!
//! Nothing here allocates or needs the standard library. Sine, cosine and exponential are
//! computed by this crate ([`sin_cos_f64`], [`exp_f64`]), so their bits do not depend on the
//! machine. Functions of `f32` compute in `f32` and integers: nothing needs software for `f64` on a
//! processor with a single-precision unit.
//!
//! Lines between `// emit: off` and `// emit: on` are left out of a file that `gyrocal emit` writes.

#![no_std]

#[cfg(feature = "std")]
extern crate std;

// emit: off
/// Declares the module of a generated file: the committed `generated/NAME.rs` beside the source file
/// that says so, or, where the build script has derived it again, the one in its output directory.
///
/// ```ignore
/// gyrocal_scalar::generated! {
///     /// The model, with exact Jacobians.
///     pub mod tank
/// }
/// ```
///
/// The build script sets the condition `rederived`: `gyrocal_codegen::build::main("derive")`.
#[macro_export]
macro_rules! generated {
    ($(#[$attribute:meta])* $visibility:vis mod $name:ident) => {
        #[cfg(not(rederived))]
        #[allow(clippy::too_many_lines, reason = "as long as their equations")]
        $(#[$attribute])*
        $visibility mod $name {
            include!(concat!("generated/", stringify!($name), ".rs"));
        }
        #[cfg(rederived)]
        #[allow(clippy::too_many_lines, reason = "as long as their equations")]
        $(#[$attribute])*
        $visibility mod $name {
            include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
        }
    };
}

pub mod effect;
mod error_function;
mod lanes;
// emit: on

mod exact;
mod exponential;
mod float;
mod model;
mod scalar;
mod single;
mod trigonometry;

pub use exponential::exp_f64;
pub use model::{Element, Model, NamedInputs, RatesJacobian, Recentre};
pub use scalar::{Real, Scalar};
pub use single::{sin_cos_f32, tan_f32};
pub use trigonometry::sin_cos_f64;

// emit: off
#[cfg(feature = "source")]
pub mod source;
pub use error_function::erf_inv_f64;
pub use lanes::Lanes;
pub use single::{asin_f32, erf_inv_f32};
// emit: on
