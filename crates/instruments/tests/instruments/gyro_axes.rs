//! Errors of a strapdown unit's gyros, found from the platform computed from their outputs, against
//! simulation with known errors.

use crate::common::{EARTH_RATE_RAD_PER_S, Noise, log};
use gyrocal_calibration::{
    Calibration, GyroAxes, Options, Run, calibrate_runs, calibrate_strapdown,
};
use gyrocal_instruments::Description;
use gyrocal_instruments::strapdown::{ImportSettings, Imported, axes_csv, import, read_axes};
use gyrocal_record::SourceText;
use nalgebra::{UnitQuaternion, Vector3};

const LATITUDE_DEG: f64 = 39.1;
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
/// Gyro by gyro: bias, along-axis g, along-axis g².
const ERRORS: [f64; 9] = [0.20, -0.15, 0.06, -0.10, 0.12, -0.08, 0.05, 0.18, 0.10];

/// A unit at rest in an attitude, one sample each two seconds; its gyros err as `ERRORS` say.
fn imported(enu_c_body: &UnitQuaternion<f64>, hours: f64, seed: u64) -> Imported {
    let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
    let earth = Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
    let force = enu_c_body.inverse() * Vector3::z();
    let error = Vector3::from_fn(|i, _| {
        let a = force[i];
        ERRORS[3 * i] + ERRORS[3 * i + 1] * a + ERRORS[3 * i + 2] * a * a
    });
    let rate = enu_c_body.inverse() * earth + error * DEG_PER_H;
    let mut noise = Noise::of_seed(seed);
    let samples: Vec<_> = (0..(hours * 1800.0) as usize)
        // 0.005 deg/h held over a minute, and 1e-5 g in a mean of a minute.
        .map(|_| {
            let gyro = noise.vector() * (0.005 * 30_f64.sqrt() * DEG_PER_H);
            let accel = noise.vector() * (1e-5 * 30_f64.sqrt());
            (rate + gyro, force + accel)
        })
        .collect();
    let text = "[time]\nrate_hz = 0.5\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n\
                [accel]\ncolumns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n[site]\nlatitude_deg = 39.1\n";
    let settings = ImportSettings {
        averaging_s: 60.0,
        ..ImportSettings::default()
    };
    let description = Description::parse(text, "log.toml").unwrap();
    let mut imported = import(&log(2.0, &samples), &description, &settings).unwrap();
    // What a log tells of the gyros' noise is a bound; here it is known.
    imported.bench.gyro_noise_deg_per_h = 0.005;
    imported.bench.accel_noise_g = 1e-5;
    imported
}

fn runs(imported: &[Imported]) -> Vec<Run<'_>> {
    let run = imported.iter().map(|one| Run {
        record: &one.record,
        bench: &one.bench,
    });
    run.collect()
}

fn strapdown(imported: &[Imported]) -> Calibration {
    let axes: Vec<GyroAxes> = imported
        .iter()
        .map(|one| GyroAxes::new(&one.platform_q_body))
        .collect();
    calibrate_strapdown(&runs(imported), &axes, &Options::default(), |_| ()).unwrap()
}

fn attitudes(count: usize) -> Vec<UnitQuaternion<f64>> {
    let mut noise = Noise::of_seed(7);
    let random = |_| UnitQuaternion::from_scaled_axis(noise.vector() * 2.0);
    (0..count).map(random).collect()
}

/// Errors of the coefficients in their sigmas: sum of squares, by the whole covariance.
fn normalised(calibration: &Calibration) -> f64 {
    let covariance = nalgebra::SMatrix::<f64, 9, 9>::from_fn(|i, j| calibration.covariance[i][j]);
    let estimates = calibration.drift.to_array();
    let errors = nalgebra::SVector::<f64, 9>::from_fn(|i, _| estimates[i] - ERRORS[i]);
    let solved = covariance.cholesky().unwrap().solve(&errors);
    errors.dot(&solved)
}

