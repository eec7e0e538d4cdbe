//! A controller with a filter on an extended model: it estimates and compensates the effects of
//! `extended.model.toml` together with the nine drift coefficients.
//!
//! Nothing here allocates or needs the standard library. README.md shows the way from a record with
//! a fault to this package.

#![no_std]

mod controller;

/// The model of `extended.model.toml`, with exact Jacobians.
pub mod extended {
    include!(concat!(env!("OUT_DIR"), "/extended.rs"));
}

pub use controller::{Controller, controller};
