//! Pages: a whole answer as one HTML file.
//!
//! [`to_html`] makes one file of a [`Page`](gyrocal_document::Page) that needs no network: styles, scripts and data are
//! inside. Texts are escaped, the data are one JSON block. Charts of long records are decimated: each pixel keeps its
//! extremes.

pub(crate) mod chart;
mod columns;
mod decimate;
mod render;
mod strips;
mod templates;

pub use render::to_html;
pub use templates::words_to_html;
