//! Writes a filter as one self-contained Rust file.
//!
//! # What it does
//!
//! [`Emission::write`] puts the sources of `gyrocal-scalar`, `gyrocal-estimation` and `gyrocal` into the
//! modules of one file, with the generated model and, for an extended filter, the module that a build
//! derived from a model file. So the file has the filter step of the libraries, line by line, and no
//! second one. It needs `core` only and compiles by itself: `rustc --edition 2024 --crate-type lib`.
//!
//! The file has its own tests: samples, and coefficients and sigmas that the libraries find from them.
//! Those of a nominal filter come from [`gyrocal::ControllerFilter`] in the same number type; those of an
//! extended one from the model of the whole catalogue, all other effects of which are pinned to zero.
//!
//! # What the file leaves out
//!
//! Elementary functions that no filter uses, and what is behind features: batch estimation, the catalogue,
//! the watch. Lines of the sources between `// emit: off` and `// emit: on` are left out. The few
//! functions of `libm` that remain have forms of their own in the file (`elementary.rs`).

mod bundle;
#[cfg(test)]
mod elementary;
mod emission;
mod error;
mod number;
mod reference;
mod text;

pub use emission::{Emission, Extension};
pub use error::EmitError;
pub use number::Number;