#[test]
fn records_in_many_attitudes_give_the_nine_errors_in_the_gyros_axes() {
    let imported: Vec<Imported> = attitudes(16)
        .iter()
        .enumerate()
        .map(|(seed, attitude)| imported(attitude, 3.0, seed as u64))
        .collect();
    let found = strapdown(&imported);
    // Chi-square with nine degrees of freedom exceeds 27.9 once in a thousand.
    let nees = normalised(&found);
    assert!(nees < 27.9, "{nees}");
    for coefficient in found.coefficients() {
        assert!(
            coefficient.determined,
            "{} is not determined",
            coefficient.id
        );
    }
    // 3 * 180 * 16 values: the mean of their squares scatters by 0.015.
    let nis = found.fit.nis_sum() / found.fit.values() as f64;
    assert!((nis - 1.0).abs() < 0.06, "{nis}");
    // The law of a platform with gyros of its own is another: it errs beyond any sigma.
    let platform = calibrate_runs(&runs(&imported), &Options::default(), |_| ());
    if let Ok(platform) = platform {
        let estimates = platform.drift.to_array().map(|estimate| -estimate);
        let worst = (0..9)
            .map(|i| (estimates[i] - ERRORS[i]).abs() / platform.covariance[i][i].sqrt())
            .fold(0.0, f64::max);
        assert!(worst > 10.0, "{worst}");
    }
}

#[test]
fn one_attitude_tells_two_numbers_and_the_third_only_with_a_heading() {
    // Level but for some degrees, so that each gyro is nearly east, north or up.
    let level = UnitQuaternion::from_euler_angles(0.03, -0.02, 0.4);
    let one = [imported(&level, 6.0, 1)];
    let found = strapdown(&one);
    let enu_c_body = level.to_rotation_matrix();
    let along = |direction: usize| {
        let force = level.inverse() * Vector3::z();
        // Weights of the nine coefficients in the error of gyros along east, north or up.
        let weights: [f64; 9] = core::array::from_fn(|i| {
            enu_c_body[(direction, i / 3)] * force[i / 3].powi((i % 3) as i32)
        });
        let dot = |values: &[f64; 9]| (0..9).map(|i| weights[i] * values[i]).sum::<f64>();
        let rows = found.covariance.map(|row| dot(&row));
        (
            dot(&found.drift.to_array()) - dot(&ERRORS),
            dot(&rows).sqrt(),
        )
    };
    for direction in [1, 2] {
        let (error, sigma) = along(direction);
        assert!(error.abs() < 4.0 * sigma, "{direction}: {error} {sigma}");
        // Before the record a sum of three coefficients with a sigma of 1 each.
        assert!(sigma < 0.05, "{direction}: {sigma}");
    }
    let (_, east) = along(0);
    assert!(east > 0.3, "{east}");
}

#[test]
fn axes_are_read_as_they_were_written_and_only_beside_their_record() {
    let one = imported(&UnitQuaternion::identity(), 1.0, 1);
    let text = axes_csv(&one.record, &one.platform_q_body);
    let read = |text: &str| read_axes(&SourceText::new(text, "axes.csv").unwrap(), &one.record);
    assert_eq!(read(&text).unwrap(), one.platform_q_body);
    let refused = |text: &str| read(text).unwrap_err().to_string();
    let short = text.lines().take(10).collect::<Vec<_>>().join("\n");
    assert!(refused(&short).contains("9 rows"), "{}", refused(&short));
    let later = text.replacen("\n30.0,", "\n31.0,", 1);
    assert!(refused(&later).contains("time 31 s"), "{}", refused(&later));
    let second = text.lines().nth(1).unwrap();
    let null = text.replacen(second, "30.0,0.0,0.0,0.0,0.0", 1);
    assert!(refused(&null).contains("norm 0.0000"), "{}", refused(&null));
}
