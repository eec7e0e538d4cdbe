//! The analytic platform against simulation with known errors.

use crate::common::{EARTH_RATE_RAD_PER_S, log};
use gyrocal_instruments::strapdown::{ImportSettings, Imported, import, integrate};
use gyrocal_instruments::{Description, InstrumentError, Log, Unfit};
use gyrocal_truth::{Attitude, Coefficients, InitialAttitude, Scenario, simulate};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

const LATITUDE_DEG: f64 = 39.1;
const ANGLES_DEG: [f64; 3] = [10.0, -5.0, 40.0];
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

fn description() -> Description {
    let text = "[time]\nrate_hz = 1\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n\
                [accel]\ncolumns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n[site]\nlatitude_deg = 39.1\n";
    Description::parse(text, "log.toml").unwrap()
}

fn earth_enu() -> Vector3<f64> {
    let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
    Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S
}

fn body_c_enu() -> Matrix3<f64> {
    let attitude = Attitude::from_angles_rad(ANGLES_DEG.map(f64::to_radians));
    let column = |axis: [f64; 3]| Vector3::from(attitude.resolve(axis));
    Matrix3::from_columns(&[
        column([1.0, 0.0, 0.0]),
        column([0.0, 1.0, 0.0]),
        column([0.0, 0.0, 1.0]),
    ])
}

/// A unit at rest whose gyros err by `error` \[rad/s\], one sample a second.
fn at_rest(error: Vector3<f64>, seconds: usize) -> Log {
    let rate = body_c_enu() * earth_enu() + error;
    log(1.0, &vec![(rate, body_c_enu() * Vector3::z()); seconds])
}

fn imported(log: &Log) -> Result<Imported, InstrumentError> {
    let settings = ImportSettings {
        averaging_s: 10.0,
        ..ImportSettings::default()
    };
    import(log, &description(), &settings)
}

#[test]
fn the_platform_drifts_by_minus_the_gyros_errors_turned_into_its_axes() {
    // An error along Earth rate keeps its direction in the platform, so the independent simulator
    // can have it as a constant drift: minus the error, in the axes of the body at the first row.
    let share = 0.02;
    let error = body_c_enu() * earth_enu() * share;
    let record = imported(&at_rest(error, 3600)).unwrap().record;
    let scenario = Scenario {
        latitude_deg: LATITUDE_DEG,
        coefficients: Coefficients {
            bias_deg_per_h: (-error / DEG_PER_H).into(),
            ..Coefficients::NONE
        },
        initial: InitialAttitude::AnglesDeg(ANGLES_DEG),
        // Sigmas are positive; this one is nothing.
        initial_angles_sigma_deg: [1e-12; 3],
        accel_noise_g: 0.0,
        gyro_noise_deg_per_h: 0.0,
        start_s: 5.0,
        interval_s: 10.0,
        duration_s: 3590.0,
        ..Scenario::default()
    };
    let truth = simulate(&scenario).unwrap().record;
    assert_eq!(record.len(), truth.len());
    for row in 0..record.len() {
        assert!((record.time_s[row] - truth.time_s[row]).abs() < 1e-9);
        for axis in 0..3 {
            // Means over ten seconds are shorter than what is in their middle by (7.3e-4)²/24.
            // The drift itself moves gravity by 5e-3 in the hour.
            let difference = record.accel_g[row][axis] - truth.accel_g[row][axis];
            assert!(
                difference.abs() < 3e-8,
                "row {row} axis {axis}: {difference:e}"
            );
        }
    }
}

#[test]
fn any_constant_error_is_found_as_the_rate_beside_that_of_the_earth() {
    let error = Vector3::new(0.2, -0.3, 0.5) * DEG_PER_H;
    let report = imported(&at_rest(error, 3600)).unwrap().report;
    let [east, north, up]: [f64; 3] = (body_c_enu().transpose() * error / DEG_PER_H).into();
    let horizontal = report.expected_horizontal_rate_deg_per_h;
    let expected = (horizontal + north).hypot(east);
    // Residuals of the means, 2e-8 g, over an hour: 2e-8 rad / h is 1e-6 deg/h; the vertical
    // part, seen through a turn of a quarter of a radian, is some ten times worse.
    assert!((report.horizontal_rate_deg_per_h[0] - expected).abs() < 1e-5);
    let vertical = report.vertical_rate_deg_per_h[0] - report.expected_vertical_rate_deg_per_h;
    assert!((vertical - up).abs() < 1e-4, "{vertical} {up}");
    // An error toward east turns the heading.
    let true_heading_deg = {
        let y = body_c_enu().row(1).transpose();
        y.x.atan2(y.y).to_degrees()
    };
    let turned_deg = (report.heading_deg - true_heading_deg + 180.0).rem_euclid(360.0) - 180.0;
    let expected_deg = -(east / (horizontal + north)).atan().to_degrees();
    assert!(
        (turned_deg - expected_deg).abs() < 1e-4,
        "{turned_deg} {expected_deg}"
    );
}

