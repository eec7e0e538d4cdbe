//! Rows that come faster than anything moves, as means of blocks.

use gyrocal_calibration::{Calibration, Options, Run, calibrate};
use gyrocal_diagnosis::{
    Blocks, CalibratedRecord, CalibrationRequest, DiagnoseOptions, calibrate_and_diagnose,
    diagnose, manifest,
};
use gyrocal_record::{Bench, CalibrationMethod, Record};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

/// A row in two seconds.
fn scenario(seed: u64, hours: f64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 2.0,
        duration_s: hours * 3600.0,
        ..Scenario::default()
    }
}

fn fast(seed: u64, hours: f64, hidden: Vec<Hidden>) -> Simulation {
    let scenario = Scenario {
        hidden,
        ..scenario(seed, hours)
    };
    simulate(&scenario).unwrap()
}

fn blocks(record: &Record, bench: &Bench) -> Option<Blocks> {
    Blocks::of(&Run { record, bench }, None)
}

fn calibrated(record: &Record, bench: &Bench) -> Calibration {
    calibrate(record, bench, &Options::default(), |_| ()).unwrap()
}

#[test]
fn blocks_lose_less_than_a_thousandth_of_the_information() {
    for seed in [1, 2] {
        let Simulation { record, bench, .. } = fast(seed, 24.0, Vec::new());
        let means = blocks(&record, &bench).unwrap();
        assert!(means.record.len() < record.len() / 8);
        let rows = calibrated(&record, &bench);
        let blocks = calibrated(&means.record, &means.bench);
        let of = |found: &Calibration| found.coefficients().map(|one| (one.estimate, one.sigma));
        for ((by_rows, sigma), (by_blocks, other)) in of(&rows).into_iter().zip(of(&blocks)) {
            // A thousandth of the information is half of that in sigma, and the difference of the estimates then has
            // the root of it, 0.03 sigma: five of these.
            assert!((other / sigma - 1.0).abs() < 1e-3, "{other} {sigma}");
            assert!(
                (by_blocks - by_rows).abs() < 0.15 * sigma,
                "{by_blocks} {by_rows} {sigma}"
            );
        }
    }
}

#[test]
fn a_step_is_found_in_blocks_and_the_answer_tells_of_them() {
    let step = Hidden::new("gyro_y.step", &[("size", 0.02), ("onset_s", 40_000.0)]);
    let Simulation { record, bench, .. } = fast(3, 24.0, vec![step.unwrap()]);
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let result = &found.result;
    assert_eq!(result.record.rows, record.len());
    assert!(
        result
            .record
            .averaged
            .is_some_and(|own| own.means < record.len() / 8)
    );
    assert!(found.record.len() < record.len() / 8);
    let names: Vec<&str> = result.causes().map(|one| one.effect.as_str()).collect();
    assert_eq!(names, ["gyro_y.step"]);
}

/// What a record must not have, and stays as it is.
#[test]
fn rows_that_are_not_white_stay_as_they_are() {
    let Simulation { record, bench, .. } = fast(4, 24.0, Vec::new());
    let noise_g = bench.accel_noise_g;
    let changed = |change: &dyn Fn(usize, &mut [f64; 3])| {
        let mut record = record.clone();
        for (row, value) in record.accel_g.iter_mut().enumerate() {
            change(row, value);
        }
        blocks(&record, &bench)
    };
    assert!(changed(&|_, _| ()).is_some());
    let outlier =
        changed(&|row, value| value[1] += if row == 20_001 { 9.0 * noise_g } else { 0.0 });
    assert!(outlier.is_none(), "outlier");
    let coarse = changed(&|_, value| {
        *value = value.map(|value| (value / noise_g).round() * noise_g);
    });
    assert!(coarse.is_none(), "coarse");
    let tone = changed(&|row, value| value[0] += 0.3 * noise_g * (row as f64).sin());
    assert!(tone.is_none(), "tone");
    let burst = changed(&|row, value| {
        value[0] += if row < 4_000 {
            2.0 * noise_g * (1.7 * (row * row) as f64).sin()
        } else {
            0.0
        };
    });
    assert!(burst.is_none(), "burst");
}

#[test]
fn no_block_reaches_over_a_jump_and_it_is_found_alone() {
    for (seed, row, turn_deg) in [
        (10, 20_003.0, 0.002),
        (11, 13_001.0, 0.006),
        (12, 31_008.0, 0.03),
    ] {
        let parameters = [
            ("x_deg", turn_deg),
            ("y_deg", -turn_deg),
            ("onset_s", 2.0 * row),
        ];
        let knock = Hidden::new("platform.knock", &parameters).unwrap();
        let Simulation { record, bench, .. } = fast(seed, 24.0, vec![knock]);
        let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
        let result = &found.result;
        assert!(result.record.averaged.is_some(), "{seed}");
        let names: Vec<&str> = result
            .findings
            .iter()
            .map(|one| one.effect.as_str())
            .collect();
        assert_eq!(names, ["platform.knock"], "{seed}");
    }
}

