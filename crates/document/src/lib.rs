//! A document as plain data: what people read of an answer, however it is shown.
//!
//! A [`Page`] has a [`Part`] for each answer: a [`Screen`], which a person reads first, and sections of [`Item`]s:
//! [`Words`], [`Chart`]s, [`Bars`] and [`Estimates`]. Terminals, pages and pictures draw them.
//!
//! # What it does not do
//!
//! It makes no sentence and draws nothing.

mod bars;
mod chart;
mod estimates;
mod page;
mod screen;
mod time;
mod words;

pub use bars::{Bar, BarGroup, Bars};
pub use chart::{Band, Chart, Level, Line, LineKind, Mark, Panel, Series, Tint};
pub use estimates::{EstimateRow, Estimates, ValueWithSigma};
pub use page::{Item, Origin, OriginFile, Page, Part, Section};
pub use screen::{Fact, NextStep, Screen, Standing};
pub use time::TimeAxis;
pub use words::{Cell, Column, List, Table, Words};
