//! Rust that `gyrocal-codegen` emits from the symbolic model in `codegen/derive`.
//!
//! The committed files are compiled as they are unless the build found that the sources of
//! the derivation were edited; then it derives them again into its own output directory.

#![allow(clippy::too_many_lines, reason = "as long as their equations")]

/// The platform: frames, drift law, dynamics, measurement, and their exact Jacobians.
#[cfg(not(gyrocal_rederived))]
#[rustfmt::skip]
pub mod platform;

/// The platform: frames, drift law, dynamics, measurement, and their exact Jacobians.
#[cfg(gyrocal_rederived)]
pub mod platform {
    include!(concat!(env!("OUT_DIR"), "/platform.rs"));
}

// emit: off
/// The nominal platform with errors of latitude, Earth rate and gravity as parameters.
#[cfg(not(gyrocal_rederived))]
#[rustfmt::skip]
pub mod surveyed;

/// The nominal platform with errors of latitude, Earth rate and gravity as parameters.
#[cfg(gyrocal_rederived)]
pub mod surveyed {
    include!(concat!(env!("OUT_DIR"), "/surveyed.rs"));
}

/// The analytic platform of a strapdown unit: the drift law in the axes of gyros that are fixed to
/// a body.
#[cfg(not(gyrocal_rederived))]
#[rustfmt::skip]
pub mod strapdown;

/// The analytic platform of a strapdown unit: the drift law in the axes of gyros that are fixed to
/// a body.
#[cfg(gyrocal_rederived)]
pub mod strapdown {
    include!(concat!(env!("OUT_DIR"), "/strapdown.rs"));
}

/// The platform with every effect of the catalogue, and the table of effects.
#[cfg(all(feature = "catalogue", not(gyrocal_rederived)))]
#[rustfmt::skip]
pub mod catalogue;

/// The platform with every effect of the catalogue, and the table of effects.
#[cfg(all(feature = "catalogue", gyrocal_rederived))]
pub mod catalogue {
    include!(concat!(env!("OUT_DIR"), "/catalogue.rs"));
}

/// The analytic platform of a strapdown unit with every effect of the catalogue.
#[cfg(all(feature = "catalogue", not(gyrocal_rederived)))]
#[rustfmt::skip]
pub mod strapdown_catalogue;

/// The analytic platform of a strapdown unit with every effect of the catalogue.
#[cfg(all(feature = "catalogue", gyrocal_rederived))]
pub mod strapdown_catalogue {
    include!(concat!(env!("OUT_DIR"), "/strapdown_catalogue.rs"));
}

/// Hash of what [`platform`] was derived from, as its header says: the symbolic sources, the
/// pinned tools and the emitter.
#[cfg(not(gyrocal_rederived))]
pub const MODEL_HASH: &str = inputs_hash(include_str!("generated/platform.rs"));

/// Hash of what [`platform`] was derived from, as its header says: the symbolic sources, the
/// pinned tools and the emitter.
#[cfg(gyrocal_rederived)]
pub const MODEL_HASH: &str = inputs_hash(include_str!(concat!(env!("OUT_DIR"), "/platform.rs")));

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

/// The program of [`surveyed`], as derived: for interpreters.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
pub const SURVEYED_PROGRAM: &str = include_str!("generated/surveyed.json");

/// The program of [`surveyed`], as derived: for interpreters.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub const SURVEYED_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/surveyed.json"));

/// The program of [`strapdown`], as derived: for interpreters.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
pub const STRAPDOWN_PROGRAM: &str = include_str!("generated/strapdown.json");

/// The program of [`strapdown`], as derived: for interpreters.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub const STRAPDOWN_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/strapdown.json"));

/// The program of [`catalogue`], as derived: for interpreters.
#[cfg(all(feature = "catalogue", feature = "oracle", not(gyrocal_rederived)))]
pub const CATALOGUE_PROGRAM: &str = include_str!("generated/catalogue.json");

/// The program of [`catalogue`], as derived: for interpreters.
#[cfg(all(feature = "catalogue", feature = "oracle", gyrocal_rederived))]
pub const CATALOGUE_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/catalogue.json"));

/// The program of [`strapdown_catalogue`], as derived: for interpreters.
#[cfg(all(feature = "catalogue", feature = "oracle", not(gyrocal_rederived)))]
pub const STRAPDOWN_CATALOGUE_PROGRAM: &str = include_str!("generated/strapdown_catalogue.json");

/// The program of [`strapdown_catalogue`], as derived: for interpreters.
#[cfg(all(feature = "catalogue", feature = "oracle", gyrocal_rederived))]
pub const STRAPDOWN_CATALOGUE_PROGRAM: &str =
    include_str!(concat!(env!("OUT_DIR"), "/strapdown_catalogue.json"));

/// The program of [`oracle`], as derived: for interpreters.
#[cfg(all(feature = "oracle", not(gyrocal_rederived)))]
pub const ORACLE_PROGRAM: &str = include_str!("generated/oracle.json");

/// The program of [`oracle`], as derived: for interpreters.
#[cfg(all(feature = "oracle", gyrocal_rederived))]
pub const ORACLE_PROGRAM: &str = include_str!(concat!(env!("OUT_DIR"), "/oracle.json"));

/// The hexadecimal digits on the line `Inputs` of a generated file's header; a file without it
/// does not compile.
const fn inputs_hash(source: &'static str) -> &'static str {
    const MARK: &[u8] = b"\n// Inputs: ";
    const DIGITS: usize = 64;
    let bytes = source.as_bytes();
    let mut start = 0;
    let mut matched = 0;
    while matched < MARK.len() {
        if bytes[start + matched] == MARK[matched] {
            matched += 1;
        } else {
            start += 1;
            matched = 0;
        }
    }
    source.split_at(start + MARK.len()).1.split_at(DIGITS).0
}
// emit: on
