//! Diagnosis in the axes of gyros that are fixed to a body, against a simulation of its own.

use gyrocal_answer::{Answer, Verdict};
use gyrocal_calibration::{CalibrationError, GyroAxes, Run};
use gyrocal_diagnosis::{
    DiagnoseOptions, Diagnosis, DiagnosisError, Gate, RecordToDiagnose, diagnose, diagnose_gated,
    diagnose_records,
};
use gyrocal_record::{Bench, Input, InputRole, Record};
use gyrocal_setup::PlatformKind;
use gyrocal_statistics::deviates::Normals;
use nalgebra::{UnitQuaternion, Vector3};

const BENCH: &str = "[site]\nlatitude_deg = 39.1\n\n[platform]\ninitial_angles_deg = [0.0, 0.0, 0.0]\n\
                     initial_angles_sigma_deg = [0.02, 0.02, 0.02]\n\n[noise]\naccel_g = 1e-5\n\
                     gyro_deg_per_h = 0.002\n\n[prior]\nbias_sigma_deg_per_h = 1.0\n\
                     g_sigma_deg_per_h_per_g = 1.0\ngg_sigma_deg_per_h_per_g2 = 1.0\n";
const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;
const INTERVAL_S: f64 = 300.0;
const GYRO_DEG_PER_H: f64 = 0.002;
const ACCEL_G: f64 = 1e-5;

/// A record of the platform computed from a unit at rest, with the axes of its instruments.
struct Unit {
    record: Record,
    bench: Bench,
    axes: GyroAxes,
}

impl Unit {
    fn run(&self) -> Run<'_> {
        Run {
            record: &self.record,
            bench: &self.bench,
        }
    }

    fn gate(&self, options: &DiagnoseOptions) -> Gate<'_> {
        Gate::new(PlatformKind::Computed, &self.run(), &options.calibration)
            .with_gyro_axes(Some(self.axes.clone()))
    }
}

/// A unit for some days in an attitude, platform axes being East, North, Up at first. Its gyros err as `error`
/// says of the specific force along body axes and the time in days \[deg/h\].
fn unit(
    enu_c_body: UnitQuaternion<f64>,
    days: f64,
    seed: u64,
    error: impl Fn(&Vector3<f64>, f64) -> [f64; 3],
) -> Unit {
    let mut normals = Normals::of_seed(seed);
    let mut vector = || Vector3::from_fn(|_, _| normals.normal());
    let bench = Bench::parse(BENCH, "bench.toml").unwrap();
    let (sine, cosine) = 39.1_f64.to_radians().sin_cos();
    let earth = enu_c_body.inverse() * Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
    let force = enu_c_body.inverse() * Vector3::z();
    let mut platform_c_body = enu_c_body;
    let (mut accel_g, mut time_s, mut axes) = (Vec::new(), Vec::new(), Vec::new());
    let held = GYRO_DEG_PER_H * (60.0 / INTERVAL_S).sqrt();
    for row in 0..(days * 86_400.0 / INTERVAL_S) as usize {
        time_s.push(row as f64 * INTERVAL_S);
        accel_g.push((platform_c_body * (force + ACCEL_G * vector())).into());
        let q = platform_c_body.quaternion();
        axes.push([q.w, q.i, q.j, q.k]);
        let middle_days = (row as f64 + 0.5) * INTERVAL_S / 86_400.0;
        let error = Vector3::from(error(&force, middle_days)) + held * vector();
        let turned = (earth + DEG_PER_H * error) * INTERVAL_S;
        platform_c_body *= UnitQuaternion::from_scaled_axis(turned);
    }
    let record = Record {
        time_s,
        accel_g,
        temperature_c: None,
    };
    Unit {
        record,
        bench,
        axes: GyroAxes::new(&axes),
    }
}

fn attitude(seed: u64) -> UnitQuaternion<f64> {
    let mut normals = Normals::of_seed(seed);
    UnitQuaternion::from_scaled_axis(Vector3::from_fn(|_, _| 2.0 * normals.normal()))
}

/// The nominal errors of the gyros.
fn nominal(force: &Vector3<f64>) -> [f64; 3] {
    let along = |i: usize| 0.1 * force[i] - 0.05 * force[i] * force[i];
    [0.2 + along(0), -0.1 + along(1), 0.05 + along(2)]
}

/// Whether a set holds an effect.
fn names(found: &Diagnosis<'_>, effect: &str) -> bool {
    found.result.causes().any(|cause| {
        let others = cause.alternatives.iter().map(|other| &*other.effect);
        core::iter::once(&*cause.effect)
            .chain(others)
            .any(|one| one == effect)
    })
}

