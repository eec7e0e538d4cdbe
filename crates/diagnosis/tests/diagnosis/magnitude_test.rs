//! The specific-force magnitude test: false alarms, and errors of accelerometers.

use gyrocal_diagnosis::magnitude_test;
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::deviates::Normals;

const ROWS: usize = 1440;
const SIGMA_G: f64 = 1e-5;

fn minutes() -> Vec<f64> {
    (0..ROWS).map(|row| 60.0 * row as f64).collect()
}

/// A day in which gravity rotates once in platform axes.
fn record(seed: u64, error_g: impl Fn(usize, [f64; 3]) -> [f64; 3]) -> Record {
    let noise = Normals::of_seed(seed).rows(ROWS);
    let accel_g = noise.iter().enumerate().map(|(row, noise)| {
        let angle = core::f64::consts::TAU * row as f64 / ROWS as f64;
        let force = [0.8 * angle.cos(), 0.8 * angle.sin(), 0.6];
        let error = error_g(row, force);
        core::array::from_fn(|axis| force[axis] + SIGMA_G * noise[axis] + error[axis])
    });
    Record {
        time_s: minutes(),
        accel_g: accel_g.collect(),
        temperature_c: None,
    }
}

fn bench(more: &str) -> Bench {
    let text = format!(
        "[site]\nlatitude_deg = 39.1\n{more}\n[platform]\n[noise]\naccel_g = 1e-5\n\
         gyro_deg_per_h = 0.002\n"
    );
    Bench::parse(&text, "bench").unwrap()
}

#[test]
fn sound_records_are_told_of_no_more_often_than_they_may() {
    const RECORDS: u64 = 400;
    const FALSE_ALARM: f64 = 0.05;
    let bench = bench("");
    let mut alarms = 0;
    for seed in 0..RECORDS {
        let sound = record(seed, |_, _| [0.0; 3]);
        let norm = magnitude_test(&sound, &bench, &[SIGMA_G; 3], FALSE_ALARM).unwrap();
        alarms += u32::from(norm.accelerometers);
    }
    // At most 20 are expected, with a sigma of 4.4: the limit is four sigmas. Tests on the same
    // samples use less than their Bonferroni shares; none at all would be a test without power.
    assert!((2..=38).contains(&alarms), "{alarms}");
}

#[test]
fn errors_of_accelerometers_are_told_by_what_they_go_with() {
    type ErrorG = fn(usize, [f64; 3]) -> [f64; 3];
    // In the magnitude each is 8 sigmas and more: 2 e·a over 2 sigma, times the root of 1440 rows.
    let cases: [(ErrorG, &str); 3] = [
        (|_, a| a.map(|a| 3e-6 * a), "above gravity by"),
        (|_, _| [5e-6, 0.0, 0.0], "specific force along x"),
        (
            |row, _| [0.0, 0.0, 2e-5 * (row as f64 / 720.0 - 1.0)],
            "varies with time",
        ),
    ];
    for (error_g, words) in cases {
        let norm = magnitude_test(&record(1, error_g), &bench(""), &[SIGMA_G; 3], 1e-3).unwrap();
        assert!(norm.accelerometers);
        assert!(norm.description.contains(words), "{}", norm.description);
    }
    // With uncertain gravity its error is not attributed to the accelerometers.
    let scaled = record(1, |_, a| a.map(|a| 3e-6 * a));
    let uncertain = bench("gravity_relative_sigma = 1e-4");
    let norm = magnitude_test(&scaled, &uncertain, &[SIGMA_G; 3], 1e-3).unwrap();
    assert!(!norm.accelerometers, "{norm:?}");
}

/// Where all probabilities underflow, what is largest is still told: a common error as one of the mean, that of
/// one accelerometer by its force.
#[test]
fn large_errors_are_told_by_what_they_go_with() {
    type ErrorG = fn(usize, [f64; 3]) -> [f64; 3];
    let cases: [(ErrorG, &str); 2] = [
        (|_, a| a.map(|a| 3e-4 * a), "above gravity by"),
        (|_, a| [3e-4, 3e-5 * a[1], 0.0], "specific force along x"),
    ];
    for (error_g, words) in cases {
        let record = record(9, error_g);
        let found = magnitude_test(&record, &bench(""), &[SIGMA_G; 3], 1e-3).unwrap();
        assert!(found.accelerometers && found.p_value < 1e-300);
        assert!(found.description.contains(words), "{}", found.description);
    }
}
