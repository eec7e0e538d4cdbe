//! The multi-position test on positions and logs whose law is known.

use crate::common::{Noise, Unit, stops_and_turns};
use gyrocal_instruments::multi_position::{
    MultiPositionReport, MultiPositionSettings, Positions, PreparedTest, Term, multi_position_test,
    prepare,
};
use gyrocal_instruments::{
    Description, InstrumentError, Log, StopSettings, Unfit, accel_from_norm, find_stops,
    given_stops, stop_means,
};
use nalgebra::{Matrix3, Vector3};

/// Stops in random attitudes; gyro rates by a law, with noise of 50 deg/h.
fn positions(seed: u64, stops: usize, law: impl Fn(usize, [f64; 3]) -> f64) -> Positions {
    const SIGMA: f64 = 50.0;
    let mut noise = Noise::of_seed(seed);
    let force_g: Vec<[f64; 3]> = (0..stops)
        .map(|_| noise.vector().normalize().into())
        .collect();
    let mut rate =
        |force: &[f64; 3]| core::array::from_fn(|gyro| law(gyro, *force) + SIGMA * noise.normal());
    Positions {
        time_s: (0..stops).map(|stop| 10.0 * stop as f64).collect(),
        rate_deg_per_h: force_g.iter().map(&mut rate).collect(),
        sigma_deg_per_h: vec![[SIGMA; 3]; stops],
        heading_sigma_deg_per_h: vec![[0.0; 3]; stops],
        quantisation_sigma_deg_per_h: vec![[0.0; 3]; stops],
        parts_deg_per_h: vec![Vec::new(); stops],
        duration_s: vec![5.0; stops],
        log: vec![0; stops],
        force_g,
    }
}

fn nominal(gyro: usize, force: [f64; 3]) -> f64 {
    let along = force[gyro];
    [1000.0, -2000.0, 300.0][gyro] + 80.0 * along - 60.0 * along * along
}

fn tested(positions: &Positions) -> MultiPositionReport {
    multi_position_test(positions, &MultiPositionSettings::default()).unwrap()
}

#[test]
fn nothing_is_found_in_a_nominal_instrument_more_often_than_chance_allows() {
    let settings = MultiPositionSettings {
        false_alarm_probability: 0.05,
        ..MultiPositionSettings::default()
    };
    let alarms = (0..100)
        .filter(|seed| {
            let positions = positions(*seed, 38, nominal);
            let report = multi_position_test(&positions, &settings).unwrap();
            !report.findings.is_empty() || !report.not_confirmed.is_empty()
        })
        .count();
    // Binomial with 100 draws of 0.05: 13 and less hold 99.9 %. White noise is not all that there may be: less are found.
    assert!(alarms <= 13, "{alarms}");
}

/// Noise of its standard error and a bias that walks by as much from stop to stop.
fn walking(seed: u64, stops: usize) -> Positions {
    let mut walks = Noise::of_seed(1000 + seed);
    let mut positions = positions(seed, stops, nominal);
    let mut bias = [0.0; 3];
    for rate in &mut positions.rate_deg_per_h {
        for gyro in 0..3 {
            bias[gyro] += 50.0 * walks.normal();
            rate[gyro] += bias[gyro];
        }
    }
    positions
}

#[test]
fn a_walk_is_no_term_and_is_in_the_intervals() {
    let (mut found, mut within, mut all) = (0, 0, 0);
    for seed in 0..60 {
        let report = tested(&walking(seed, 24));
        found += u32::from(!report.findings.is_empty());
        let truth = [80.0, -60.0];
        for gyro in &report.gyros {
            for (one, truth) in gyro.nominal.coefficients[1..].iter().zip(truth) {
                within += u32::from((one.estimate - truth).abs() < 1.96 * one.sigma);
                all += 1;
            }
        }
    }
    // One of a hundred is promised; four of sixty have a chance of 0.3 %.
    assert!(found < 4, "{found}");
    // 95 % of 360 less three of its standard deviations.
    assert!(within >= 330, "{within} of {all}");
}

