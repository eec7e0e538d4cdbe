//! Derives the program of a plant from its Python file, in builds and commands.
//!
//! # What it is
//!
//! A user's plant is one Python file that declares it with the package `gyrocal_plant` and ends with
//! `plant.write()` (`docs/any-plant.md`). [`derive()`] runs such a file with the pinned CasADi, in the private
//! environment of `gyrocal-codegen`, and returns the program and its Rust. [`build`] does it for the build
//! script of a package, and [`Package`] has the files of such a package. The Python package is embedded: nothing of it
//! has to be installed.
//!
//! # Example
//!
//! The build script of a package with a file `plant.py`:
//!
//! ```no_run
//! fn main() -> std::process::ExitCode {
//!     gyrocal_plant_codegen::build("plant.py")
//! }
//! ```
//!
//! # What it does not do
//!
//! It fits nothing and knows no catalogue: `gyrocal-plant` does.

mod build;
mod derive;
mod error;
mod package;

pub use build::build;
pub use derive::{DerivedPlant, derive, settings_of_a_command};
pub use error::Error;
pub use package::{Package, PackageFile, Source};
