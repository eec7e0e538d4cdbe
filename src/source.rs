//! Texts of the files of this crate, for programs that emit them as one.

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!($path))),*]
    };
}

/// Name of each file below the directory of the sources, and its text.
pub const FILES: &[(&str, &str)] = files![
    "anchor.rs",
    "chart_vectors.rs",
    "controller.rs",
    "controller/taking.rs",
    "controller_error.rs",
    "extension.rs",
    "filter.rs",
    "filter/curvature.rs",
    "generated.rs",
    "initial_attitude.rs",
    "lib.rs",
    "limits.rs",
    "orientation.rs",
    "regressors.rs",
    "rotation.rs",
    "saved.rs",
    "settings.rs",
    "site.rs",
];

/// The text of [`crate::generated::platform`].
#[cfg(not(gyrocal_rederived))]
pub const PLATFORM: &str = include_str!("generated/platform.rs");

/// The text of [`crate::generated::platform`].
#[cfg(gyrocal_rederived)]
pub const PLATFORM: &str = include_str!(concat!(env!("OUT_DIR"), "/platform.rs"));