#[test]
fn the_vertical_error_is_that_of_the_mean_within_its_sigma() {
    // White noise of 1 deg/h over a second: 0.017 deg/h over an hour; accelerometers of 1e-4 g, with which
    // the path of gravity tells it ten times worse.
    let error = Vector3::new(0.2, -0.3, 0.5) * DEG_PER_H;
    let mut noise = crate::common::Noise::of_seed(21);
    let rate = body_c_enu() * earth_enu() + error;
    let samples: Vec<_> = (0..3600)
        .map(|_| {
            let gyro = rate + DEG_PER_H * noise.vector();
            (gyro, body_c_enu() * Vector3::z() + 1e-4 * noise.vector())
        })
        .collect();
    let report = imported(&log(1.0, &samples)).unwrap().report;
    let up = (body_c_enu().transpose() * error / DEG_PER_H).z;
    let expected = report.expected_vertical_rate_deg_per_h + up;
    let [mean, sigma] = report.vertical_projection_deg_per_h.unwrap();
    assert!(
        (mean - expected).abs() < 4.0 * sigma,
        "{mean} {sigma} {expected}"
    );
    assert!((0.012..0.025).contains(&sigma), "{sigma}");
    let [_, of_path] = report.vertical_rate_deg_per_h;
    let [both, of_both] = report.vertical_combined_deg_per_h;
    assert!(
        of_path > 3.0 * sigma && of_both <= sigma,
        "{of_path} {of_both}"
    );
    assert!((both - expected).abs() < 4.0 * of_both);
}

#[test]
fn coning_is_no_rotation() {
    // A cone of 0.02 rad at 1.3 Hz sampled at 100 Hz. Sums of increments alone would take it for
    // a rate of 0.02² · 8.2 / 2 · (0.082)² / 6 rad/s, 0.37 deg/h, about its axis.
    const INTERVAL_S: f64 = 0.01;
    const PARTS: usize = 20;
    let attitude = |time_s: f64| {
        let (sine, cosine) = (core::f64::consts::TAU * 1.3 * time_s).sin_cos();
        UnitQuaternion::from_scaled_axis(Vector3::new(0.02 * cosine, 0.02 * sine, 0.0))
    };
    let samples: Vec<(Vector3<f64>, Vector3<f64>)> = (0..20_000)
        .map(|sample| {
            let time_s = |part: usize| (sample as f64 + part as f64 / PARTS as f64) * INTERVAL_S;
            // Short rotations, one after the other, are what a gyro sums.
            let increment: Vector3<f64> = (0..PARTS)
                .map(|part| {
                    let turn = attitude(time_s(part)).inverse() * attitude(time_s(part + 1));
                    turn.scaled_axis()
                })
                .sum();
            let force = attitude(time_s(PARTS / 2)).inverse() * Vector3::new(1.0, 0.0, 0.0);
            (increment / INTERVAL_S, force)
        })
        .collect();
    let rows = integrate(&log(INTERVAL_S, &samples), 10.0).unwrap();
    // Gravity along body x shows a turn about z.
    let [first, last] = [&rows[0], &rows[rows.len() - 1]];
    let angle = |force_g: &[f64; 3]| force_g[1].atan2(force_g[0]);
    let turned = angle(&last.force_g) - angle(&first.force_g);
    let rate = turned / (last.time_s - first.time_s) / DEG_PER_H;
    // What is left of the algorithm is of the order of (0.082)² of the correction.
    assert!(rate.abs() < 0.01, "{rate}");
}

