//! Rust that `gyrocal-codegen` emits from the symbolic model in `codegen/derive`.
//!
//! The committed files are compiled as they are unless the build found that the sources of
//! the derivation were edited; then it derives them again into its own output directory.

/// The platform: frames, drift law, dynamics, measurement, and their exact Jacobians.
#[cfg(not(gyrocal_rederived))]
#[rustfmt::skip]
pub mod platform;

/// The platform: frames, drift law, dynamics, measurement, and their exact Jacobians.
#[cfg(gyrocal_rederived)]
pub mod platform {
    include!(concat!(env!("OUT_DIR"), "/platform.rs"));
}

/// Functions that only tests run: the Runge-Kutta step written out, with its exact Jacobian.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
#[rustfmt::skip]
pub mod oracle;

/// Functions that only tests run: the Runge-Kutta step written out, with its exact Jacobian.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub mod oracle {
    include!(concat!(env!("OUT_DIR"), "/oracle.rs"));
}

/// The program of [`platform`], as derived: for interpreters.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
pub const PLATFORM_PROGRAM: &str = include_str!("generated/platform.json");

/// The program of [`platform`], as derived: for interpreters.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub const PLATFORM_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/platform.json"));

/// The program of [`oracle`], as derived: for interpreters.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
pub const ORACLE_PROGRAM: &str = include_str!("generated/oracle.json");

/// The program of [`oracle`], as derived: for interpreters.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub const ORACLE_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/oracle.json"));
