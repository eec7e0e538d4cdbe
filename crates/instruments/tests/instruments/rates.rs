//! Logs in the rate domain against errors that are known.

use gyrocal_instruments::rates::{GyroRates, RateReport, RateSettings, evaluate_rates};
use gyrocal_instruments::{Description, Log, Unfit};
use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Normals;
use nalgebra::{Matrix3, Vector3};

const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
const EARTH_DEG_PER_H: f64 = 15.041_07;
const LATITUDE_DEG: f64 = 50.0;

/// Standard deviations that an estimate may be from the truth: 4.5 of about 60 estimates of fixed seeds.
const SIGMAS: f64 = 4.5;

fn description(more: &str) -> Description {
    let text = format!(
        "[time]\nrate_hz = 10\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n[accel]\n\
         columns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n{more}[site]\nlatitude_deg = {LATITUDE_DEG:?}\n"
    );
    Description::parse(&text, "log.toml").expect("description")
}

/// Drift \[deg/h\] at a sample, beside Earth rate and the table.
pub(crate) type Drift<'a> = &'a dyn Fn(usize) -> Vector3<f64>;

/// A log of ten samples a second: `up` in body axes, rate of the table about it \[rad/s\], matrix of the gyros.
pub(crate) fn log(
    up: Vector3<f64>,
    samples: usize,
    table: &dyn Fn(usize) -> f64,
    matrix: &Matrix3<f64>,
    drift: Drift<'_>,
    seed: u64,
) -> Log {
    let mut normals = Normals::of_seed(seed);
    let up = up.normalize();
    let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
    let other = Vector3::new(0.3, 0.5, 0.8);
    let east = up.cross(&other).normalize();
    let north = up.cross(&east);
    let mut angle = 0.0_f64;
    let mut gyro = Vec::new();
    let mut accel = Vec::new();
    for sample in 0..samples {
        angle += 0.1 * table(sample);
        let horizontal = angle.cos() * north - angle.sin() * east;
        let earth = EARTH_DEG_PER_H * DEG_PER_H * (sine * up + cosine * horizontal);
        let mut noise = |size: f64| Vector3::from([(); 3].map(|()| size * normals.normal()));
        let rate =
            matrix * (earth + up * table(sample)) + DEG_PER_H * (drift(sample) + noise(30.0));
        gyro.push(rate.into());
        accel.push((up + noise(1e-3)).into());
    }
    Log::from_samples(0.1, gyro, accel)
}

pub(crate) fn evaluated(logs: &[Log], more: &str) -> RateReport {
    evaluate_rates(logs, &description(more), &RateSettings::default()).expect("evaluation")
}

pub(crate) fn near(gyro: &GyroRates, name: &str, truth: f64) {
    let coefficient = gyro.coefficients.iter().find(|c| c.name == name);
    let coefficient = coefficient.unwrap_or_else(|| panic!("{name} in {:?}", gyro.coefficients));
    let z = (coefficient.estimate - truth) / coefficient.sigma;
    assert!(z.abs() < SIGMAS, "{name}: {coefficient:?}, truth {truth}");
}

#[test]
fn biases_of_degrees_a_second_are_ordinary() {
    // 5, -2 and 0.1 deg/s.
    let bias = Vector3::new(18_000.0, -7_200.0, 360.0);
    let up = Vector3::new(0.1, -0.2, 1.0);
    let made = log(up, 20_000, &|_| 0.0, &Matrix3::identity(), &|_| bias, 1);
    let report = evaluated(&[made], "");
    let log = &report.logs[0];
    for gyro in 0..3 {
        assert!(
            report.gyros[gyro].effects.is_empty(),
            "{:?}",
            report.gyros[gyro].effects
        );
        let error = log.bias_deg_per_h[gyro] - bias[gyro];
        // Earth rate in an unknown direction is what is not known of it.
        assert!(error.abs() < log.bias_half_width_deg_per_h[gyro], "{log:?}");
        assert!(log.bias_half_width_deg_per_h[gyro] < EARTH_DEG_PER_H);
    }
    let expected = report.earth_vertical_deg_per_h.unwrap() + bias.dot(&up.normalize());
    let [rate, sigma] = log.vertical_deg_per_h.unwrap();
    assert!(
        (rate - expected).abs() < SIGMAS * sigma,
        "{log:?}, {expected}"
    );
}

