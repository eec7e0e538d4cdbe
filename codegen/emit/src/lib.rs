//! Turns CasADi programs into `no_std` Rust.
//!
//! A *program* is a JSON file of named functions that the exporter `casadi_program.py`
//! (beside this crate's sources) wrote. [`Program::from_json`] reads and checks it,
//! [`emit_module`] gives the text of one Rust file: for each group of inputs a table of
//! elements, a struct and index constants, for each function a Rust function generic over
//! the scalar, and for a model the implementation of `Model`.
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
//! In between stands the typed expression graph of [`ir`], which [`simplify`] rewrites by
//! rules that keep every value (the sign of a zero aside).

pub mod build;
mod emit;
mod error;
pub mod ir;
pub mod program;
mod simplify;

pub use emit::{EMISSION_VERSION, Header, Options, emit_module, emit_module_with};
pub use error::Error;
pub use program::{Program, SCHEMA_VERSION};
pub use simplify::simplify;
