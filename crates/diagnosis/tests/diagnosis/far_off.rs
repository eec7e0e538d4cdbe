//! What is far off, a number of the bench file or an attitude: scores about the nominal fit say little of any effect.

use gyrocal_answer::Verdict;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, simulate};

#[test]
fn a_latitude_far_off_is_named_and_the_cause_beside_it() {
    for (seed, by_deg) in [(8_311, -2.0), (8_312, 3.0), (8_317, 1.0)] {
        let mut simulation = simulate(&Scenario {
            seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::Random,
            duration_s: 3.0 * 86_400.0,
            hidden: vec![Hidden::new("gyro_y.g_z", &[("size", 0.01)]).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        simulation.bench.latitude_deg += by_deg;
        let options = DiagnoseOptions::default();
        let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap();
        let causes: Vec<_> = found.result.causes().collect();
        let names: Vec<&str> = causes.iter().map(|one| one.effect.as_str()).collect();
        assert_eq!(names, ["site.latitude", "gyro_y.g_z"], "{by_deg} deg");
        let [size] = &causes[0].parameters[..] else {
            panic!("one size");
        };
        // One in sixteen thousand is farther off than four sigmas.
        let error_deg = size.estimate + by_deg;
        assert!(error_deg.abs() < 4.0 * size.sigma.unwrap(), "{size:?}");
    }
}

/// The first fit with the knock is made in the noise that the nominal model tells, a hundred times too large; walks
/// take up what a noise of that fit leaves.
#[test]
fn a_knock_of_half_a_degree_is_named_alone() {
    for (seed, part) in [(8_321, 0.3), (8_322, 0.2)] {
        let knock = [
            ("x_deg", 2.0 * part),
            ("y_deg", 1.2 * part),
            ("z_deg", 0.75 * part),
            ("onset_s", 61_830.0),
        ];
        let simulation = simulate(&Scenario {
            seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::AnglesDeg([12.0, -25.0, 40.0]),
            duration_s: 1.5 * 86_400.0,
            hidden: vec![Hidden::new("platform.knock", &knock).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        let options = DiagnoseOptions::default();
        let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap();
        let names: Vec<&str> = found
            .result
            .findings
            .iter()
            .map(|one| one.effect.as_str())
            .collect();
        assert_eq!(names, ["platform.knock"], "seed {seed}");
        let verdict = found.result.verdict;
        assert_eq!(verdict, Verdict::EffectsFound, "seed {seed}");
    }
}