#[test]
fn turntable_rates_tell_scale_misalignment_and_sensitivity_to_force() {
    let matrix = Matrix3::new(
        1.002, 0.004, -0.003, 0.001, 0.997, 0.005, -0.002, 0.006, 1.001,
    );
    let bias = Vector3::new(300.0, -200.0, 100.0);
    let of_force = Matrix3::new(20.0, -35.0, 10.0, 5.0, 15.0, -30.0, 25.0, 0.0, -10.0);
    // Each axis up and down, at rest, at 30 deg/s to either side, and at rest.
    let table =
        |sample: usize| 30.0_f64.to_radians() * [0.0, 1.0, -1.0, 0.0][(sample / 500).min(3)];
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let logs: Vec<Log> = axes
        .into_iter()
        .flat_map(|axis| [axis, -axis])
        .enumerate()
        .map(|(number, up)| {
            let drift = bias + of_force * up;
            let mut log = log(up, 2000, &table, &matrix, &|_| drift, 10 + number as u64);
            log.table_rate = Some((0..2000).map(table).collect());
            log
        })
        .collect();
    let report = evaluated(&logs, "[table]\ncolumn = \"t\"\nunit = \"deg/s\"\n");
    for (gyro, law) in report.gyros.iter().enumerate() {
        let own = AXES[gyro];
        assert!(law.undetermined.is_empty(), "{:?}", law.undetermined);
        near(law, &format!("gyro_{own}.bias"), bias[gyro]);
        for axis in 0..3 {
            let other = AXES[axis];
            near(
                law,
                &format!("gyro_{own}.g_{other}"),
                of_force[(gyro, axis)],
            );
            if axis == gyro {
                near(
                    law,
                    &format!("gyro_{own}.scale"),
                    1e6 * (matrix[(gyro, gyro)] - 1.0),
                );
            } else {
                near(
                    law,
                    &format!("gyro_{own}.about_{other}"),
                    1e3 * matrix[(gyro, axis)],
                );
            }
        }
    }
}

#[test]
fn one_axis_of_a_table_leaves_the_others_undetermined() {
    let table = |sample: usize| 0.2 * f64::from(u8::from(sample > 1000));
    let mut made = log(
        Vector3::z(),
        3000,
        &table,
        &Matrix3::identity(),
        &|_| Vector3::zeros(),
        20,
    );
    made.table_rate = Some((0..3000).map(table).collect());
    let report = evaluated(&[made], "");
    let undetermined = &report.gyros[0].undetermined;
    assert!(
        undetermined.contains(&"gyro_x.about_y".to_owned()),
        "{undetermined:?}"
    );
    assert!(
        undetermined.contains(&"gyro_x.g_x".to_owned()),
        "{undetermined:?}"
    );
    near(&report.gyros[2], "gyro_z.scale", 0.0);
}

#[test]
fn a_step_and_a_sensitivity_to_temperature_are_found_and_named() {
    let samples = 36_000;
    // Up and down again: no course in time.
    let temperature = |sample: usize| 25.0 + 10.0 * (12.0 * sample as f64 / samples as f64).sin();
    let drift = |sample: usize| {
        let step = if sample < 20_000 { 0.0 } else { 6.0 };
        Vector3::new(step, 1.5 * (temperature(sample) - 25.0), 0.0)
    };
    let mut made = log(
        Vector3::z(),
        samples,
        &|_| 0.0,
        &Matrix3::identity(),
        &drift,
        30,
    );
    made.temperature_c = Some((0..samples).map(temperature).collect());
    let report = evaluated(&[made], "");
    let [x, y, z] = &report.gyros[..] else {
        panic!("three gyros")
    };
    assert_eq!(x.effects.len(), 1, "{:?}", x.effects);
    let (at_s, _) = x.effects[0].step.expect("a step");
    // Blocks are 56 s long.
    assert!((at_s - 2000.0).abs() < 60.0, "{at_s}");
    near(x, "gyro_x.step", 6.0);
    assert_eq!(y.effects.len(), 1, "{:?}", y.effects);
    near(y, "gyro_y.temperature", 1.5);
    assert!(z.effects.is_empty(), "{:?}", z.effects);
    assert!(!report.time_is_temperature);
}

#[test]
fn a_course_of_temperature_in_time_is_said_to_be_one() {
    let samples = 20_000;
    let temperature = |sample: usize| 20.0 + 8.0 * sample as f64 / samples as f64;
    let drift = |sample: usize| Vector3::new(6.0 * (temperature(sample) - 24.0), 0.0, 0.0);
    let mut made = log(
        Vector3::z(),
        samples,
        &|_| 0.0,
        &Matrix3::identity(),
        &drift,
        40,
    );
    made.temperature_c = Some((0..samples).map(temperature).collect());
    let report = evaluated(&[made], "");
    assert!(report.time_is_temperature);
    let effect = &report.gyros[0].effects[0];
    let mut names = effect.alternatives.clone();
    names.push(effect.name.clone());
    for name in ["gyro_x.ramp", "gyro_x.temperature"] {
        assert!(names.contains(&name.to_owned()), "{names:?}");
    }
}