#[test]
fn a_heading_that_is_known_goes_into_the_bench_file() {
    let log = at_rest(Vector3::zeros(), 1200);
    let known = ImportSettings {
        averaging_s: 10.0,
        heading_deg: Some([12.0, 0.5]),
        ..ImportSettings::default()
    };
    let bench = import(&log, &description(), &known).unwrap().bench;
    let angles_rad = bench.initial_angles_deg.unwrap().map(f64::to_radians);
    let y = {
        let attitude = Attitude::from_angles_rad(angles_rad);
        let row = |axis: [f64; 3]| attitude.resolve(axis)[1];
        [row([1.0, 0.0, 0.0]), row([0.0, 1.0, 0.0])]
    };
    assert!((y[0].atan2(y[1]).to_degrees() - 12.0).abs() < 1e-6);
    // A heading by one sigma greater is one sigma of all angles together. The level's own sigma of
    // 0.01 deg is added to each: beside movements of some hundredths it takes some percent off.
    let greater = ImportSettings {
        heading_deg: Some([12.5, 0.5]),
        ..known
    };
    let greater = import(&log, &description(), &greater).unwrap().bench;
    let moved = greater.initial_angles_deg.unwrap();
    let sigmas = (0..3)
        .map(|i| {
            let turned = moved[i] - bench.initial_angles_deg.unwrap()[i];
            (turned / bench.initial_angles_sigma_deg[i]).powi(2)
        })
        .sum::<f64>()
        .sqrt();
    assert!((0.95..1.001).contains(&sigmas), "{sigmas}");
    // Without one it is that of the body, which the gyros find.
    let bench = imported(&log).unwrap().bench;
    for (found, angle_deg) in bench.initial_angles_deg.unwrap().iter().zip(ANGLES_DEG) {
        assert!((found - angle_deg).abs() < 1e-3);
    }
}

#[test]
fn disturbed_rows_are_missing_and_told() {
    let mut log = at_rest(Vector3::zeros(), 1200);
    let mut noise = crate::common::Noise::of_seed(1);
    for sample in 0..log.len() {
        let scatter = if (600..650).contains(&sample) {
            50.0
        } else {
            1.0
        };
        for axis in 0..3 {
            log.gyro[sample][axis] += 1e-6 * scatter * noise.normal();
            log.accel.as_mut().unwrap()[sample][axis] += 1e-6 * noise.normal();
        }
    }
    let settings = ImportSettings {
        averaging_s: 10.0,
        // Ten samples a row scatter by a quarter.
        quiet_factor: 3.0,
        ..ImportSettings::default()
    };
    let found = import(&log, &description(), &settings).unwrap();
    assert_eq!(found.report.disturbed_s, [[600.0, 650.0]]);
    let missing: Vec<usize> = (0..120)
        .filter(|row| found.record.accel_g[*row][0].is_nan())
        .collect();
    assert_eq!(missing, [60, 61, 62, 63, 64]);
}

/// Change of the outputs of gyros and accelerometers of a sample.
type Change<'a> = &'a dyn Fn(usize, &mut [f64; 3], &mut [f64; 3]);

fn kind(log: &Log) -> Unfit {
    imported(log).unwrap_err().kind().unwrap()
}

#[test]
fn what_is_no_static_unit_in_these_units_is_refused() {
    let good = at_rest(Vector3::zeros(), 1200);
    let changed = |change: Change<'_>| {
        let mut log = good.clone();
        for sample in 0..log.len() {
            change(
                sample,
                &mut log.gyro[sample],
                &mut log.accel.as_mut().unwrap()[sample],
            );
        }
        log
    };
    let scaled = |values: &mut [f64; 3], factor: f64| values.iter_mut().for_each(|v| *v *= factor);
    // m/s² taken for g; deg/s taken for rad/s; deg/h taken for rad/s.
    assert_eq!(
        kind(&changed(&|_, _, accel| scaled(accel, 9.81))),
        Unfit::Norm
    );
    assert_eq!(
        kind(&changed(&|_, gyro, _| scaled(gyro, 57.296))),
        Unfit::GyroScale
    );
    assert_eq!(
        kind(&changed(&|_, gyro, _| scaled(gyro, 1.0 / 57.296))),
        Unfit::GyroScale
    );
    // A left-handed gyro triad; specific force down positive.
    assert_eq!(
        kind(&changed(&|_, gyro, _| gyro[2] = -gyro[2])),
        Unfit::Axes
    );
    assert_eq!(
        kind(&changed(&|_, _, accel| scaled(accel, -1.0))),
        Unfit::Axes
    );
    // A base that tilts to and fro by a tenth of a radian without the gyros saying so.
    let tilting = changed(&|sample, _, accel| accel[0] += 0.1 * (sample as f64 / 50.0).sin());
    assert_eq!(kind(&tilting), Unfit::NeverStatic);
    assert_eq!(kind(&at_rest(Vector3::zeros(), 150)), Unfit::TooShort);
    let mut counts = good.clone();
    counts.gyro_in_counts = true;
    assert_eq!(kind(&counts), Unfit::NoScale);
}
