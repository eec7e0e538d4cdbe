//! Pages: a whole answer as one HTML file.
//!
//! A [`Page`] is plain data: a summary for the first screen, sections with text, tables, charts, bars
//! and estimates, and the origin of the answer. [`Page::to_html`] makes one file of it that needs no
//! network: styles, scripts and data are inside. Texts are escaped, the data are one JSON block.
//!
//! Charts of long records are decimated: each pixel keeps its extremes ([`Chart`]).

mod chart;
mod columns;
mod decimate;
mod model;
mod render;
mod strips;
mod time;

pub use chart::{Band, Chart, Level, Line, LineKind, Mark, Panel, Series, Tint};
pub use model::{
    Bar, BarGroup, Bars, Card, Cell, Column, EstimateRow, Estimates, Item, List, Origin,
    OriginFile, Page, Part, Section, Summary, Table, Tone, ValueWithSigma,
};
pub use time::TimeAxis;
