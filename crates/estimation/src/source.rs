//! Texts of the files of this crate, for programs that emit them as one.

macro_rules! files {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_str!($path))),*]
    };
}

/// Name of each file below the directory of the sources, and its text.
pub const FILES: &[(&str, &str)] = files![
    "covariance.rs",
    "covariance/predict.rs",
    "covariance/update.rs",
    "error.rs",
    "factor.rs",
    "factor/diffuse.rs",
    "factor/innovation.rs",
    "factor/predict.rs",
    "factor/update.rs",
    "filter.rs",
    "filter/predict.rs",
    "filter/saved.rs",
    "filter/update.rs",
    "form.rs",
    "innovation.rs",
    "lib.rs",
    "manifold.rs",
    "observe.rs",
    "precision.rs",
    "projection.rs",
    "recentring.rs",
    "storage.rs",
    "transition.rs",
    "unrolled.rs",
    "zeros.rs",
];
