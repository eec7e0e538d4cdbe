//! Every generated function and every entry of every Jacobian against its oracles, at
//! seeded random states: angles to ±80°, drifts to ±5 deg/h, latitudes to ±85°.
//!
//! Errors are relative to the largest entry of the column that an element stands in; a test
//! that fails names the worst element. [`functions`] and [`derivatives`] list what is
//! compared, and fail when a program has something that they do not list. CasADi's numbers
//! are the committed ones: after an edit of the derivation they differ until they are
//! written again with the generated code.
// The written-out RK4 step and the programs are behind this feature.
#![cfg(feature = "oracle")]
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod callable;
mod casadi;
mod derivatives;
mod differences;
mod dual_numbers;
mod equations;
mod functions;
mod hand_written;
mod interpreted;
mod layout;
mod model;
mod mutation;
mod scalar_types;

use gyrocal::generated::{ORACLE_PROGRAM, PLATFORM_PROGRAM};
use gyrocal_oracle::compare::{Comparison, Mismatch};
use gyrocal_oracle::program::Program;

/// States at which a function is compared with an oracle.
const STATES: usize = 10_000;

/// The programs that the generated modules were made from.
fn programs() -> Vec<Program> {
    [PLATFORM_PROGRAM, ORACLE_PROGRAM]
        .map(|text| Program::from_json(text).unwrap())
        .into()
}

/// Ends all comparisons, and fails with a line for each that does not hold.
fn hold<'a>(comparisons: impl IntoIterator<Item = Comparison<'a>>) {
    let failures: Vec<String> = comparisons
        .into_iter()
        .filter_map(|comparison| comparison.finish().err())
        .map(|mismatch: Mismatch| mismatch.to_string())
        .collect();
    assert!(
        failures.is_empty(),
        "{} outputs differ:\n{}",
        failures.len(),
        failures.join("\n")
    );
}
