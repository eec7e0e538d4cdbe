//! Planned runs of a strapdown unit: logs simulated in the planned attitude and imported agree with the predictions.
#![cfg(test)]

use gyrocal_calibration::{
    FittedPlatform, GyroAxes, NoiseModel, Options, Run, calibrate_strapdown,
};
use gyrocal_design::{
    Aim, AttitudeOf, DesignError, Forecast, NamedCause, PlanOptions, PlanResult, Proposal, compare,
    first_screen, fitted_to_records, plan,
};
use gyrocal_diagnosis::{
    DiagnoseOptions, Gate, RecordToDiagnose, RecordsDiagnosis, diagnose_records,
};
use gyrocal_instruments::strapdown::{ImportSettings, Imported, import};
use gyrocal_instruments::{Description, Log};
use gyrocal_record::GimbalLimits;
use gyrocal_setup::PlatformKind;
use gyrocal_statistics::deviates::Normals;
use nalgebra::{UnitQuaternion, Vector3};

const LATITUDE_DEG: f64 = 39.1;
const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;
const DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// Noise of the gyros as held over one minute, deg/h, and of a row of two minutes, g.
const GYRO_DEG_PER_H: f64 = 0.005;
const ACCEL_G: f64 = 1e-5;
const ROW_S: f64 = 120.0;
const SAMPLE_S: f64 = 2.0;

/// Body from local level axes by rotations about x, then y, then z.
fn enu_c_body(angles_deg: [f64; 3]) -> UnitQuaternion<f64> {
    let [x, y, z] = angles_deg.map(f64::to_radians);
    let about = |axis: Vector3<f64>, angle: f64| UnitQuaternion::from_scaled_axis(axis * angle);
    about(Vector3::x(), x) * about(Vector3::y(), y) * about(Vector3::z(), z)
}

/// Errors of the gyros, deg/h, of specific force along them: the nominal ones.
fn nominal(force: &Vector3<f64>) -> Vector3<f64> {
    let coefficients = [
        [0.20, -0.15, 0.06],
        [-0.10, 0.12, -0.08],
        [0.05, 0.18, 0.10],
    ];
    Vector3::from_fn(|i, _| {
        let [constant, g, gg] = coefficients[i];
        constant + g * force[i] + gg * force[i] * force[i]
    })
}

/// A unit with the nominal errors and `across` deg/h/g of gyro x by specific force along y.
struct Unit {
    across: f64,
    /// Standard deviation of the heading that is given, deg; else it is that of the gyros.
    heading_sigma_deg: Option<f64>,
}

const SOUND: Unit = Unit {
    across: 0.0,
    heading_sigma_deg: None,
};

impl Unit {
    /// Its log at rest in an attitude, as the import makes a platform of it.
    fn imported(&self, angles_deg: [f64; 3], hours: f64, seed: u64) -> Imported {
        let attitude = enu_c_body(angles_deg);
        let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
        let earth = attitude.inverse() * Vector3::new(0.0, cosine, sine) * EARTH_RATE_RAD_PER_S;
        let force = attitude.inverse() * Vector3::z();
        let error = nominal(&force) + Vector3::x() * self.across * force.y;
        let rate = earth + error * DEG_PER_H;
        let mut normals = Normals::of_seed(seed);
        let mut noise = |sigma: f64| Vector3::from_fn(|_, _| sigma * normals.normal());
        let (mut gyro, mut accel) = (Vec::new(), Vec::new());
        for _ in 0..(hours * 3600.0 / SAMPLE_S) as usize {
            let held = GYRO_DEG_PER_H * DEG_PER_H * (60.0 / SAMPLE_S).sqrt();
            gyro.push((rate + noise(held)).into());
            accel.push((force + noise(ACCEL_G * (ROW_S / SAMPLE_S).sqrt())).into());
        }
        let text = "[time]\nrate_hz = 0.5\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n\
                    [accel]\ncolumns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n[site]\nlatitude_deg = 39.1\n";
        let [east, north, _]: [f64; 3] = (attitude * Vector3::y()).into();
        let heading_deg = east.atan2(north).to_degrees();
        let settings = ImportSettings {
            averaging_s: ROW_S,
            heading_deg: self
                .heading_sigma_deg
                .map(|sigma_deg| [heading_deg, sigma_deg]),
            ..ImportSettings::default()
        };
        let description = Description::parse(text, "log.toml").unwrap();
        let log = Log::from_samples(SAMPLE_S, gyro, accel);
        let mut imported = import(&log, &description, &settings).unwrap();
        // What a log tells of the gyros' noise is a bound; here it is known.
        imported.bench.gyro_noise_deg_per_h = GYRO_DEG_PER_H;
        imported.bench.accel_noise_g = ACCEL_G;
        imported
    }

    /// The planned run.
    fn made(&self, planned: &Proposal, seed: u64) -> Imported {
        let hours = planned.duration_s / 3600.0;
        self.imported(planned.angles_deg.unwrap(), hours, seed)
    }
}

fn run(imported: &Imported) -> Run<'_> {
    Run {
        record: &imported.record,
        bench: &imported.bench,
    }
}

