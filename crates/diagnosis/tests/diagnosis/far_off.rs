//! A number of the bench file that is far off: scores about the nominal fit say little of any effect.

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
