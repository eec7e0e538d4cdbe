//! Means of fast records against the independent simulator.

use gyrocal_calibration::{
    CalibrationError, Consistency, Options, attitude_walk_share, average_record, calibrate,
};
use gyrocal_record::Record;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};

/// One sample a second; attitude and drift as they come.
fn fast(accel_noise_g: f64, gyro_noise_deg_per_h: f64, hours: f64) -> Simulation {
    simulate(&Scenario {
        seed: 5,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::AnglesDeg([20.0, -50.0, 70.0]),
        interval_s: 1.0,
        duration_s: hours * 3600.0,
        start_s: 1e6,
        accel_noise_g,
        gyro_noise_deg_per_h,
        ..Scenario::default()
    })
    .unwrap()
}

/// Noise-free specific force at any time, between the samples of a noise-free record of a second.
fn at(record: &Record, time_s: f64) -> [f64; 3] {
    let place = time_s - record.time_s[0];
    let row = (place.floor() as usize).min(record.len() - 2);
    let share = place - row as f64;
    // Curvature over a second is 1e-9 g.
    core::array::from_fn(|axis| {
        let [a, b] = [0, 1].map(|next| record.accel_g[row + next][axis]);
        a + share * (b - a)
    })
}

fn largest_error(record: &Record, means: &Record) -> f64 {
    let mut largest = 0.0_f64;
    for (time_s, row) in means.time_s.iter().zip(&means.accel_g) {
        for (mean, truth) in row.iter().zip(at(record, *time_s)) {
            // A missing one compares as nothing.
            largest = largest.max((mean - truth).abs());
        }
    }
    largest
}

#[test]
fn a_mean_is_the_value_at_its_time() {
    let record = fast(0.0, 0.0, 6.0).record;
    for interval_s in [10.0, 60.0, 300.0, 600.0] {
        let averaged = average_record(&record, interval_s).unwrap();
        // A row without values, at the first time, keeps the place of the initial attitude.
        assert_eq!(averaged.record.time_s[0], record.time_s[0]);
        assert!(
            averaged.record.accel_g[0]
                .iter()
                .all(|value| value.is_nan())
        );
        let per_mean = interval_s as usize;
        assert_eq!(averaged.values[5], [per_mean; 3]);
        let error = largest_error(&record, &averaged.record);
        // T²/24 a'' is up to w² T²/24 g with w = 7.3e-5 rad/s, 8e-7 g at a minute; left of it is
        // what the polynomial cannot follow, 1e-3 at the ends of its widest window, the fourth
        // derivative, w⁴ T⁴/1920, and w²/8 g of the straight line that the truth is read from.
        let correction = (7.3e-5 * interval_s).powi(2) / 24.0;
        let allowed = 2e-3 * correction + 1e-9;
        assert!(
            error < allowed,
            "{interval_s} s: {error:e} of {correction:e}"
        );
    }
}

#[test]
fn missing_values_do_not_pull_a_mean_and_gaps_stay() {
    let mut record = fast(0.0, 0.0, 6.0).record;
    let whole = record.clone();
    for row in 0..record.len() {
        // The second half of every third minute for z, every fifth value of x.
        if (row / 60) % 3 == 1 && row % 60 >= 31 {
            record.accel_g[row][2] = f64::NAN;
        }
        if row % 5 == 2 {
            record.accel_g[row][0] = f64::NAN;
        }
    }
    // Two minutes and a half, and then another half of a minute.
    let keep = |row: usize| !(6000..6150).contains(&row) && !(9000..9025).contains(&row);
    let kept: Vec<usize> = (0..record.len()).filter(|row| keep(*row)).collect();
    let record = Record {
        time_s: kept.iter().map(|row| record.time_s[*row]).collect(),
        accel_g: kept.iter().map(|row| record.accel_g[*row]).collect(),
        temperature_c: Some(kept.iter().map(|row| *row as f64).collect()),
    };
    let averaged = average_record(&record, 60.0).unwrap();
    let means = &averaged.record;
    // Left to itself a mean of z would be off by up to w · 15 s = 1e-3 g; a thousandth of the
    // slope is left.
    assert!(
        largest_error(&whole, means) < 2e-8,
        "{}",
        largest_error(&whole, means)
    );
    // 361 intervals, the last with one row, less two without any; and the row of the attitude.
    assert_eq!(means.len(), 361 - 2 + 1);
    // Temperature is the mean of its rows: as long as none is missing that is the middle.
    let column = means.temperature_c.as_ref().unwrap();
    assert_eq!((column[0], column[1]), (0.0, 29.5));
    // The last interval has one value of each axis.
    assert_eq!(averaged.left_out, 3);
    assert!(
        means
            .accel_g
            .last()
            .unwrap()
            .iter()
            .all(|value| value.is_nan())
    );
    assert_eq!(averaged.values[1], [48, 60, 60]);
    assert_eq!(averaged.values[2], [48, 60, 31]);
}

#[test]
fn the_noise_of_means_is_the_declared_one_and_the_coefficients_are_those_of_the_samples() {
    let fast = fast(1e-4, 0.002, 30.0);
    let averaged = average_record(&fast.record, 60.0).unwrap();
    assert!((averaged.noise_ratio * 60.0_f64.sqrt() - 1.0).abs() < 1e-12);
    let bench = averaged.bench(&fast.bench);
    // (0.002 deg/h over a minute)² 60 s / 12 over (1e-4 g / √60)²: 1.7e-4.
    let share = attitude_walk_share(&bench, 60.0);
    assert!((1.6e-4..1.8e-4).contains(&share), "{share}");
    let means = calibrate(&averaged.record, &bench, &Options::default(), |_| ()).unwrap();
    assert_eq!(
        means.fit.consistency(),
        Consistency::Consistent,
        "{}",
        means.fit.nis_mean()
    );
    let samples = calibrate(&fast.record, &fast.bench, &Options::default(), |_| ()).unwrap();
    for (one, other) in means.coefficients().iter().zip(samples.coefficients()) {
        // The attitude moves a little within a minute, so means are a little less than samples:
        // 1e-4 was seen of sigma, and estimates to 0.02 sigmas.
        assert!((one.sigma / other.sigma - 1.0).abs() < 1e-2, "{}", one.id);
        let shift = (one.estimate - other.estimate) / other.sigma;
        assert!(shift.abs() < 0.1, "{}: {shift}", one.id);
    }
}

#[test]
fn intervals_that_make_no_sense_are_refused() {
    let record = fast(1e-5, 0.002, 0.2).record;
    for interval_s in [0.0, -60.0, 1.0, 601.0, f64::INFINITY, f64::NAN] {
        match average_record(&record, interval_s) {
            Err(CalibrationError::AveragingInterval {
                least_s, most_s, ..
            }) => {
                assert_eq!((least_s, most_s), (2.0, 600.0));
            }
            other => panic!("{interval_s}: {other:?}"),
        }
    }
}
