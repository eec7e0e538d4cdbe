//! Records of the cells that a diagnosis can easily get wrong, and why.
#![allow(clippy::unwrap_used, missing_docs)]

use gyrocal_characterise::{Case, Cell};

fn examined(cell: Cell, seed: u64) -> Case {
    cell.examine(seed, &[]).unwrap()
}

/// With the first samples after a gap in its first hours the filter makes up for the gap: they stand
/// off their neighbours by tens of sigmas.
#[test]
fn samples_after_an_early_gap_are_no_outliers() {
    for seed in [248, 943, 1042] {
        let case = examined(Cell::Clean, seed);
        assert_eq!(case.verdict, "clean", "{seed}: {:?}", case.noise);
    }
}

/// A tone of seven rows beside gaps of hundreds, over which nothing is left of it.
#[test]
fn a_tone_is_found_across_gaps() {
    let case = examined(Cell::Beyond, 700_074);
    assert_eq!(case.hidden[0].effect, "gyro_z.tone");
    let told = case.unexplained.unwrap_or_default();
    assert!(told.contains("a line in the drift of gyro z"), "{told}");
    assert!(case.findings.is_empty(), "{:?}", case.findings);
}

/// The sign of a force that crosses zero once is nearly a bias with a knock.
#[test]
fn a_sign_that_switches_has_no_name() {
    let case = examined(Cell::Beyond, 700_018);
    assert_eq!(case.hidden[0].effect, "accel_y.sign");
    let told = case.unexplained.unwrap_or_default();
    assert!(told.contains("accelerometer y depends"), "{told}");
    assert!(case.findings.is_empty(), "{:?}", case.findings);
}

/// A step and a constant term together lead where a random walk leads.
#[test]
fn two_causes_are_no_random_walk() {
    for seed in [75, 150] {
        let case = examined(Cell::Pair, seed);
        let named: Vec<&str> = case.findings.iter().map(|f| f.effect.as_str()).collect();
        assert!(case.each_in_its_set(), "{seed}: {named:?}");
    }
}

/// What docs/characteristics.md says of knocks: of the sum of three squares of normal deviates, one
/// of them about `length`, the probability to exceed a threshold; by the midpoint rule over the
/// probability of the other two.
#[test]
fn no_test_finds_four_of_five_knocks_of_five_sigmas() {
    let tail = |z: f64| 0.5 * libm::erfc(z / core::f64::consts::SQRT_2);
    // Chi-square with three degrees of freedom, in closed form.
    let chi_square_tail =
        |x: f64| 2.0 * tail(x.sqrt()) + (2.0 * x / core::f64::consts::PI).sqrt() * (-0.5 * x).exp();
    let power = |threshold: f64, length: f64| {
        const POINTS: u32 = 20_000;
        let exceeds = |point: u32| {
            let share = (f64::from(point) + 0.5) / f64::from(POINTS);
            let others = -2.0 * (1.0 - share).ln();
            let rest = (threshold - others).max(0.0).sqrt();
            if others >= threshold {
                1.0
            } else {
                tail(rest - length) + tail(rest + length)
            }
        };
        (0..POINTS).map(exceeds).sum::<f64>() / f64::from(POINTS)
    };
    // One per cent over a thousand places, to the digits that are printed.
    let threshold = 25.9;
    assert!((chi_square_tail(threshold) * 1000.0 - 0.01).abs() < 2e-4);
    assert!((power(threshold, 5.0) - 0.54).abs() < 0.005);
    assert!((power(threshold, 6.0) - 0.86).abs() < 0.005);
}

/// Terms a thousand sigmas large: values after a gap seem wild beside what the nominal model makes of
/// them, and without them no fit descends; or the search for the best fit ends where steps are so
/// short that rounding hides whether they lower the cost.
#[test]
fn a_record_that_nothing_like_noise_explains_is_diagnosed() {
    for (number, effect) in [(100_800_004, "gyro_x.g_y"), (100_800_205, "gyro_y.g_z")] {
        let scenario = gyrocal_truth::Scenario {
            hidden: vec![gyrocal_truth::Hidden::new(effect, &[("size", 0.05)]).unwrap()],
            ..gyrocal_characterise::scenario(number)
        };
        let simulation = gyrocal_truth::simulate(&scenario).unwrap();
        let found = gyrocal_diagnosis::diagnose(
            &simulation.record,
            &simulation.bench,
            &gyrocal_diagnosis::DiagnoseOptions::default(),
        )
        .unwrap();
        let names: Vec<&str> = found.findings.iter().map(|f| f.effect).collect();
        assert_eq!(names, [effect]);
    }
}
