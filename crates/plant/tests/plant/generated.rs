//! Interpreted functions and generated Rust of one program: the same names and sets, and numbers that
//! differ by rounding only.

use std::path::PathBuf;

use gyrocal_plant::{ColumnMap, SearchOptions, diagnose};
use gyrocal_truth::plant::Kind;

#[path = "../../../../examples/duffing/plant.rs"]
#[rustfmt::skip]
#[expect(
    unreachable_pub,
    dead_code,
    clippy::too_many_lines,
    clippy::wrong_self_convention,
    reason = "generated for every use"
)]
mod duffing;

fn example(file: &str) -> PathBuf {
    crate::example(Kind::Duffing, file)
}

#[test]
fn both_diagnose_the_same() {
    let interpreted = crate::loaded(Kind::Duffing);
    let generated = interpreted.with_model(duffing::Duffing).unwrap();
    let columns = ColumnMap::read(&example("columns.toml")).unwrap();
    let answers = [&interpreted, &generated].map(|plant| {
        let record = columns
            .record(plant.description(), &example("record.csv"))
            .unwrap();
        diagnose(plant, record, None, &SearchOptions::default())
            .unwrap()
            .answer
    });
    let [one, other] = &answers;
    assert!(!one.findings.is_empty());
    assert_eq!(one.findings.len(), other.findings.len());
    for (one, other) in one.findings.iter().zip(&other.findings) {
        assert_eq!(one.effect, other.effect);
        assert!(one.set().eq(other.set()), "{one:?} {other:?}");
        for (one, other) in one.parameters.iter().zip(&other.parameters) {
            let sigma = one.sigma.unwrap();
            assert!(
                (one.estimate - other.estimate).abs() < 1e-6 * sigma,
                "{one:?} {other:?}"
            );
        }
    }
    let [ours, theirs] = [one, other].map(|answer| answer.coefficients.as_ref().unwrap().best());
    for (one, other) in ours.iter().zip(theirs) {
        assert!(
            (one.estimate - other.estimate).abs() < 1e-6 * one.sigma,
            "{one:?} {other:?}"
        );
    }
}