#[test]
fn a_drift_that_changes_by_degrees_an_hour_has_no_outliers() {
    // Within the block of its onset the attitude has a kink: its mean is off by 8 standard deviations.
    let parameters = [("size", 2.0), ("onset_s", 37_006.0)];
    let step = Hidden::new("gyro_z.step", &parameters).unwrap();
    let Simulation { record, bench, .. } = fast(13, 24.0, vec![step]);
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let names: Vec<&str> = found
        .result
        .findings
        .iter()
        .map(|one| one.effect.as_str())
        .collect();
    assert_eq!(names, ["gyro_z.step"]);
}

#[test]
fn a_calibration_says_of_fast_rows_what_a_diagnosis_says() {
    // So late that few blocks are behind it: the means alone have outliers and no knock.
    let parameters = [("x_deg", 0.01), ("y_deg", -0.01), ("onset_s", 43_180.0)];
    let knock = Hidden::new("platform.knock", &parameters).unwrap();
    let Simulation { record, bench, .. } = fast(14, 12.0, vec![knock]);
    let run = Run {
        record: &record,
        bench: &bench,
    };
    let means = Blocks::of(&run, None).unwrap();
    let request = CalibrationRequest {
        method: CalibrationMethod::Batch,
        options: Options::default(),
        records: vec![CalibratedRecord {
            name: "record".to_owned(),
            bench_name: "bench".to_owned(),
            run: means.run(),
            diagnosed: run,
            rows: record.len(),
            averaged: Some(means.report),
            setup: &[],
        }],
        axes: &[],
        with_effects: None,
        manifest: manifest(0),
    };
    let report = calibrate_and_diagnose(request, |_| ()).unwrap();
    let calibrated = &report.effects[0];
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let causes: Vec<&str> = found.result.causes().map(|one| &*one.effect).collect();
    assert_eq!(causes, ["platform.knock"]);
    // The answer of the means did not hold.
    assert!(found.result.record.averaged.is_none());
    let named = calibrated.causes.iter().map(|one| &*one.effect);
    assert_eq!(named.collect::<Vec<&str>>(), causes);
    assert!(calibrated.noise.is_empty(), "{:?}", calibrated.noise);
    assert_eq!(report.records[0].duration_s, record.duration_s());
}

#[test]
fn correlated_noise_stays_as_it_is() {
    let Simulation { record, bench, .. } = fast(6, 24.0, Vec::new());
    // Differences of noise of two records: a moving average of two rows.
    let mut smooth = record.clone();
    for row in 1..record.len() {
        for axis in 0..3 {
            let pair = [record.accel_g[row - 1][axis], record.accel_g[row][axis]];
            smooth.accel_g[row][axis] = 0.1 * pair[0] + 0.9 * pair[1];
        }
    }
    assert!(blocks(&smooth, &bench).is_none());
}

#[test]
fn noise_of_gyros_beyond_the_declared_one_shortens_blocks() {
    let noisy = Scenario {
        gyro_noise_deg_per_h: 0.008,
        ..scenario(7, 24.0)
    };
    let Simulation { record, bench, .. } = simulate(&noisy).unwrap();
    let quiet = Bench {
        gyro_noise_deg_per_h: bench.gyro_noise_deg_per_h / 20.0,
        ..bench.clone()
    };
    let length = |bench: &Bench| blocks(&record, bench).unwrap().report.interval_s;
    let declared = length(&bench);
    // Ten rows were it for the declared noise alone.
    assert!(declared < 12.0 && length(&quiet) < 20.0, "{declared}");
}

#[test]
fn gaps_and_missing_values_stay_gaps() {
    let Simulation {
        mut record, bench, ..
    } = fast(8, 24.0, Vec::new());
    record.accel_g[10_000..10_020].fill([f64::NAN; 3]);
    for row in (0..record.len()).step_by(97) {
        record.accel_g[row][0] = f64::NAN;
    }
    let rows = (0..record.len()).filter(|row| !(30_000..31_000).contains(row));
    let with_gap = Record {
        time_s: rows.clone().map(|row| record.time_s[row]).collect(),
        accel_g: rows.map(|row| record.accel_g[row]).collect(),
        temperature_c: None,
    };
    let means = blocks(&with_gap, &bench).unwrap();
    let longest = means.record.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    assert!(longest.fold(0.0, f64::max) > 1_900.0);
    assert!(
        means
            .record
            .accel_g
            .iter()
            .flatten()
            .any(|value| value.is_nan())
    );
}

#[test]
fn slow_and_short_records_stay_as_they_are() {
    let minute = simulate(&Scenario {
        seed: 9,
        ..Scenario::default()
    })
    .unwrap();
    assert!(blocks(&minute.record, &minute.bench).is_none());
    let short = fast(9, 4.0, Vec::new());
    assert!(blocks(&short.record, &short.bench).is_none());
}