fn axes(imported: &Imported) -> GyroAxes {
    GyroAxes::new(&imported.platform_q_body)
}

fn options(hours: f64) -> PlanOptions {
    PlanOptions {
        durations_s: vec![hours * 3600.0],
        ..PlanOptions::default()
    }
}

fn planned(first: &Imported, options: &PlanOptions) -> Result<PlanResult, DesignError> {
    let noise = NoiseModel::default();
    let axes = axes(first);
    let settings = Options::default();
    let fitted = NamedCause::fitted_of_unit(&[], &run(first), Some(&axes), &noise, &settings)?;
    plan(&fitted, &run(first), &[], options)
}

/// Standard deviations of the joint calibration over those of a forecast.
fn ratios(imported: &[&Imported], predicted: &[Forecast]) -> Vec<f64> {
    let runs: Vec<Run<'_>> = imported.iter().map(|one| run(one)).collect();
    let axes: Vec<GyroAxes> = imported.iter().map(|one| axes(one)).collect();
    let options = Options {
        noise: false,
        ..Options::default()
    };
    let found = calibrate_strapdown(&runs, &axes, &options, |_| ()).unwrap();
    let pairs = predicted.iter().zip(found.coefficients());
    pairs
        .map(|(predicted, found)| found.sigma / predicted.sigma)
        .collect()
}

#[test]
fn sigmas_after_the_planned_log_are_those_of_the_joint_calibration() {
    for heading_sigma_deg in [None, Some(0.05)] {
        let unit = Unit {
            heading_sigma_deg,
            ..SOUND
        };
        let first = unit.imported([20.0, -35.0, 60.0], 6.0, 1);
        let planned = planned(&first, &options(6.0)).unwrap();
        assert_eq!(planned.attitude_of, AttitudeOf::Unit);
        assert_eq!(planned.aim, Aim::Sigmas);
        let best = &planned.proposals[0];
        // The same attitude tells nothing more: noise is small beside what one attitude cannot tell.
        assert!(planned.going_on[0].outlook.sigma_ratio > 0.99);
        assert!(best.outlook.sigma_ratio < 0.5);
        let second = unit.made(best, 2);
        let longer = unit.imported([20.0, -35.0, 60.0], 12.0, 3);
        for (predicted, found) in [
            (&planned.now, &[&first][..]),
            (&best.outlook, &[&first, &second]),
            (&planned.going_on[0].outlook, &[&longer]),
        ] {
            // The forecast is that of the worse of two headings, five degrees to either side of the one that the
            // gyros find, which is a degree off.
            let tolerance = match heading_sigma_deg {
                Some(_) => 0.01,
                None => 0.04,
            };
            for ratio in ratios(found, &predicted.coefficients) {
                assert!((ratio - 1.0).abs() < tolerance, "{ratio}");
            }
        }
        for (proposal, seed) in planned.proposals.iter().zip(4..) {
            let next = unit.made(proposal, seed);
            for ratio in ratios(&[&first, &next], &proposal.outlook.coefficients) {
                // None is too good, as one would be for a gyro along North whatever the heading.
                assert!(ratio < 1.04, "{:?} {ratio}", proposal.angles_deg);
            }
        }
    }
}

/// Attitudes of the logs from which a term that is not nominal is found, with rivals.
const ATTITUDES_DEG: [[f64; 3]; 4] = [
    [20.0, -35.0, 60.0],
    [110.0, 20.0, -40.0],
    [-75.0, 50.0, 10.0],
    [170.0, -10.0, 120.0],
];

/// The logs in four attitudes, with a term across in gyro x.
fn with_term_across() -> (Unit, Vec<Imported>) {
    let unit = Unit {
        across: 0.1,
        heading_sigma_deg: Some(0.05),
    };
    let seeds = 10..;
    let logs = ATTITUDES_DEG.iter().zip(seeds);
    let logs = logs.map(|(angles_deg, seed)| unit.imported(*angles_deg, 3.0, seed));
    let logs = logs.collect();
    (unit, logs)
}

fn diagnosed(logs: &[Imported]) -> RecordsDiagnosis {
    let given = logs.iter().enumerate().map(|(index, one)| {
        let gate = Gate::new(PlatformKind::Computed, &run(one), &Options::default());
        RecordToDiagnose {
            name: format!("{index}.csv"),
            gate: gate.with_gyro_axes(Some(axes(one))),
            bench: &one.bench,
        }
    });
    diagnose_records(given.collect(), &DiagnoseOptions::default(), |_| ()).unwrap()
}

