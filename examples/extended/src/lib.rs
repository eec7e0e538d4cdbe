//! A controller with a filter on an extended model: it estimates and compensates the effects of
//! `extended.model.toml` together with the nine drift coefficients. Beside it a filter for a strapdown
//! unit, of `unit.model.toml`.
//!
//! Nothing here allocates or needs the standard library. README.md shows the way from a record with
//! a fault to this package.

#![no_std]

mod controller;
mod unit_filter;

/// The model of `extended.model.toml`, with exact Jacobians.
#[allow(clippy::too_many_lines, reason = "as long as their equations")]
pub mod extended {
    include!(concat!(env!("OUT_DIR"), "/extended.rs"));
}

/// The model of `unit.model.toml`, whose gyros are fixed to a body.
#[allow(clippy::too_many_lines, reason = "as long as their equations")]
pub mod unit {
    include!(concat!(env!("OUT_DIR"), "/unit.rs"));
}

pub use controller::{Controller, controller};
pub use unit_filter::{UnitFilter, unit_filter};
