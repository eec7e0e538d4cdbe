//! The uncertainty budget against calibrations with changed inputs.

use gyrocal_calibration::{
    Calibration, ModelEstimate, Options, Run, UncertaintyBudget, UncertaintySource, calibrate,
    calibrate_with_budget, spread,
};
use gyrocal_record::{Bench, SiteUncertainty};
use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, simulate};

/// Declared standard deviations of latitude, Earth rate and gravity.
const SIGMAS: [f64; 3] = [0.01, 3e-4, 1e-5];

/// A record of half a day, which leaves much to the prior and to the first attitude.
fn simulation(seed: u64) -> Simulation {
    let mut simulation = simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial_angles_sigma_deg: [0.02, 0.05, 0.03],
        interval_s: 300.0,
        duration_s: 43_200.0,
        ..Scenario::default()
    })
    .unwrap();
    simulation.bench.uncertainty = SiteUncertainty {
        latitude_sigma_deg: Some(SIGMAS[0]),
        earth_rate_relative_sigma: Some(SIGMAS[1]),
        gravity_relative_sigma: Some(SIGMAS[2]),
    };
    simulation
}

fn budget(simulation: &Simulation) -> (Calibration, UncertaintyBudget) {
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    calibrate_with_budget(&[run], &Options::default()).unwrap()
}

/// Estimates with another bench.
fn estimates(simulation: &Simulation, bench: &Bench) -> [f64; 9] {
    let found = calibrate(&simulation.record, bench, &Options::default(), |_| ()).unwrap();
    found.coefficients().map(|one| one.estimate)
}

#[test]
fn contributions_add_up_to_the_covariance() {
    let (calibration, budget) = budget(&simulation(1));
    for (index, one) in budget.coefficients.iter().enumerate() {
        let sigma = calibration.covariance[index][index].sqrt();
        // Rounding of the differences.
        assert!((one.combined / sigma - 1.0).abs() < 1e-6, "{}", one.id);
        assert!(one.part(|source| source == UncertaintySource::Noise) > 0.0);
        for line in &one.contributions {
            let product = (line.sensitivity * line.quantity_standard).abs();
            assert!((product - line.standard).abs() <= 1e-12 * product);
        }
    }
}

#[test]
fn the_attitude_contributes_what_its_change_does() {
    let simulation = simulation(2);
    let (_, budget) = budget(&simulation);
    let mut squares = [0.0; 9];
    for axis in 0..3 {
        let shifted = |share: f64| {
            let mut bench = simulation.bench.clone();
            let sigma_deg = bench.initial_angles_sigma_deg[axis];
            bench.initial_angles_deg.as_mut().unwrap()[axis] += share * sigma_deg;
            estimates(&simulation, &bench)
        };
        let (high, low) = (shifted(0.5), shifted(-0.5));
        for (index, square) in squares.iter_mut().enumerate() {
            *square += (high[index] - low[index]).powi(2);
        }
    }
    for (one, square) in budget.coefficients.iter().zip(squares) {
        let found = one.part(|source| source == UncertaintySource::Attitude);
        // The last step of a calibration is 1e-4 sigmas of the whole problem long: differences of two
        // are that uncertain. What is larger agrees to the curvature over a sigma.
        let allowed = 0.01 * square.sqrt() + 3e-4 * one.combined;
        assert!(
            (found - square.sqrt()).abs() < allowed,
            "{}: {found}, {}",
            one.id,
            square.sqrt()
        );
    }
}

