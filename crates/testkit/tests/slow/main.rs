//! Builds of copies of the workspace and of small derivations, with cargo and Python as a user has them.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod check;
mod environment;
mod failures;
mod variants;
mod workspace;

/// Where copies and their builds are.
const SCRATCH: &str = env!("CARGO_TARGET_TMPDIR");
