//! Pictures and pages of a calibration and a diagnosis: plain numbers in, SVG, PNG or HTML out.
//!
//! [`page`] makes a whole answer one HTML file; the rest is about pictures.
//!
//! Each picture is a structure of numbers and labels, documented with units, that implements
//! [`Picture`]. Titles, names of channels and quantities, and units come from the caller; the
//! picture adds the legend, confidence bands and the number of values.
//!
//! | picture | shows |
//! |---|---|
//! | [`Convergence`] | estimates against time with their bands |
//! | [`Residuals`] | residuals of one or two models with the noise band |
//! | [`OpenLoop`] | measurement and open-loop simulation, and their difference |
//! | [`Spectrum`] | periodograms with detection threshold and marked frequencies |
//! | [`Correlation`] | autocorrelations with the band of white noise |
//! | [`ResidualVsCovariate`] | binned means of residuals against covariates |
//! | [`Ranking`] | effects by test statistic, with detection threshold |
//! | [`CrossValidation`] | gain of an extended model on held-out data and on a later record |
//! | [`TermContributions`] | partial residuals of single terms of a law |
//! | [`Comparison`] | estimates of several estimators with error bars |
//! | [`page::Chart`], [`page::Bars`], [`page::Estimates`] | the same as on a page |
//!
//! # Example
//!
//! ```
//! use gyrocal_report::{Picture, ResidualChannel, Residuals};
//!
//! let picture = Residuals {
//!     title: "Residuals are white".to_owned(),
//!     subtitle: String::new(),
//!     time_s: vec![0.0, 60.0, 120.0],
//!     channels: vec![ResidualChannel {
//!         name: "x".to_owned(),
//!         before: vec![1e-5, f64::NAN, -2e-5],
//!         after: None,
//!         sigma: 1e-5,
//!     }],
//!     before_label: "innovation".to_owned(),
//!     after_label: String::new(),
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
//! the median one. Infinite values, columns of unequal length and times that decrease are errors.
//! A panel without any value says "no data". Long columns are decimated to at most four points for
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
//! It estimates and tests nothing: thresholds, detected effects and noise levels come from the
//! caller. It knows no model, record or diagnosis.

mod axes;
mod axis;
mod bars;
mod canvas;
mod check;
mod comparison;
mod convergence;
mod correlation;
mod cross_validation;
mod error;
mod figure;
mod geometry;
mod layout;
mod number;
mod open_loop;
pub mod page;
mod panels;
mod picture;
#[cfg(feature = "png")]
mod png;
mod polyline;
mod ranking;
mod residual_vs_covariate;
mod residuals;
mod scale;
mod scatter;
mod span;
mod spectrum;
mod style;
mod svg;
mod term_contributions;
mod text;

pub use comparison::{ComparedEstimate, ComparedQuantity, Comparison};
pub use convergence::{Convergence, EstimateHistory, ParameterHistory};
pub use correlation::{Correlation, CorrelationChannel};
pub use cross_validation::{CrossValidation, PredictionError};
pub use error::Error;
pub use open_loop::{OpenLoop, OpenLoopChannel};
pub use picture::{Picture, write_svg};
#[cfg(feature = "png")]
pub use png::{to_png, write_png};
pub use ranking::{Omitted, RankedEffect, Ranking, RankingGroup, Role};
pub use residual_vs_covariate::{Bin, CovariatePanel, ResidualVsCovariate};
pub use residuals::{ResidualChannel, Residuals};
pub use spectrum::{MarkedFrequency, PowerThreshold, Spectrum, SpectrumChannel};
pub use term_contributions::{TermContribution, TermContributions};
