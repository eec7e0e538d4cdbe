//! Planned runs, made: what was predicted of them holds.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use gyrocal_calibration::{NoiseModel, Options, Run, calibrate_runs};
use gyrocal_diagnosis::plan::{Named, PlanOptions, compare, plan};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_record::Prior;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

/// A day and a half of samples each two minutes.
fn scenario(seed: u64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: 1.5 * 86_400.0,
        ..Scenario::default()
    }
}

/// The planned run: another draw of all noise.
fn made(scenario: &Scenario, angles_deg: [f64; 3], duration_s: f64) -> Simulation {
    simulate(&Scenario {
        seed: scenario.seed + 1_000,
        initial: InitialAttitude::AnglesDeg(angles_deg),
        duration_s,
        ..scenario.clone()
    })
    .unwrap()
}

fn run(simulation: &Simulation) -> Run<'_> {
    Run {
        record: &simulation.record,
        bench: &simulation.bench,
    }
}

#[test]
fn sigmas_after_the_planned_run_are_as_predicted() {
    for (seed, turn_on) in [(21, 0.0), (22, 0.02)] {
        let scenario = Scenario {
            prior: Prior {
                turn_on_sigma_deg_per_h: [turn_on; 3],
                ..Prior::default()
            },
            ..scenario(seed)
        };
        let first = simulate(&scenario).unwrap();
        let noise = NoiseModel::default();
        let fitted = Named::fitted(&[], &run(&first), &noise, &Options::default()).unwrap();
        let t = std::time::Instant::now();
        let planned = plan(&fitted, &run(&first), &noise, &[], &PlanOptions::default()).unwrap();
        eprintln!("{:?}", t.elapsed());
        let best = &planned.proposals[0];
        for p in planned.proposals.iter().chain(&planned.going_on) {
            eprintln!("{:?} {}", p.angles_deg, p.outlook.sigma_ratio);
        }
        let second = made(&scenario, best.angles_deg.unwrap(), best.duration_s);
        let found =
            calibrate_runs(&[run(&first), run(&second)], &Options::default(), |_| ()).unwrap();
        for (predicted, actual) in best.outlook.coefficients.iter().zip(found.coefficients()) {
            let ratio = actual.sigma / predicted.sigma;
            eprintln!("{} {} {ratio}", actual.id, predicted.sigma);
            assert!((0.8..1.2).contains(&ratio), "{} {ratio}", actual.id);
        }
    }
}

#[test]
fn twins() {
    let scenario = Scenario {
        magnetic_field_gauss: Some([0.02, 0.25, -0.4]),
        hidden: vec![
            Hidden::new(
                "gyro_y.g_z",
                &[("size", std::env::var("SIZE").unwrap().parse().unwrap())],
            )
            .unwrap(),
        ],
        ..scenario(std::env::var("SEED").unwrap().parse().unwrap())
    };
    let first = simulate(&scenario).unwrap();
    let options = DiagnoseOptions {
        also: vec!["gyro_y.magnetic".into()],
        ..DiagnoseOptions::default()
    };
    let found = diagnose(&first.record, &first.bench, &options).unwrap();
    let named: Vec<Named> = found.findings.iter().map(Named::of).collect();
    eprintln!("{named:?}");
    let fitted = found.extended.as_ref().unwrap_or(&found.nominal);
    let t = std::time::Instant::now();
    let planned = plan(
        fitted,
        &run(&first),
        &found.noise_model,
        &named,
        &PlanOptions::default(),
    )
    .unwrap();
    eprintln!("{:?}", t.elapsed());
    eprintln!("{:#?}", planned.now.sets);
    for p in planned.proposals.iter().chain(&planned.going_on) {
        eprintln!(
            "{:?} {} {:#?}",
            p.angles_deg, p.outlook.sigma_ratio, p.outlook.sets
        );
    }
    let best = &planned.proposals[0];
    let second = made(&scenario, best.angles_deg.unwrap(), best.duration_s);
    let compared = compare(
        fitted,
        &run(&first),
        &run(&second),
        &found.noise_model,
        &named,
        &Options::default(),
    )
    .unwrap();
    eprintln!("{:#?}", compared.sets);
}
