//! Every generated function and every entry of every Jacobian against its oracles, at
//! seeded random states: angles to ±80°, drifts to ±5 deg/h, latitudes to ±85°.
//!
//! Errors are relative to the largest entry of the column that an element stands in; a test
//! that fails names the worst element. [`functions`] and [`derivatives`] list what is
//! compared, and fail when a program has something that they do not list. CasADi's numbers
//! are the committed ones: after an edit of the derivation they differ until they are
//! written again with the generated code.
// The written-out RK4 step, the programs and the catalogue are behind features.
#![cfg(all(feature = "oracle", feature = "catalogue"))]
#![cfg(test)]

mod callable;
mod casadi;
mod derivatives;
mod differences;
mod dual_numbers;
mod effects;
mod equations;
mod functions;
mod hand_written;
mod interpreted;
mod layout;
mod model;
mod model_extended;
mod mutation;
mod scalar_types;
mod strapdown;

use gyrocal::generated::{
    CATALOGUE_PROGRAM, ORACLE_PROGRAM, PLATFORM_PROGRAM, STRAPDOWN_CATALOGUE_PROGRAM,
    STRAPDOWN_PROGRAM, SURVEYED_PROGRAM,
};
use gyrocal_oracle::compare::{Comparison, Mismatch};
use gyrocal_oracle::program::{Function, Program};

/// States at which a function is compared with an oracle.
const STATES: usize = 10_000;

/// Groups that each extended program has of its own.
const OWN_GROUPS: [&str; 2] = ["parameters", "shapes"];

/// The programs that the generated modules were made from. Functions, and groups that differ
/// between programs, are called by the name of the program and their own: `platform::dynamics`.
fn programs() -> Vec<Program> {
    let texts = [
        PLATFORM_PROGRAM,
        ORACLE_PROGRAM,
        SURVEYED_PROGRAM,
        STRAPDOWN_PROGRAM,
        CATALOGUE_PROGRAM,
        STRAPDOWN_CATALOGUE_PROGRAM,
    ];
    texts
        .map(|text| qualified(Program::from_json(text).unwrap()))
        .into()
}

/// A function of any of the programs.
fn named<'a>(programs: &'a [Program], name: &str) -> &'a Function {
    let mut found = programs.iter();
    found
        .find_map(|program| program.function(name).ok())
        .unwrap()
}

fn qualified(mut program: Program) -> Program {
    for function in &mut program.functions {
        function.name = format!("{}::{}", program.name, function.name);
        let groups = function.inputs.iter_mut();
        for group in groups.filter(|group| OWN_GROUPS.contains(&group.name.as_str())) {
            group.name = format!("{}::{}", program.name, group.name);
        }
    }
    program
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
