//! A document as plain data: what people read of an answer, however it is shown.
//!
//! A [`Screen`] is what a person reads first; [`Words`] are the pieces of all that follows. Terminals, pages and other
//! languages draw them.
//!
//! # What it does not do
//!
//! It makes no sentence and draws nothing.

mod screen;
mod words;

pub use screen::{Fact, NextStep, Screen, Standing};
pub use words::{Cell, Column, Entry, List, Table, Words};