#[test]
fn a_dead_gyro_and_a_log_that_turns_over_are_refused() {
    let still = |_: usize| Vector3::zeros();
    let mut dead = log(
        Vector3::z(),
        2000,
        &|_| 0.0,
        &Matrix3::identity(),
        &still,
        50,
    );
    for rate in &mut dead.gyro {
        rate[1] = 0.5;
    }
    let settings = RateSettings::default();
    let kind = |logs: &[Log]| {
        let error = evaluate_rates(logs, &description(""), &settings).expect_err("refused");
        error.kind()
    };
    assert_eq!(kind(&[dead]), Some(Unfit::Saturated));
    let mut over = log(
        Vector3::z(),
        2000,
        &|_| 0.0,
        &Matrix3::identity(),
        &still,
        51,
    );
    for force in &mut over.accel.as_mut().unwrap()[1200..] {
        *force = force.map(|component| -component);
    }
    assert_eq!(kind(&[over]), Some(Unfit::NeverStatic));
    assert_eq!(kind(&[]), Some(Unfit::TooShort));
}

#[test]
fn a_step_within_a_block_is_one_step() {
    // Blocks of 2400 s over 64 last 37 s: the step is at a third of one.
    let up = Vector3::new(0.1, -0.2, 1.0);
    let drift = |sample: usize| Vector3::new(0.0, if sample < 10_700 { 0.0 } else { 180.0 }, 0.0);
    let made = log(up, 24_000, &|_| 0.0, &Matrix3::identity(), &drift, 7);
    let report = evaluated(&[made], "");
    let effects: Vec<_> = report.gyros[1].effects().collect();
    let [(effect, coefficient)] = &effects[..] else {
        panic!("{effects:?}");
    };
    assert_eq!(effect.name, "gyro_y.step");
    let (time_s, _) = effect.step.expect("instant");
    // A block of this noise tells a step of 180 to a fiftieth of its length.
    assert!((time_s - 1070.0).abs() < 3.0, "{time_s}");
    assert!(
        (coefficient.estimate - 180.0).abs() < SIGMAS * coefficient.sigma,
        "{coefficient:?}"
    );
}

#[test]
fn an_earth_that_turns_the_other_way_is_told() {
    let up = Vector3::new(0.1, -0.2, 1.0);
    let still = |_: usize| 0.0;
    let made = |matrix: Matrix3<f64>| log(up, 40_000, &still, &matrix, &|_| Vector3::zeros(), 8);
    assert!(!evaluated(&[made(Matrix3::identity())], "").earth_is_reversed);
    assert!(evaluated(&[made(-Matrix3::identity())], "").earth_is_reversed);
}

#[test]
fn a_wild_sample_is_told_and_left_out() {
    let up = Vector3::new(0.1, -0.2, 1.0);
    let still = |_: usize| 0.0;
    let made = log(
        up,
        4000,
        &still,
        &Matrix3::identity(),
        &|_| Vector3::zeros(),
        9,
    );
    let mut wild = made.clone();
    wild.gyro[2600][0] = 35.0;
    let [sound, report] = [made, wild].map(|log| evaluated(&[log], ""));
    let [bad] = &report.bad_samples[..] else {
        panic!("{:?}", report.bad_samples);
    };
    assert_eq!((&*bad.gyro, bad.count, bad.log), ("gyro_x", 1, 0));
    assert_eq!(bad.samples[0].sample, 2601);
    assert!((bad.samples[0].time_s - 260.0).abs() < 1e-9);
    assert!((bad.samples[0].value * DEG_PER_H / 35.0 - 1.0).abs() < 1e-9);
    assert!(sound.bad_samples.is_empty());
    // One median of 4000 samples: a deviation of one sample over their number, 30 deg/h / 4000.
    let [bias, of_sound] = [&report, &sound].map(|report| report.logs[0].bias_deg_per_h[0]);
    assert!((bias - of_sound).abs() < 0.03, "{bias} {of_sound}");
}

