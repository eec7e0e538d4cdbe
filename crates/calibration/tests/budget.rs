//! The uncertainty budget against simulated and calibrated runs.
#![allow(clippy::unwrap_used, missing_docs)]

use gyrocal_calibration::{Options, Run, UncertaintySource, calibrate, uncertainty_budget};
use gyrocal_record::SiteUncertainty;
use gyrocal_truth::{Coefficients, Hidden, Scenario, simulate};

/// Declared standard deviations of latitude, Earth rate and gravity.
const SIGMAS: [f64; 3] = [0.01, 3e-4, 1e-5];

/// Standard normal numbers by the angles of a sequence without repetition, three for a run.
fn draws(run: u64) -> [f64; 3] {
    let uniform = |at: u64| {
        let mut state = at
            .wrapping_mul(0x9E37_79B9_7F4A_7C15)
            .wrapping_add(0x1234_5678_9ABC_DEF1);
        state = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        state = (state ^ (state >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((state ^ (state >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    };
    core::array::from_fn(|axis| {
        let at = 6 * run + 2 * axis as u64;
        let radius = (-2.0 * (1.0 - uniform(at)).ln()).sqrt();
        radius * (core::f64::consts::TAU * uniform(at + 1)).cos()
    })
}

/// Errors over combined sigmas of the nine coefficients of one run, and whether its interval covers each.
fn run(seed: u64) -> [(f64, bool); 9] {
    let [latitude, rate, gravity] = draws(seed);
    let hidden = [
        ("site.latitude", latitude * SIGMAS[0]),
        ("site.earth_rate", rate * SIGMAS[1]),
        ("site.gravity", gravity * SIGMAS[2]),
    ];
    let scenario = Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        interval_s: 300.0,
        duration_s: 86_400.0,
        hidden: hidden
            .map(|(id, size)| Hidden::new(id, &[("size", size)]).unwrap())
            .to_vec(),
        ..Scenario::default()
    };
    let simulation = simulate(&scenario).unwrap();
    let mut bench = simulation.bench.clone();
    bench.uncertainty = SiteUncertainty {
        latitude_sigma_deg: Some(SIGMAS[0]),
        earth_rate_relative_sigma: Some(SIGMAS[1]),
        gravity_relative_sigma: Some(SIGMAS[2]),
    };
    let runs = [Run {
        record: &simulation.record,
        bench: &bench,
    }];
    let options = Options::default();
    let calibration = calibrate(&simulation.record, &bench, &options, |_| ()).unwrap();
    let budget = uncertainty_budget(&runs, &calibration, &options, None).unwrap();
    let truth = simulation.truth.coefficients.named();
    core::array::from_fn(|index| {
        let one = &budget.coefficients[index];
        let sigma = calibration.covariance[index][index].sqrt();
        let remainder = one.contributions.last().unwrap();
        assert_eq!(remainder.source, UncertaintySource::Remainder);
        // Without a remainder the contributions are the covariance, to rounding of the differences.
        let expected = sigma.hypot(remainder.standard);
        assert!((one.combined / expected - 1.0).abs() < 1e-6, "{}", one.id);
        let error = one.estimate - truth[index].1;
        (error / one.combined, error.abs() <= one.expanded())
    })
}

#[test]
fn combined_sigmas_are_the_scatter_of_runs_that_draw_noise_site_and_bench() {
    const RUNS: u64 = 200;
    let all: Vec<[(f64, bool); 9]> = (1..=RUNS).map(run).collect();
    let mut covered = 0;
    for index in 0..9 {
        let square = all.iter().map(|run| run[index].0.powi(2)).sum::<f64>() / RUNS as f64;
        // 99.9 % band of chi-square of 200 over 200, for nine coefficients: 0.64 to 1.45.
        assert!(
            (0.64..1.45).contains(&square),
            "coefficient {index}: {square}"
        );
        covered += all.iter().filter(|run| run[index].1).count();
    }
    let coverage = covered as f64 / (9 * RUNS) as f64;
    println!("coverage of 95 % intervals: {coverage:.4}");
    // The nine are correlated: the standard deviation is at most 1.5 %, that of one coefficient.
    assert!((0.92..0.98).contains(&coverage), "{coverage}");
}