#[test]
fn the_site_contributes_what_its_change_does() {
    let simulation = simulation(3);
    let (_, budget) = budget(&simulation);
    let shifted = |share: f64| {
        let mut bench = simulation.bench.clone();
        bench.latitude_deg += share * SIGMAS[0];
        estimates(&simulation, &bench)
    };
    let (high, low) = (shifted(0.5), shifted(-0.5));
    for (index, one) in budget.coefficients.iter().enumerate() {
        let change = (high[index] - low[index]).abs();
        let latitude = gyrocal_calibration::SiteQuantity::Latitude;
        let found = one.part(|source| source == UncertaintySource::Site(latitude));
        // As above.
        let allowed = 0.01 * change + 3e-4 * one.combined;
        assert!(
            (found - change).abs() < allowed,
            "{}: {found}, {change}",
            one.id
        );
    }
}

#[test]
fn errors_of_the_site_within_their_uncertainty_are_no_remainder() {
    let remainder = |declared: bool| {
        let mut simulation = simulate(&Scenario {
            seed: 4,
            coefficients: Coefficients::PAPER_LIKE,
            interval_s: 300.0,
            hidden: vec![Hidden::new("site.earth_rate", &[("size", 2e-3)]).unwrap()],
            ..Scenario::default()
        })
        .unwrap();
        simulation.bench.uncertainty.earth_rate_relative_sigma = declared.then_some(1e-3);
        let (_, budget) = budget(&simulation);
        budget.coefficients[2].part(|source| source == UncertaintySource::Remainder)
    };
    // The same record: its innovations exceed the noise, which the declared uncertainty explains.
    assert!(remainder(false) > 0.0);
    assert_eq!(remainder(true), 0.0);
}

#[test]
fn open_models_add_the_scatter_of_their_estimates() {
    let (_, budget) = budget(&simulation(5));
    let model = |weight, shift: f64| ModelEstimate {
        weight,
        coefficients: budget
            .coefficients
            .iter()
            .map(|one| [one.estimate + shift, 2.0 * one.combined])
            .collect(),
    };
    let over = budget
        .clone()
        .over_models(&[model(3.0, 0.0), model(1.0, 0.4)]);
    for (before, after) in budget.coefficients.iter().zip(&over.coefficients) {
        // Mean 0.25 of the shift; its standard deviation √(0.25 × 0.75). Rounding of a few operations.
        assert!((after.estimate - before.estimate - 0.1).abs() < 1e-12);
        let of_choice = after.part(|source| source == UncertaintySource::Model);
        assert!((of_choice - 0.4 * 0.1875_f64.sqrt()).abs() < 1e-12);
        let expected = (2.0 * before.combined).hypot(of_choice);
        assert!((after.combined / expected - 1.0).abs() < 1e-12);
    }
}

#[test]
fn runs_of_one_platform_are_consistent_and_those_of_two_are_not() {
    let of = |seed, bias: f64| {
        let mut coefficients = Coefficients::PAPER_LIKE;
        coefficients.bias_deg_per_h[1] += bias;
        let simulated = simulate(&Scenario {
            seed,
            coefficients,
            interval_s: 300.0,
            duration_s: 86_400.0,
            ..Scenario::default()
        })
        .unwrap();
        budget(&simulated).1
    };
    let one: Vec<UncertaintyBudget> = (1..=4).map(|seed| of(seed, 0.0)).collect();
    let stable = spread(&one).unwrap();
    assert_eq!(stable.runs, 4);
    assert!(stable.coefficients.iter().all(|one| !one.is_larger));
    let two: Vec<UncertaintyBudget> = (1..=4)
        .map(|seed| of(seed, 0.5 * (seed % 2) as f64))
        .collect();
    let found = spread(&two).unwrap();
    let larger: Vec<&str> = found
        .coefficients
        .iter()
        .filter(|one| one.is_larger)
        .map(|one| one.id)
        .collect();
    assert!(larger.contains(&"gyro_y.bias"), "{larger:?}");
    // 0.5 and 0 by turns.
    let scatter = found.coefficients[3].standard_deviation;
    assert!(
        (scatter / (0.5_f64 / 3.0_f64.sqrt()) - 1.0).abs() < 0.2,
        "{scatter}"
    );
    assert!(spread(&one[..1]).is_none());
}
