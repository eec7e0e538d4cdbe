//! Turns symbolic models, written in Python with CasADi, into `no_std` Rust.
//!
//! # What it is
//!
//! The exporter `casadi_program.py` of this crate writes a *program*: a JSON file of named
//! functions, each a flat list of scalar instructions. [`Program::from_json`] reads and checks it,
//! [`ir`] is its typed expression graph, [`simplify`] rewrites the graph by rules that keep every
//! value (except the sign of a zero), and [`emit_module`] returns the text of one Rust file: for
//! each group of inputs a table of elements, a struct and index constants; for each function a Rust
//! function generic over the scalar; for a model the implementation of `Model`. [`build`] keeps
//! committed copies up to date from a build script. `codegen/emit/README.md` is the manual.
//!
//! # Example
//!
//! ```
//! # fn main() -> Result<(), gyrocal_codegen::Error> {
//! use gyrocal_codegen::{Header, Program, emit_module};
//!
//! let text = r#"{"schema_version": 1, "name": "square", "doc": "", "casadi_version": "3.8.2",
//!     "groups": [{"name": "point", "doc": "A point.",
//!                 "elements": [{"name": "x", "id": "", "unit": "m", "doc": "abscissa"}]}],
//!     "functions": [{"name": "area", "doc": "Area.", "source": "", "domain": "",
//!         "inputs": [{"group": "point"}],
//!         "outputs": [{"name": "area", "doc": "area", "unit": "m^2", "rows": 1, "columns": 1,
//!                      "row_names": [], "column_names": [], "nonzeros": [[0, 0]]}],
//!         "work_size": 1,
//!         "instructions": [["input", 0, 0, 0], ["sq", 0, 0], ["output", 0, 0, 0]]}],
//!     "model": null}"#;
//! let program = Program::from_json(text, "square.json")?;
//! let header = Header {
//!     rebuild_command: "cargo run -p gyrocal-codegen".into(),
//!     source: "square.json".into(),
//!     fingerprint: "0123".into(),
//! };
//! let module = emit_module(&program, &header)?;
//! assert!(module.contains("pub fn area<T: Scalar>(point: &[T; 1]) -> [T; 1]"));
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! - `cli`: the command `gyrocal-codegen`, which writes or checks committed files.
//!
//! # What it does not do
//!
//! It has no loops, branches or interpolation tables, and it does not reorder sums and products. It
//! uses fused multiply-add on request only. It is independent of the kind of model.

pub mod build;
mod emit;
mod error;
pub mod ir;
pub mod program;
mod simplify;

pub use emit::{EMISSION_VERSION, Header, Options, emit_module, emit_module_with, explain};
pub use error::Error;
pub use program::{Program, SCHEMA_VERSION};
pub use simplify::simplify;
