//! Records that are hard to diagnose.
#![cfg(test)]

use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_evaluation::{PopulationCell, RecordScore, UnlistedRecord, scenario};
use gyrocal_truth::faults::UnlistedEffect;

fn evaluated(cell: PopulationCell, seed: u64) -> RecordScore {
    cell.evaluate(seed, &[]).unwrap()
}

/// The first samples after a gap in the first hours correct the attitude for the gap: their innovations
/// differ from those of their neighbours by tens of sigmas.
#[test]
fn samples_after_an_early_gap_are_no_outliers() {
    for seed in [248, 943, 1042] {
        let record = evaluated(PopulationCell::Clean, seed);
        assert_eq!(record.verdict, "clean", "{seed}: {:?}", record.noise);
    }
}

/// What a diagnosis says of a record of the population with an effect of the simulator of a strength:
/// the description of what is unexplained, and the names of causes.
fn of_unlisted(
    number: u64,
    id: &str,
    further: Vec<(&'static str, f64)>,
    strength: f64,
) -> (String, Vec<String>) {
    let effect = UnlistedEffect::named(id.to_owned(), id.starts_with("gyro"), further);
    let record = UnlistedRecord::scaled(&scenario(number), effect, strength);
    let record = record.unwrap().unwrap();
    let (data, bench) = (&record.with.record, &record.with.bench);
    let found = diagnose(data, bench, &DiagnoseOptions::default())
        .unwrap()
        .result;
    let causes = found.causes().map(|cause| cause.effect.clone()).collect();
    (found.remainder.description, causes)
}

/// A tone with a period of seven rows in a record with gaps of hundreds of rows.
#[test]
fn a_tone_is_found_across_gaps() {
    let tone = vec![("period_h", 0.118_347), ("phase_deg", 264.431)];
    let (description, causes) = of_unlisted(7_700_074, "gyro_z.tone", tone, 10.0);
    assert!(
        description.contains("a line in the drift of gyro z"),
        "{description}"
    );
    assert!(causes.is_empty(), "{causes:?}");
}

/// The sign of a force that crosses zero once resembles a bias with an attitude jump, which leave a part of
/// it.
#[test]
fn a_sign_that_switches_has_no_name() {
    let (description, causes) = of_unlisted(7_700_018, "accel_y.sign", Vec::new(), 40.0);
    assert!(
        description.contains("accelerometer y depends"),
        "{description}"
    );
    assert!(causes.is_empty(), "{causes:?}");
}

/// A step and a constant term together resemble a random walk.
#[test]
fn two_causes_are_no_random_walk() {
    for seed in [75, 150] {
        let record = evaluated(PopulationCell::Pair, seed);
        let named: Vec<&str> = record.findings.iter().map(|f| f.effect.as_str()).collect();
        assert!(record.each_in_its_set(), "{seed}: {named:?}");
    }
}

/// The statement of docs/characteristics.md on attitude jumps: the probability that the sum of three
/// squares of normal deviates, one of mean `length`, exceeds a threshold; by the midpoint rule over
/// the probability of the other two.
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

/// Terms of a thousand sigmas: values after a gap look like outliers of the nominal model, and without
/// them no fit descends; or the fit ends where steps are so short that rounding hides a decrease of
/// the cost.
#[test]
fn a_record_that_nothing_like_noise_explains_is_diagnosed() {
    for (number, effect) in [(100_800_004, "gyro_x.g_y"), (100_800_205, "gyro_y.g_z")] {
        let scenario = gyrocal_truth::Scenario {
            hidden: vec![gyrocal_truth::Hidden::new(effect, &[("size", 0.05)]).unwrap()],
            ..gyrocal_evaluation::scenario(number)
        };
        let simulation = gyrocal_truth::simulate(&scenario).unwrap();
        let found = gyrocal_diagnosis::diagnose(
            &simulation.record,
            &simulation.bench,
            &gyrocal_diagnosis::DiagnoseOptions::default(),
        )
        .unwrap();
        let names: Vec<&str> = found.result.causes().map(|f| f.effect.as_str()).collect();
        assert_eq!(names, [effect]);
    }
}
