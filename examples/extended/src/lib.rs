//! A controller with a filter on an extended model: what `extended.model.toml` says of the
//! platform beside the nine drift coefficients is estimated and compensated too.
//!
//! Nothing here allocates or needs the standard library. README.md is the walk from a record
//! with a fault to this package.

#![no_std]

mod controller;

/// The model of `extended.model.toml`, with exact Jacobians.
pub mod extended {
    include!(concat!(env!("OUT_DIR"), "/extended.rs"));
}

pub use controller::{Controller, ExtendedFilter};