#[test]
fn a_ramp_of_many_stops_is_found_beside_walks() {
    let ramp = |stop: usize| 4.0 * stop as f64;
    let mut positions = positions(5, 150, nominal);
    for (stop, rate) in positions.rate_deg_per_h.iter_mut().enumerate() {
        rate[2] += ramp(stop);
    }
    let report = tested(&positions);
    let names: Vec<&str> = report.findings.iter().map(|one| &*one.effect).collect();
    assert_eq!(names, ["gyro_z.ramp"]);
    let gain = report.cross_validation.unwrap();
    assert_eq!((gain.left_out, gain.blocks), (13, 12));
}

#[test]
fn a_p_value_is_as_small_as_the_stops_make_it() {
    let positions = positions(1, 38, |gyro, force| {
        nominal(gyro, force) + if gyro == 0 { 250.0 * force[2] } else { 0.0 }
    });
    let settings = MultiPositionSettings {
        false_alarm_probability: 1e-6,
        ..MultiPositionSettings::default()
    };
    let report = multi_position_test(&positions, &settings).unwrap();
    // The term is 250 / (50 / sqrt(38 / 3)), 18 sigmas.
    let [finding] = &report.findings[..] else {
        panic!("{:?}", report.findings);
    };
    assert_eq!((finding.gyro, finding.term), (0, Term::Cross(2)));
    assert!(finding.p_value <= 1e-10, "{finding:?}");
}

/// The answer does not depend on which axis is called x.
#[test]
fn renamed_axes_have_the_same_terms_under_their_new_names() {
    let law = |gyro: usize, force: [f64; 3]| {
        let term = if gyro == 1 { 300.0 * force[2] } else { 0.0 };
        nominal(gyro, force) + term
    };
    let positions = positions(3, 30, law);
    let rename = |values: &[[f64; 3]]| -> Vec<[f64; 3]> {
        values.iter().map(|[x, y, z]| [*z, *x, *y]).collect()
    };
    let renamed = Positions {
        rate_deg_per_h: rename(&positions.rate_deg_per_h),
        force_g: rename(&positions.force_g),
        ..positions.clone()
    };
    let [before, after] = [tested(&positions), tested(&renamed)].map(|report| report.findings);
    assert_eq!((before.len(), after.len()), (1, 1));
    assert_eq!(
        (&*before[0].effect, &*after[0].effect),
        ("gyro_y.g_z", "gyro_z.g_x")
    );
    // The order of sums over gyros and terms.
    assert!((before[0].estimate / after[0].estimate - 1.0).abs() < 1e-9);
    assert!((before[0].sigma / after[0].sigma - 1.0).abs() < 1e-6);
}

#[test]
fn what_is_there_is_found_with_its_size_and_its_sigma() {
    let law = |gyro: usize, force: [f64; 3]| {
        let [x, y, z] = force;
        nominal(gyro, force)
            + match gyro {
                0 => 250.0 * z,
                1 => -300.0 * x * z,
                _ => 280.0 * y,
            }
    };
    let truth = [
        ("gyro_x.g_z", 250.0),
        ("gyro_y.g_xz", -300.0),
        ("gyro_z.g_y", 280.0),
    ];
    for seed in 0..5 {
        let report = tested(&positions(seed, 40, law));
        let mut found: Vec<&str> = report.findings.iter().map(|f| &*f.effect).collect();
        found.sort_unstable();
        assert_eq!(found, truth.map(|(name, _)| name), "seed {seed}");
        for finding in &report.findings {
            let (_, size) = truth
                .iter()
                .find(|(name, _)| *name == finding.effect)
                .unwrap();
            // Fifteen estimates: the largest of as many normal deviates is below 4 with 99.9 %.
            assert!(
                ((finding.estimate - size) / finding.sigma).abs() < 4.0,
                "{finding:?}"
            );
            assert!(finding.alternatives.is_empty(), "{finding:?}");
        }
        let gain = report.cross_validation.unwrap();
        assert!(gain.cross_validated_log_score_nats > 3.0 * gain.standard_error_nats);
    }
}

