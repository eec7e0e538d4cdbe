//! Independent simulators of the example plants.
//!
//! # What it is
//!
//! Each module simulates one plant of `examples/` from its physics, with effects that the nominal model
//! lacks, and draws scenarios of a population. Nothing here knows a model, its program or its catalogue;
//! the names of effects in the documentation are those that a diagnosis should find.
//!
//! # What it does not do
//!
//! It has no estimator. The simulator of the gyros' platform is `gyrocal-truth`.

pub mod duffing;
mod random;
mod run;

pub use random::Stream;
pub use run::Run;
