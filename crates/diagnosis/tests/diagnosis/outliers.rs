//! Gross errors in rows that the noise audit cannot test.
#![allow(clippy::unwrap_used, missing_docs)]

use gyrocal_diagnosis::result::FindingKind;
use gyrocal_diagnosis::{DiagnoseOptions, Verdict, diagnose};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

fn simulation(hidden: &[Hidden]) -> Simulation {
    simulate(&Scenario {
        seed: 5,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: 2.0 * 86_400.0,
        hidden: hidden.to_vec(),
        ..Scenario::default()
    })
    .unwrap()
}

/// A hundred and ten thousand sigmas: no fit converges with the second.
#[test]
fn an_outlier_is_found_wherever_it_stands() {
    let sound = simulation(&[]);
    for (row, size_g) in [
        (0, 1e-3),
        (8, 1e-3),
        (30, 1e-3),
        (700, 1e-3),
        (8, 0.1),
        (700, 0.1),
        (1440, 0.1),
    ] {
        let mut record = sound.record.clone();
        record.accel_g[row][2] += size_g;
        let found = diagnose(&record, &sound.bench, &DiagnoseOptions::default()).unwrap();
        let case = format!("row {row}, {size_g} g");
        let result = &found.result;
        assert_eq!(result.verdict, Verdict::EffectsFound, "{case}");
        let names: Vec<&str> = result.findings.iter().map(|f| f.effect.as_str()).collect();
        assert_eq!(names, ["accel.outliers"], "{case}");
        assert_eq!(result.findings[0].kind, FindingKind::Noise);
        assert_eq!(result.findings[0].coverage, None);
        let [only] = found.audit.outliers.as_slice() else {
            panic!("{case}: {:?}", found.audit.outliers)
        };
        assert_eq!((only.row, only.axis), (row, 2));
        // A hundredth is noise; an hour after the start the filter is still settling, too.
        assert!((only.size_g / size_g - 1.0).abs() < 0.1, "{case}: {only:?}");
        // It is none of the other things that are said.
        assert!(!result.norm.as_ref().unwrap().accelerometers, "{case}");
        assert!(!result.is_unexplained(), "{case}");
    }
}

/// Fault-free values deviate from the nominal model with a large hidden term, and not from the model
/// that includes it.
#[test]
fn what_a_cause_explains_is_no_outlier() {
    let term = Hidden::new("gyro_x.g_y", &[("size", 0.05)]).unwrap();
    let simulation = simulation(&[term]);
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    );
    let found = found.unwrap();
    assert_eq!(found.result.findings[0].effect, "gyro_x.g_y");
    assert!(
        found.audit.outliers.is_empty(),
        "{:?}",
        found.audit.outliers
    );
}
