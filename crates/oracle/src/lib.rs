//! Oracles for generated functions: other ways to get the same numbers.
//!
//! | module | says what a generated function should return by |
//! |---|---|
//! | [`interpreter`] | running the instruction list of the [`program`] that it was generated from |
//! | [`dual`] | the chain rule, on the function's own value: exact derivatives |
//! | [`difference`] | sixth-order central differences of the value |
//! | [`reference`](mod@reference) | numbers that CasADi itself computed |
//!
//! [`compare`] measures a result against an oracle and names the worst element,
//! [`rounding`] bounds what rounding alone can do to a result, and [`points`] draws the
//! states to compare at. All vectors are flat: the inputs of a function one group after the
//! other, its outputs as structural nonzeros in the order of the program ([`nonzeros`]).
//!
//! The crate reads programs with types of its own and depends on nothing of the emitter:
//! a mistake there cannot hide itself here. It is not published.

pub mod compare;
pub mod difference;
pub mod dual;
mod error;
pub mod interpreter;
pub mod nonzeros;
pub mod points;
pub mod program;
pub mod reference;
pub mod rounding;

pub use error::OracleError;
