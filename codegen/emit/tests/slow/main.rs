//! Emitted modules, compiled with cargo and run.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod compiled;
mod evaluated;
mod operations;