#[test]
fn terms_that_the_attitudes_do_not_distinguish_are_alternatives() {
    // Along the meridian x = 0.6 y, x and y can only be told by what is off it.
    let mut noise = Noise::of_seed(5);
    let mut made = positions(5, 40, nominal);
    for (force, rate) in made.force_g.iter_mut().zip(&mut made.rate_deg_per_h) {
        let angle = core::f64::consts::TAU * noise.uniform();
        let off = 0.01 * noise.normal();
        let vector = Vector3::new(0.5 * angle.cos() + off, 0.85 * angle.cos(), angle.sin());
        *force = vector.normalize().into();
        *rate = core::array::from_fn(|gyro| nominal(gyro, *force) + 50.0 * noise.normal());
        rate[2] += 300.0 * force[0];
    }
    let report = tested(&made);
    let [finding] = &report.findings[..] else {
        panic!("{:?}", report.findings);
    };
    let mut names: Vec<&str> = finding
        .alternatives
        .iter()
        .map(|other| &*other.effect)
        .collect();
    names.push(&finding.effect);
    assert!(
        names.contains(&"gyro_z.g_x") && names.contains(&"gyro_z.g_y"),
        "{names:?}"
    );
}

#[test]
fn squares_along_the_two_other_axes_are_one_term() {
    assert_eq!(Term::Product(1, 1).id(0), "gyro_x.g_yy");
    assert_eq!(Term::Product(1, 1).equivalents(0), ["gyro_x.g_zz"]);
    assert_eq!(Term::Product(0, 0).equivalents(2), ["gyro_z.g_yy"]);
    let named: Vec<&str> = Term::catalogue(2).iter().map(|term| term.id(2)).collect();
    let expected = [
        "g_x", "g_y", "g_xy", "g_xz", "g_yz", "g_xx", "g_zzz", "ramp",
    ];
    assert_eq!(named, expected.map(|term| format!("gyro_z.{term}")));
}

#[test]
fn a_bias_that_differs_between_logs_is_told_and_is_no_ramp() {
    const CHANGE_DEG_PER_H: f64 = 400.0;
    let two_logs = |seed: u64, change: f64| {
        let mut positions = positions(seed, 40, nominal);
        positions.log = (0..40).map(|stop| stop / 20).collect();
        let later = positions.rate_deg_per_h.iter_mut().skip(20);
        later.for_each(|rate| rate[2] += change);
        tested(&positions)
    };
    let told = two_logs(5, CHANGE_DEG_PER_H);
    let [found] = &told.log_biases[..] else {
        panic!("{:?}", told.log_biases)
    };
    assert_eq!(found.gyro, "gyro_z");
    let error = found.differences_deg_per_h[0] - CHANGE_DEG_PER_H;
    assert!(error.abs() < 4.0 * found.sigmas_deg_per_h[0], "{found:?}");
    // Without that the change would be a ramp.
    assert!(told.findings.is_empty(), "{:?}", told.findings);
    // One unit: 0.6 alarms are expected in 60 tests at 1 %, more than four have a chance of 4e-4.
    let alarms = (0..60).filter(|seed| !two_logs(100 + seed, 0.0).log_biases.is_empty());
    assert!(alarms.count() <= 4);
}

#[test]
fn earth_rate_is_taken_off_where_latitude_is_known() {
    // Stops at latitude 60 deg, in random headings, of gyros without any drift.
    const EARTH_DEG_PER_H: f64 = 15.041_07;
    let (sine, cosine) = 60.0_f64.to_radians().sin_cos();
    let mut noise = Noise::of_seed(8);
    let stop = |_| {
        let up = noise.vector().normalize();
        let north = noise.vector().cross(&up).normalize();
        let earth = EARTH_DEG_PER_H * (up * sine + north * cosine);
        gyrocal_instruments::StopMeans {
            samples: 0..1,
            from_s: 0.0,
            to_s: 0.0,
            time_s: 0.0,
            gyro: earth.into(),
            gyro_sigma: [0.1; 3],
            gyro_quantisation: [0.0; 3],
            gyro_parts: Vec::new(),
            accel: up.into(),
            accel_sigma: [1e-5; 3],
        }
    };
    let stops: Vec<gyrocal_instruments::StopMeans> = (0..200).map(stop).collect();
    let instrument = |latitude_deg| gyrocal_instruments::multi_position::Instrument {
        accel: None,
        outputs_per_rad_per_s: [1.0_f64.to_degrees() * 3600.0; 3],
        latitude_deg,
    };
    let along = |latitude_deg| {
        let positions = Positions::new(&stops, &instrument(latitude_deg));
        let report = tested(&positions);
        let coefficient = report.gyros[0].extended.coefficients[1].clone();
        (coefficient.estimate, coefficient.sigma)
    };
    let (with, sigma) = along(Some(60.0));
    // Horizontal Earth rate in random headings is the only noise, and its sigma says so.
    assert!(with.abs() < 4.0 * sigma && sigma < 1.0, "{with} {sigma}");
    let (without, sigma) = along(None);
    assert!(
        (without - EARTH_DEG_PER_H * sine).abs() < 4.0 * sigma,
        "{without} {sigma}"
    );
}

