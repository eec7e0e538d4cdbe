//! Effects of temperature hidden in simulated records of three days.

use gyrocal_answer::Answer;
use gyrocal_calibration::Run;
use gyrocal_diagnosis::{DiagnoseOptions, diagnose, fit_effects};
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Temperature, simulate};

/// Noise of the logged temperature, K.
const NOISE_K: f64 = 0.02;

/// A daily wave and a wander as temperature, logged with noise.
fn record(seed: u64, effect: &str, size: f64) -> (Record, Bench) {
    let mut simulation = simulate(&Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 3.0 * 86_400.0,
        interval_s: 120.0,
        temperature: Some(Temperature::default()),
        hidden: vec![Hidden::new(effect, &[("size", size)]).unwrap()],
        ..Scenario::default()
    })
    .unwrap();
    let mut draw = Draw::new(seed, 0);
    for value in simulation.record.temperature_c.iter_mut().flatten() {
        *value += NOISE_K * draw.normal();
    }
    (simulation.record, simulation.bench)
}

/// The effects of the set of each finding.
fn sets(result: &Answer) -> Vec<Vec<&str>> {
    let of_one = result.causes().map(|finding| {
        let others = finding.alternatives.iter();
        let others = others.map(|alternative| alternative.effect.as_str());
        core::iter::once(finding.effect.as_str())
            .chain(others)
            .collect()
    });
    of_one.collect()
}

/// Hides an effect; it must be in the set of the one finding, and with it in the model its size as hidden.
fn found(seed: u64, effect: &str, size: f64) {
    let (record, bench) = record(seed, effect, size);
    let options = DiagnoseOptions::default();
    let result = diagnose(&record, &bench, &options).unwrap().result;
    let sets = sets(&result);
    assert_eq!(sets.len(), 1, "{effect}: {sets:?}");
    assert!(sets[0].contains(&effect), "{effect}: {sets:?}");
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let fitted = fit_effects(&run, None, &[effect.to_owned()], &options).unwrap();
    let parameter = &fitted.effects[0].parameters[0];
    println!("{effect}: {sets:?} {parameter:?}");
    // One in sixteen thousand is farther off than four sigmas; noise of the temperature and the
    // straight line of the rate take some hundredths of an effect.
    let allowed = 4.0 * parameter.sigma.unwrap() + 0.03 * size;
    assert!(
        (parameter.estimate - size).abs() < allowed,
        "{effect}: {parameter:?}"
    );
}

#[test]
fn the_square_of_temperature_is_found() {
    found(1, "gyro_x.temperature_square", 0.002);
    found(2, "accel_y.temperature_square", 5e-6);
}

#[test]
fn the_rate_of_temperature_is_found() {
    found(3, "gyro_y.temperature_rate", 0.01);
    found(4, "accel_z.temperature_rate", 3e-5);
}

#[test]
fn the_hysteresis_of_temperature_is_found() {
    found(5, "gyro_z.temperature_hysteresis", 0.01);
    found(6, "accel_x.temperature_hysteresis", 2e-5);
}

#[test]
fn noise_of_the_temperature_leaves_nothing_beside_a_large_hysteresis() {
    found(8, "gyro_z.temperature_hysteresis", 0.04);
    found(9, "gyro_x.temperature_hysteresis", 0.08);
}

#[test]
fn where_temperature_went_with_time_the_set_holds_both_and_says_so() {
    let (mut record, bench) = record(7, "gyro_x.ramp", 0.01);
    let mut draw = Draw::new(7, 1);
    let days = record.time_s.iter().map(|time_s| time_s / 86_400.0);
    let rising = days.map(|days| 20.0 + 2.0 * days + NOISE_K * draw.normal());
    record.temperature_c = Some(rising.collect());
    let result = diagnose(&record, &bench, &DiagnoseOptions::default())
        .unwrap()
        .result;
    let sets = sets(&result);
    assert_eq!(sets.len(), 1, "{sets:?}");
    for id in ["gyro_x.ramp", "gyro_x.temperature"] {
        assert!(sets[0].contains(&id), "{sets:?}");
    }
    let findings = result.findings.iter();
    let mut groups = findings.flat_map(|finding| &finding.separations);
    assert!(
        groups.any(|group| group.why.contains("time and temperature go together")),
        "{:?}",
        result.findings
    );
}
