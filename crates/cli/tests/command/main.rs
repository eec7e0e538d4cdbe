//! The command `gyrocal` as a user runs it.

#![allow(clippy::unwrap_used, clippy::expect_used)]

mod bad_input;
mod calibrate;
mod extend;
mod folder;
mod monte_carlo;
mod simulate;