#[test]
fn gyros_alone_tell_rates() {
    let up = Vector3::new(0.1, -0.2, 1.0).normalize();
    let drift = |sample: usize| Vector3::new(300.0, if sample < 12_000 { 0.0 } else { 150.0 }, 0.0);
    let mut made = log(up, 24_000, &|_| 0.0, &Matrix3::identity(), &drift, 10);
    let with_attitude = evaluated(&[made.clone()], "");
    // Without a latitude the outputs are what they are, and the part along specific force is told.
    let text = "[time]\nrate_hz = 10\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n";
    let without = Description::parse(text, "log.toml").expect("description");
    let settings = RateSettings::default();
    let report = evaluate_rates(&[made.clone()], &without, &settings).expect("rates");
    assert_eq!(report.earth_vertical_deg_per_h, None);
    let vertical = |report: &RateReport| report.logs[0].vertical_deg_per_h.map(|[rate, _]| rate);
    assert_eq!(vertical(&report), vertical(&with_attitude));
    // Nor without accelerometers, with a latitude or not.
    made.accel = None;
    let report = evaluated(&[made.clone()], "");
    assert_eq!(report.earth_horizontal_deg_per_h, None);
    assert_eq!(vertical(&report), None);
    let effects: Vec<&str> = report.gyros[1]
        .effects()
        .map(|(one, _)| &*one.name)
        .collect();
    assert_eq!(effects, ["gyro_y.step"]);
    let earth = EARTH_DEG_PER_H * LATITUDE_DEG.to_radians().sin() * up.x;
    let [rate, sigma] = report.logs[0].rate_deg_per_h[0];
    assert_eq!(rate, report.logs[0].bias_deg_per_h[0]);
    // The horizontal part is in any direction.
    let off = (rate - 300.0 - earth).abs();
    assert!(off < EARTH_DEG_PER_H + SIGMAS * sigma, "{rate} {sigma}");
    assert_eq!(report.gyros[0].undetermined.len(), 3);
    // Two logs of a unit have one bias between them.
    let two = evaluated(&[made.clone(), made.clone()], "");
    assert_eq!(two.gyros[0].coefficients.len(), 1);
    // A table without an axis has none.
    made.table_rate = Some(vec![0.1; made.len()]);
    let error = evaluate_rates(&[made], &without, &settings).expect_err("refused");
    assert_eq!(error.kind(), Some(Unfit::NoAccelerometers));
}

#[test]
fn steps_of_one_gyro_have_each_their_own_size() {
    let up = Vector3::new(0.1, -0.2, 1.0);
    let drift = |sample: usize| {
        let steps = [(8_000, 150.0), (16_000, -60.0)];
        let so_far = steps
            .iter()
            .filter(|(at, _)| sample >= *at)
            .map(|(_, size)| size);
        Vector3::new(so_far.sum(), 0.0, 0.0)
    };
    let made = log(up, 24_000, &|_| 0.0, &Matrix3::identity(), &drift, 9);
    let report = evaluated(&[made], "");
    let mut found: Vec<(f64, f64)> = report.gyros[0]
        .effects()
        .map(|(effect, one)| (effect.step.expect("a step").0, one.estimate))
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(first_s, first), (second_s, second)] = found[..] else {
        panic!("{found:?}");
    };
    assert!(
        (first_s - 800.0).abs() < 5.0 && (second_s - 1600.0).abs() < 10.0,
        "{found:?}"
    );
    assert!(
        (first - 150.0).abs() < 15.0 && (second + 60.0).abs() < 15.0,
        "{found:?}"
    );
}

#[test]
fn hysteresis_of_a_narrow_play_is_in_the_set() {
    let samples = 24_000;
    let temperature: Vec<f64> = (0..samples)
        .map(|sample| 20.0 + 15.0 * (core::f64::consts::PI * sample as f64 / samples as f64).sin())
        .collect();
    // Half a play of 0.06 of the range.
    let lagging = gyrocal_statistics::followed_with_play(&temperature, 0.9);
    let up = Vector3::new(0.1, -0.2, 1.0);
    let drift = |sample: usize| Vector3::new(30.0 * lagging[sample], 0.0, 0.0);
    let mut made = log(up, samples, &|_| 0.0, &Matrix3::identity(), &drift, 10);
    made.temperature_c = Some(temperature);
    let report = evaluated(&[made], "");
    let in_a_set = report.gyros[0].effects.iter().any(|effect| {
        let mut names = core::iter::once(&effect.name).chain(&effect.alternatives);
        names.any(|name| name == "gyro_x.temperature_hysteresis")
    });
    assert!(in_a_set, "{:?}", report.gyros[0].effects);
}