fn description(unit: &str) -> Description {
    let text = format!(
        "[time]\nrate_hz = 100\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"{unit}\"\n\
         counts_per_rad_per_s = \"from-turns\"\n[accel]\ncolumns = [\"d\", \"e\", \"f\"]\n\
         unit = \"g\"\n"
    );
    Description::parse(&text, "log.toml").unwrap()
}

fn prepared(log: &Log) -> Result<PreparedTest, InstrumentError> {
    let stops = find_stops(log, &StopSettings::default())?;
    prepare(log, &description("rad/s"), &stops)
}

#[test]
fn stops_scales_and_misalignments_are_found_in_a_log() {
    let mut unit = Unit::mems();
    unit.gyro_matrix = Matrix3::new(5000.0, 30.0, -20.0, 10.0, 4800.0, 50.0, 0.0, -40.0, 5100.0);
    unit.gyro_zero *= 5000.0;
    unit.gyro_noise *= 5000.0;
    let mut log = stops_and_turns(24, &unit, 11);
    log.gyro_in_counts = true;
    let stops = find_stops(&log, &StopSettings::default()).unwrap();
    assert_eq!(stops.len(), 24);
    for (number, stop) in stops.iter().enumerate() {
        // Five seconds from every seventh; turns start and end slowly, for a fifth of a second
        // with less than the noise, and half a second is left out at both ends.
        let start = 700 * number;
        assert!(
            stop.start + 20 >= start + 50 && stop.end <= start + 450 + 20,
            "{stop:?}"
        );
        assert!(stop.len() > 350, "{stop:?}");
    }
    let found = prepare(&log, &description("counts"), &stops)
        .unwrap()
        .turns
        .unwrap();
    for gyro in 0..3 {
        let row = unit.gyro_matrix.row(gyro).norm();
        // Half a percent: noise of 0.006 rad/s over turns of two radians leaves 1e-3.
        assert!(
            (found.outputs_per_rad_per_s[gyro] / row - 1.0).abs() < 5e-3,
            "{found:?}"
        );
        let angle = (unit.gyro_matrix[(gyro, gyro)] / row).acos();
        assert!(
            (found.misalignment_rad[gyro] - angle).abs() < 3e-3,
            "{found:?}"
        );
    }
    let inverse = unit.gyro_matrix.try_inverse().unwrap();
    for row in 0..3 {
        for column in 0..3 {
            let error = found.matrix[row][column] - inverse[(row, column)];
            // Nine estimates: the largest is below 4 sigma with 99.9 %.
            assert!(
                error.abs() < 4.0 * found.sigma[row][column],
                "{row} {column}"
            );
        }
    }
}

#[test]
fn accelerometers_are_calibrated_by_the_norm() {
    let mut log = stops_and_turns(24, &Unit::mems(), 12);
    let stops = stop_means(&log, &find_stops(&log, &StopSettings::default()).unwrap()).unwrap();
    let truth: Vec<[f64; 3]> = stops.iter().map(|stop| stop.accel).collect();
    for force in log.accel.as_mut().unwrap() {
        let [x, y, z] = *force;
        *force = [
            4000.0 * x + 20.0 * y + 100.0,
            4100.0 * y - 200.0,
            3900.0 * z + 10.0 * x,
        ];
    }
    log.accel_in_counts = true;
    let stops = stop_means(&log, &find_stops(&log, &StopSettings::default()).unwrap()).unwrap();
    let calibration = accel_from_norm(&stops).unwrap();
    // z to x cannot be told from a turn of all axes, so only norms and angles must agree.
    let forces: Vec<Vector3<f64>> = stops
        .iter()
        .map(|stop| calibration.force_g(stop.accel).into())
        .collect();
    for (a, true_a) in forces.iter().zip(&truth) {
        for (b, true_b) in forces.iter().zip(&truth) {
            let expected = Vector3::from(*true_a).dot(&Vector3::from(*true_b));
            // Means of 400 samples of 1e-3 g, nine unknowns from 24 stops.
            assert!((a.dot(b) - expected).abs() < 1e-3);
        }
    }
}

