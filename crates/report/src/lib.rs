//! Pictures of calibration and diagnosis: plain numbers in, SVG or PNG out.
//!
//! Each picture is a structure of numbers and words, documented with units, that implements
//! [`Picture`]. The caller passes the title, which should say what is seen; the picture adds
//! units, the key to its signs, what its bands mean and how many values it shows.
//!
//! | picture | shows |
//! |---|---|
//! | [`Convergence`] | estimates against time with their bands |
//! | [`Residuals`] | residuals before and after, with the noise band |
//! | [`FreeRun`] | simulated and measured specific force, and their difference |
//! | [`Spectrum`] | periodograms with threshold and marked lines |
//! | [`Correlation`] | autocorrelations with the band of white noise |
//! | [`Against`] | binned means of a residual against what may cause it |
//! | [`Ranking`] | effects by test statistic, with threshold |
//! | [`Gain`] | what an extended model gains on held-out data and in predicted drift |
//! | [`Contributions`] | what single terms of a law contribute |
//! | [`Comparison`] | estimates of several estimators, with error bars |
//!
//! # Example
//!
//! ```
//! use gyrocal_report::{Picture, Residuals};
//!
//! let picture = Residuals {
//!     title: "Residuals are white".to_owned(),
//!     subtitle: String::new(),
//!     time_s: vec![0.0, 60.0, 120.0],
//!     before: [vec![1e-5, f64::NAN, -2e-5], vec![0.0; 3], vec![0.0; 3]],
//!     before_label: "innovation".to_owned(),
//!     after: None,
//!     sigma: [1e-5; 3],
//!     quantity: "residual".to_owned(),
//!     unit: "g".to_owned(),
//! };
//! let svg = picture.to_svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("Residuals are white"));
//! # Ok::<(), gyrocal_report::Error>(())
//! ```
//!
//! # Data
//!
//! Not-a-number is a missing value and leaves a gap; so does an interval of more than four times
//! the usual one. Infinite values, columns of unequal length and times that go back are errors.
//! A panel without any value says "no data". Long columns are thinned to at most four points for
//! each column of pixels, which keeps all extremes, so a picture of a million samples is small.
//!
//! The same data gives the same SVG, byte by byte.
//!
//! # Features
//!
//! - `png` (default): [`to_png`] and [`write_png`]. They draw letters with an embedded subset of
//!   DejaVu Sans and look for no fonts of the machine.
//!
//! # What it does not do
//!
//! It estimates and tests nothing: what is significant, which effect is named and how large the
//! noise is, it is told. It knows no model, record or report.

mod against;
mod axis;
mod canvas;
mod check;
mod comparison;
mod contributions;
mod convergence;
mod correlation;
mod error;
mod free_run;
mod gain;
mod number;
mod page;
mod panel;
mod picture;
#[cfg(feature = "png")]
mod png;
mod ranking;
mod residuals;
mod scale;
mod spectrum;
mod style;
mod text;
mod trace;

pub use against::{Against, AgainstPanel, Bin};
pub use comparison::{Comparison, Estimate, Quantity};
pub use contributions::{Contribution, Contributions};
pub use convergence::{Convergence, ConvergingCoefficient};
pub use correlation::{Correlation, CorrelationPanel};
pub use error::Error;
pub use free_run::FreeRun;
pub use gain::{DriftPrediction, Gain};
pub use picture::{Picture, write_svg};
#[cfg(feature = "png")]
pub use png::{to_png, write_png};
pub use ranking::{Omitted, RankedEffect, Ranking, RankingGroup, Role};
pub use residuals::{After, Residuals};
pub use spectrum::{MarkedLine, Spectrum, SpectrumPanel, Threshold};
