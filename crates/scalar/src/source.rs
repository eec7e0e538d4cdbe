//! Texts of the files of this crate, for programs that emit them as one.

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!($path))),*]
    };
}

/// Name of each file below the directory of the sources, and its text.
pub const FILES: &[(&str, &str)] = files![
    "exact.rs",
    "exponential.rs",
    "float.rs",
    "lib.rs",
    "model.rs",
    "scalar.rs",
    "single.rs",
    "single/circular.rs",
    "single/reduction.rs",
    "trigonometry.rs",
];
