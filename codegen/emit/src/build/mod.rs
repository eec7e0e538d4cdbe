//! Freshness of committed files, the private Python environment, and the running of a
//! derivation.
//!
//! A *derivation* is a directory with a Python script `main.py`, whose function
//! `derive(output)` writes programs, and a declaration `derivation.toml`:
//!
//! ```toml
//! source = "derive"                     # how headers and messages call this directory
//! write_command = "cargo codegen write" # what rewrites the committed files
//!
//! [python]
//! minimum = "3.11"                      # oldest Python that will do
//! newest = "3.14"                       # newest for which the lock file holds wheels
//! requirements = "requirements.lock"    # pip-compile --generate-hashes, with casadi==
//!
//! [[module]]
//! program = "pendulum"                  # derive() writes pendulum.json
//! rust = "../src/generated/pendulum.rs"
//! json = "../src/generated/pendulum.json"
//!
//! [[numbers]]                           # optional: written with a changed model,
//! file = "reference.json"               # never compared
//! committed = "../tests/reference.json"
//! ```
//!
//! Committed Rust files carry a fingerprint of their inputs (all `*.py` of the directory,
//! the declaration, the lock file, the exporter and the emitter; line endings do not
//! count) and a hash of their own text. A build script asks whether both hold:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     gyrocal_codegen::build::main("derive")
//! }
//! ```
//!
//! If they do, nothing is derived and no Python is needed. If not, the model is derived
//! into `OUT_DIR`, cargo warns that the committed copy is stale, and the library takes
//! the new one:
//!
//! ```ignore
//! gyrocal_scalar::generated!(pub mod pendulum);
//! ```
//!
//! [`Derivation::build`] does the same for build scripts that do more.
//!
//! # Variants
//!
//! A package that depends on one with a derivation may ask for a program of its own: a
//! [`Variant`], of a file that it holds.
//!
//! ```no_run
//! use gyrocal_codegen::build::{Error, Outcome, Variant};
//!
//! fn run() -> Result<Outcome, Error> {
//!     let out_dir = std::env::var_os("OUT_DIR").unwrap_or_default();
//!     Variant::of_dependency("the-links-key", "extended.model.toml")?
//!         .committed("src/generated")
//!         .build(out_dir)
//! }
//!
//! fn main() {
//!     match run() {
//!         Ok(outcome) => print!("{}", outcome.cargo_lines()),
//!         Err(error) => {
//!             eprintln!("{error}");
//!             std::process::exit(1);
//!         }
//!     }
//! }
//! ```
//!
//! The module is then in `OUT_DIR`, derived or copied:
//!
//! ```ignore
//! pub mod extended { include!(concat!(env!("OUT_DIR"), "/extended.rs")); }
//! ```
//!
//! # Environment
//!
//! CasADi runs in a virtual environment of its own, made once for a lock file and a
//! Python version below `gyrocal-codegen` in the target directory: wheels only, each with
//! a hash of the lock file. Processes that need it at the same time wait for each other,
//! and one that was left half-made is made again. Variables:
//!
//! | variable | meaning |
//! |---|---|
//! | `GYROCAL_PYTHON` | interpreter to use; otherwise the newest of `PATH`. One that has the pinned CasADi is used as it is, without an environment |
//! | `GYROCAL_OFFLINE`, `CARGO_NET_OFFLINE` | `1` or `true`: never use the network. (Cargo does not pass `--offline` on to build scripts) |
//! | `GYROCAL_CODEGEN_WRITE` | `1` or `true`: a build writes stale committed copies of variants anew |
//! | `GYROCAL_CODEGEN_ENV_DIR` | directory of the environments, for example one that continuous integration caches |
//!
//! `PYTHON*` and `PIP_*` variables of the caller are not passed on: they could change what
//! is installed and where. Those that say how files travel are (`PIP_INDEX_URL`,
//! `PIP_EXTRA_INDEX_URL`, `PIP_FIND_LINKS`, `PIP_NO_INDEX`, `PIP_CERT`, `PIP_CLIENT_CERT`,
//! `PIP_PROXY`, `PIP_TRUSTED_HOST`, `PIP_DEFAULT_TIMEOUT`, `PIP_RETRIES`, `PIP_CACHE_DIR`,
//! `PIP_NO_CACHE_DIR`, `PIP_CONFIG_FILE`): the hashes decide what is installed.
//!
//! # Limits
//!
//! A derivation may read files of its own that are not Python, but their contents are not
//! part of the fingerprint. An edit that keeps an old file time does not make cargo run a
//! build script: let a test ask [`Derivation::stale`].

mod committed;
mod declaration;
mod derivation;
mod environment;
mod error;
mod fingerprint;
mod outcome;
mod process;
mod python;
mod run;
mod settings;
mod sources;
mod variant;

use std::path::Path;
use std::process::ExitCode;

pub use committed::{Reason, Stale};
pub use declaration::DECLARATION_FILE;
pub use derivation::{Derivation, Written};
pub use error::Error;
pub use outcome::Outcome;
pub use run::{Derived, DerivedModule, Timings};
pub use settings::{
    CARGO_OFFLINE_VARIABLE, ENVIRONMENTS_VARIABLE, OFFLINE_VARIABLE, PYTHON_VARIABLE, Settings,
    WRITE_VARIABLE, target_directory,
};
pub use variant::Variant;

/// The whole `main` of a build script: derives what is stale in a directory, tells cargo, and sets the
/// condition `rederived` for `gyrocal_scalar::generated!`. An error is printed, and the code is 1.
pub fn main(derivation: impl AsRef<Path>) -> ExitCode {
    let out_dir = std::env::var_os("OUT_DIR").unwrap_or_default();
    let outcome = Derivation::open(derivation).and_then(|derivation| derivation.build(out_dir));
    match outcome {
        Ok(outcome) => {
            print!("{}", outcome.cargo_instructions("rederived"));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