#[test]
fn standard_errors_hold_for_coloured_noise() {
    // First-order noise with a time constant of ten samples: means scatter √19 times more than
    // white noise of the same variance would make them.
    let mut noise = Noise::of_seed(4);
    let mut state = Vector3::zeros();
    let samples: Vec<_> = (0..60_000)
        .map(|_| {
            state = 0.9 * state + (1.0_f64 - 0.81).sqrt() * noise.vector();
            (state, Vector3::z())
        })
        .collect();
    let log = crate::common::log(0.01, &samples);
    let ranges: Vec<_> = (0..60)
        .map(|stop| 1000 * stop..1000 * stop + 1000)
        .collect();
    let stops = stop_means(&log, &ranges).unwrap();
    for axis in 0..3 {
        let squares = stops
            .iter()
            .map(|stop| (stop.gyro[axis] / stop.gyro_sigma[axis]).powi(2));
        let mean = squares.sum::<f64>() / 60.0;
        // Chi-square of 60 degrees of freedom: 0.54 to 1.66 holds 99.9 %; blocks of a second see
        // nine tenths of the inflation.
        assert!((0.54..1.85).contains(&mean), "{mean}");
    }
}

#[test]
fn logs_that_are_not_what_they_are_said_to_be_are_refused() {
    let good = stops_and_turns(24, &Unit::mems(), 13);
    assert!(prepared(&good).is_ok());
    let changed = |change: &dyn Fn(&mut [f64; 3], &mut [f64; 3])| {
        let mut log = good.clone();
        for (gyro, accel) in log.gyro.iter_mut().zip(log.accel.as_mut().unwrap()) {
            change(gyro, accel);
        }
        prepared(&log).unwrap_err()
    };
    let scaled = |values: &mut [f64; 3], factor: f64| values.iter_mut().for_each(|v| *v *= factor);
    let says = |error: &InstrumentError, kind: Unfit, words: &str| {
        assert_eq!(error.kind(), Some(kind), "{error}");
        assert!(error.to_string().contains(words), "{error}");
    };
    says(
        &changed(&|_, accel| scaled(accel, 9.81)),
        Unfit::Norm,
        "m/s^2",
    );
    says(
        &changed(&|gyro, _| scaled(gyro, 57.3)),
        Unfit::GyroScale,
        "deg/s",
    );
    says(
        &changed(&|gyro, _| scaled(gyro, 1.3)),
        Unfit::GyroScale,
        "turns between stops",
    );
    let flipped = |gyro: &mut [f64; 3], accel: &mut [f64; 3]| {
        (gyro[1], accel[1]) = (-gyro[1], -accel[1]);
    };
    says(&changed(&flipped), Unfit::Axes, "left-handed");
    says(
        &changed(&|gyro, _| gyro[2] = -gyro[2]),
        Unfit::Axes,
        "x, y, -z",
    );
}

#[test]
fn a_log_that_never_rests_is_refused() {
    let mut noise = Noise::of_seed(6);
    let samples: Vec<_> = (0..6000)
        .map(|sample| {
            let angle = sample as f64 / 70.0;
            let rate = Vector3::new(angle.sin(), (1.3 * angle).cos(), (0.7 * angle).sin());
            (
                rate + 0.006 * noise.vector(),
                Vector3::new(angle.sin(), 0.0, angle.cos()),
            )
        })
        .collect();
    let error = find_stops(
        &crate::common::log(0.01, &samples),
        &StopSettings::default(),
    )
    .unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::NeverStatic), "{error}");
}

#[test]
fn stops_can_be_given() {
    let log = stops_and_turns(3, &Unit::mems(), 14);
    assert_eq!(given_stops(&log, &[[0.5, 4.5]]).unwrap()[0], 49..449);
    let outside = given_stops(&log, &[[100.0, 105.0]]).unwrap_err();
    assert_eq!(outside.kind(), Some(Unfit::Setting));
}
