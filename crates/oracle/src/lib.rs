//! Test oracles of generated functions: independent computations of the same numbers.
//!
//! # What it is
//!
//! | module | expected value by |
//! |---|---|
//! | [`interpreter`] | execution of the instruction list of the [`program`] from which the function was generated |
//! | [`dual`] | dual numbers: exact derivatives of the function's value by the chain rule |
//! | [`difference`] | sixth-order central differences of the value |
//! | [`reference`](mod@reference) | numbers computed by CasADi |
//!
//! [`compare`] measures the error of a result and names the worst element, [`rounding`] bounds the
//! rounding error of a result, and [`points`] draws the states of a comparison. All vectors are
//! flat: the inputs of a function one group after the other, its outputs as structural nonzeros in
//! the order of the program ([`nonzeros`]).
//!
//! # Example
//!
//! ```
//! use gyrocal_oracle::program::Program;
//!
//! // y = sin(a) of one input.
//! let program = Program::from_json(
//!     r#"{"schema_version": 1, "name": "wave", "groups": [
//!            {"name": "angle", "elements": [{"name": "a"}]}],
//!         "functions": [{"name": "sine", "inputs": [{"group": "angle"}],
//!            "outputs": [{"name": "y", "rows": 1, "columns": 1, "row_names": ["y"],
//!                         "column_names": [], "nonzeros": [[0, 0]]}],
//!            "work_size": 2,
//!            "instructions": [["input", 0, 0, 0], ["sin", 1, 0], ["output", 0, 0, 1]]}]}"#,
//! )?;
//! let value = program.function("sine")?.evaluate(&[0.5])?;
//! assert_eq!(value, [0.5_f64.sin()]);
//! # Ok::<(), gyrocal_oracle::OracleError>(())
//! ```
//!
//! # What it does not do
//!
//! It shares no code with the emitter and reads programs with types of its own, so that an error
//! of the emitter cannot hide itself here. It is not published.

pub mod compare;
pub mod difference;
pub mod dual;
mod error;
mod error_function;
pub mod interpreter;
pub mod nonzeros;
pub mod points;
pub mod program;
pub mod reference;
pub mod rounding;

pub use error::OracleError;
