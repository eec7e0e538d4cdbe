//! Emitted modules, compiled with cargo and run.
#![cfg(test)]

#[path = "../common/mod.rs"]
mod common;
mod compiled;
mod evaluated;
mod operations;
