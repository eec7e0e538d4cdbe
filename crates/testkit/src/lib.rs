//! Support for the tests of the build: copies of the workspace, small derivations, cargo
//! and Python as a user would have them.
//!
//! Nothing here is part of the library. Helpers panic when the machine lacks something:
//! that is how a test fails.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::missing_panics_doc,
    clippy::must_use_candidate
)]

mod command;
mod copy;
mod files;
mod tiny;

pub use command::{Outcome, cargo, codegen, real_environments, run, system_python, tools_only};
pub use copy::{WorkspaceCopy, workspace};
pub use files::{edit, executable, fresh_directory, snapshot};
pub use tiny::TinyDerivation;