#[test]
fn a_set_of_rivals_is_resolved_as_forecast() {
    let (unit, logs) = with_term_across();
    let result = diagnosed(&logs).together.result;
    let named = NamedCause::all(&result);
    assert_eq!(named[0].effect, "gyro_x.g_y");
    let runs: Vec<Run<'_>> = logs.iter().map(run).collect();
    let of_runs: Vec<GyroAxes> = logs.iter().map(axes).collect();
    let settings = Options::default();
    let (fitted, record) = fitted_to_records(&result, &runs, &of_runs, &settings).unwrap();
    let past = Run {
        record: &record,
        bench: &logs[3].bench,
    };
    // Any attitude, and those beside the last one for less than an hour, which leave some rivals.
    let near = ATTITUDES_DEG[3].map(|angle| Some([angle - 1.0, angle + 1.0]));
    let near = GimbalLimits { deg: near };
    let anywhere = GimbalLimits::default();
    for (limits, hours, seeds) in [(anywhere, 3.0, 20..24), (near, 0.75, 30..50)] {
        let options = PlanOptions {
            limits,
            ..options(hours)
        };
        let planned = plan(&fitted, &past, &named, &options).unwrap();
        assert_eq!(planned.aim, Aim::Set);
        assert_eq!(planned.records.len(), 4);
        // What is of the same force in each attitude is so in one of them once more.
        let [now, on] = [&planned.now, &planned.going_on[0].outlook].map(|one| &one.sets[0]);
        for mean_size in [now.mean_size, on.mean_size] {
            // Rounding of a sum of probabilities.
            assert!((mean_size - 5.0).abs() < 1e-12, "{mean_size}");
        }
        let best = &planned.proposals[0];
        assert!(limits.hold(best.angles_deg.unwrap()));
        let forecast = &best.outlook.sets[0];
        let runs = seeds.clone().count();
        let mut left = 0;
        for seed in seeds {
            let next = unit.made(best, seed);
            let own = axes(&next);
            let found = compare(&fitted, &past, &run(&next), Some(&own), &named, &settings);
            let set = &found.unwrap().sets[0];
            left += set.iter().filter(|member| member.stays).count();
            let truth = set.iter().find(|member| member.effect == "gyro_x.g_y");
            let [size, sigma] = truth.unwrap().sizes[0];
            // One in sixteen thousand is farther off.
            assert!((size - 0.1).abs() < 4.0 * sigma, "{size} {sigma}");
        }
        // Members that stay beside the cause; of twenty runs the mean is within a tenth, and it is forecast for
        // both of a pair as the cause.
        let others = forecast.members.iter().map(|one| 1.0 - one.told_apart);
        let expected = 1.0 + others.sum::<f64>();
        let mean = left as f64 / runs as f64;
        assert!((mean - expected).abs() < 0.3, "{mean} {expected}");
        assert!((1.0..3.0).contains(&forecast.mean_size), "{forecast:?}");
    }
}

#[test]
fn a_plan_from_a_written_joint_diagnosis_is_that_from_the_diagnosis() {
    let (_, logs) = with_term_across();
    let together = diagnosed(&logs).together;
    let named = NamedCause::all(&together.result);
    let runs: Vec<Run<'_>> = logs.iter().map(run).collect();
    let of_runs: Vec<GyroAxes> = logs.iter().map(axes).collect();
    let settings = Options::default();
    let (written, record) =
        fitted_to_records(&together.result, &runs, &of_runs, &settings).unwrap();
    let bench = &logs[3].bench;
    let plan_of = |fitted: &FittedPlatform<'_>, record| {
        plan(fitted, &Run { record, bench }, &named, &options(3.0)).unwrap()
    };
    let written = plan_of(&written, &record);
    let made = plan_of(together.extended.as_ref().unwrap(), &together.record);
    assert_eq!(written.attitude_of, AttitudeOf::Unit);
    let [one, other] = [&written, &made].map(|plan| &plan.now.coefficients);
    for (one, other) in one.iter().zip(other) {
        // The same noise about the same fit, which each search for it ends within a thousandth of a sigma of.
        assert!(
            (one.sigma / other.sigma - 1.0).abs() < 1e-3,
            "{one:?} {other:?}"
        );
    }
    let screen = first_screen(&written);
    assert!(screen.what.contains("unit angles x"), "{}", screen.what);
    let angles = screen.facts.iter().find(|fact| fact.label == "angles");
    assert!(angles.unwrap().words.contains("East, North, Up"));
    let steps: Vec<&str> = screen.next.iter().map(|step| &*step.command).collect();
    assert!(
        steps[0].starts_with("gyrocal import strapdown"),
        "{steps:?}"
    );
    assert!(
        steps[1].ends_with(" --gyro-axes next.axes.csv"),
        "{steps:?}"
    );
}

#[test]
fn limits_are_of_the_unit_and_one_attitude_within_them_is_enough() {
    let first = SOUND.imported([20.0, -35.0, 60.0], 3.0, 1);
    let with = |deg| PlanOptions {
        limits: GimbalLimits { deg },
        ..options(3.0)
    };
    // A platform would turn out of them in the first hour.
    let narrow = with([Some([0.2, 0.4]), Some([-10.4, -10.2]), Some([30.1, 30.3])]);
    let planned_within = planned(&first, &narrow).unwrap();
    for proposal in &planned_within.proposals {
        assert!(
            narrow.limits.hold(proposal.angles_deg.unwrap()),
            "{proposal:?}"
        );
    }
    let none = with([None, Some([91.0, 95.0]), None]);
    let error = planned(&first, &none).unwrap_err();
    assert!(matches!(error, DesignError::NoAttitude), "{error}");
}
