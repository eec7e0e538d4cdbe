//! Builds of copies of the workspace and of small derivations, with cargo and Python as a user has them.
#![cfg(test)]

mod check;
mod environment;
mod failures;
mod no_python;
mod own_terms;
mod tiny;
mod variants;
mod workspace;

/// Where copies and their builds are.
const SCRATCH: &str = env!("CARGO_TARGET_TMPDIR");