/// The files of a result of these inputs, as the next commands have them.
fn files(mut result: Answer, inputs: &str) -> String {
    // The roles by the first letters: later ones begin with l.
    let role = |path: &str| match path.split('.').next().unwrap_or_default() {
        "lr" => InputRole::LaterRecord,
        "lb" => InputRole::LaterBench,
        "la" => InputRole::LaterGyroAxes,
        name if name.starts_with('b') => InputRole::Bench,
        name if name.starts_with('a') => InputRole::GyroAxes,
        name if name.starts_with('m') => InputRole::Columns,
        _ => InputRole::Record,
    };
    let input = |path: &str| Input {
        path: path.to_owned(),
        sha256: String::new(),
        role: Some(role(path)),
        ..Input::default()
    };
    result.manifest.inputs = inputs.split(' ').map(input).collect();
    let files = gyrocal_words::files(&result);
    let next = gyrocal_words::first_screen(&result).next;
    assert!(!next.is_empty());
    for step in next {
        // The model file comes from the result of all records.
        let is_of_result = step.command.starts_with("gyrocal extend RESULT.json");
        assert!(
            is_of_result || step.command.contains(&files),
            "{}",
            step.command
        );
    }
    files
}

#[test]
fn a_ramp_of_a_gyro_of_the_body_is_named_with_the_law_in_its_axes() {
    // Some twenty standard deviations.
    const RAMP: f64 = 0.001;
    let with_ramp = |force: &Vector3<f64>, days: f64| {
        let mut error = nominal(force);
        error[1] += RAMP * days;
        error
    };
    let unit = unit(attitude(3), 2.0, 1, with_ramp);
    let options = DiagnoseOptions::default();
    let found = diagnose_gated(unit.gate(&options), &unit.bench, &options).unwrap();
    assert!(found.result.is_strapdown());
    assert_eq!(found.result.verdict, Verdict::EffectsFound);
    assert!(names(&found, "gyro_y.ramp"), "{:?}", found.result.findings);
    let cause = found.result.causes().next().unwrap();
    if cause.effect == "gyro_y.ramp" {
        let size = &cause.parameters[0];
        assert!((size.estimate - RAMP).abs() < 4.0 * size.sigma.unwrap());
    }
    let mut with_later = found.result.clone();
    with_later.later_record = Some(with_later.record);
    assert_eq!(
        files(
            with_later,
            "r.csv b.toml lr.csv lb.toml a.csv la.csv m.toml"
        ),
        "r.csv --bench b.toml --gyro-axes a.csv --columns m.toml"
    );
    // In the axes of the platform, which the body turns against, it is no ramp alone: no fit converges, more
    // is named, or something is left.
    if let Ok(platform) = diagnose(&unit.record, &unit.bench, &options) {
        assert!(!platform.result.is_strapdown());
        let is_alone = platform.result.causes().count() == 1 && !platform.result.is_unexplained();
        assert!(!(names(&platform, "gyro_y.ramp") && is_alone));
    }
}

#[test]
fn a_sound_unit_is_clean() {
    let options = DiagnoseOptions::default();
    for seed in 10..13 {
        let unit = unit(attitude(seed), 1.0, seed, |force, _| nominal(force));
        let found = diagnose_gated(unit.gate(&options), &unit.bench, &options).unwrap();
        assert_eq!(
            found.result.verdict,
            Verdict::Clean,
            "{seed}: {:?}",
            found.result.findings
        );
    }
}

#[test]
fn a_term_across_is_named_by_records_in_several_attitudes() {
    let across = |force: &Vector3<f64>, _: f64| {
        let mut error = nominal(force);
        error[0] += 0.4 * force[1];
        error
    };
    let units: Vec<Unit> = (20..26)
        .map(|seed| unit(attitude(seed), 0.5, seed, across))
        .collect();
    let options = DiagnoseOptions::default();
    let records = units
        .iter()
        .enumerate()
        .map(|(index, unit)| RecordToDiagnose {
            name: format!("record {}", index + 1),
            gate: unit.gate(&options),
            bench: &unit.bench,
        });
    let all = diagnose_records(records.collect(), &options, |_| ()).unwrap();
    let found = all.together;
    assert!(found.result.is_strapdown());
    assert!(names(&found, "gyro_x.g_y"), "{:?}", found.result.findings);
    assert_eq!(
        files(
            found.result,
            "1.csv b.toml 2.csv b.toml 3.csv b.toml 4.csv b.toml 5.csv b.toml 6.csv b.toml a1 a2 a3 a4 a5 a6"
        ),
        "1.csv 2.csv 3.csv 4.csv 5.csv 6.csv --bench b.toml --gyro-axes a1 --gyro-axes a2 --gyro-axes a3 \
         --gyro-axes a4 --gyro-axes a5 --gyro-axes a6"
    );
    // Alone, one attitude makes a bias of it.
    assert!(!names(&all.alone[0], "gyro_x.g_y"));
}

#[test]
fn axes_of_other_rows_are_refused() {
    let unit = unit(attitude(1), 0.2, 1, |force, _| nominal(force));
    let options = DiagnoseOptions::default();
    let few = GyroAxes::new(&[[1.0, 0.0, 0.0, 0.0]; 3]);
    let gate = unit.gate(&options).with_gyro_axes(Some(few));
    let refused = diagnose_gated(gate, &unit.bench, &options).err();
    assert!(matches!(
        refused,
        Some(DiagnosisError::Calibration(CalibrationError::GyroAxes {
            attitudes: 3,
            ..
        }))
    ));
}
