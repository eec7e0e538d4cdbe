//! Pictures and pages of a calibration and a diagnosis: plain numbers in, SVG, PNG or HTML out.
//!
//! [`to_html`] makes a whole [`Page`](gyrocal_document::Page) one HTML file; the rest is about pictures.
//!
//! Charts, bars and estimates are plain data, documented with units. Each is a [`Picture`] and a piece of a
//! page: what a picture shows is what the page shows. Titles, names of quantities and units come from the caller.
//!
//! | data | shows |
//! |---|---|
//! | [`Chart`](gyrocal_document::Chart) | panels of lines, points and bars over an abscissa, with bands, levels and marks |
//! | [`Bars`](gyrocal_document::Bars) | horizontal bars in groups, with a threshold |
//! | [`Estimates`](gyrocal_document::Estimates) | estimates of several models side by side, with their intervals |
//!
//! # Example
//!
//! ```
//! use gyrocal_report::Picture;
//! use gyrocal_document::{Chart, Line, LineKind, Panel, Tint};
//!
//! let picture = Chart {
//!     title: "Residuals are white".to_owned(),
//!     abscissa: "time".to_owned(),
//!     abscissa_unit: "min".to_owned(),
//!     quantity: "residual".to_owned(),
//!     unit: "g".to_owned(),
//!     columns: 1,
//!     panels: vec![Panel {
//!         name: "x".to_owned(),
//!         abscissa: vec![0.0, 1.0, 2.0],
//!         lines: vec![Line {
//!             label: "innovation".to_owned(),
//!             tint: Tint::Nominal,
//!             kind: LineKind::Solid,
//!             values: vec![1e-5, f64::NAN, -2e-5],
//!         }],
//!         ..Panel::default()
//!     }],
//!     ..Chart::default()
//! };
//! let svg = picture.to_svg()?;
//! assert!(svg.starts_with("<svg") && svg.contains("Residuals are white"));
//! # Ok::<(), gyrocal_report::Error>(())
//! ```
//!
//! # Data
//!
//! Not-a-number is a missing value and leaves a gap; so does an interval of more than four times
//! the median one. Infinite values, columns of unequal length and abscissas that decrease are errors.
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
mod error;
mod estimates;
mod figure;
mod geometry;
mod layout;
mod number;
mod page;
mod panels;
mod picture;
#[cfg(feature = "png")]
mod png;
mod polyline;
mod scale;
mod span;
mod style;
mod svg;
mod text;

pub use error::Error;
pub use page::{to_html, words_to_html};
pub use picture::{Picture, write_svg};
#[cfg(feature = "png")]
pub use png::{to_png, write_png};
