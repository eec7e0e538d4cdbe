//! Tests of two, six and twelve positions, and of stops in the hand, on logs whose errors are known.

use gyrocal_instruments::multi_position::{
    MultiPositionReport, MultiPositionSettings, Positions, PreparedTest, multi_position_test,
    prepare_logs,
};
use gyrocal_instruments::{Description, InstrumentError, Log, StopSettings, Unfit, find_stops};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::{
    Samples, UnitErrors, hand_held, positions, stop, vector,
};
use nalgebra::{Matrix3, Vector3};

const PER_DEG_PER_H: f64 = 4.848_136_811_095_36e-6;

fn unit() -> UnitErrors {
    UnitErrors {
        gyro_bias: PER_DEG_PER_H * Vector3::new(2000.0, -800.0, 300.0),
        gyro_g: PER_DEG_PER_H * Matrix3::from_diagonal(&Vector3::new(30.0, -20.0, 10.0)),
        gyro_gg: Vector3::zeros(),
        accel_bias: Vector3::new(0.01, -0.005, 0.003),
        accel_matrix: Matrix3::new(1.004, 0.002, -0.001, 0.0, 0.997, 0.003, 0.0, 0.0, 1.001),
        gyro_noise: 1e-3,
        accel_noise: 1e-3,
    }
}

fn log(samples: &Samples) -> Log {
    Log::from_samples(0.01, samples.gyro.clone(), samples.accel.clone())
}

fn description() -> Description {
    let text = "[time]\nrate_hz = 100\n[gyro]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"rad/s\"\n\
                [accel]\ncolumns = [\"d\", \"e\", \"f\"]\nunit = \"g\"\n";
    Description::parse(text, "log.toml").unwrap()
}

fn tested(positions: &Positions) -> Result<MultiPositionReport, InstrumentError> {
    multi_position_test(positions, &MultiPositionSettings::default())
}

/// One log for each position.
fn prepared(unit: &UnitErrors, forces: &[Vector3<f64>], draw: &mut Draw) -> PreparedTest {
    let logs: Vec<_> = forces
        .iter()
        .map(|force| {
            let samples = stop(unit, *force, 6000, [0.0; 2], draw);
            (log(&samples), samples.stops)
        })
        .collect();
    prepare_logs(&logs, &description()).unwrap()
}

#[test]
fn twelve_positions_determine_all_errors_of_the_accelerometers() {
    let mut draw = Draw::new(1, 1);
    let forces = positions(12, &mut draw);
    let test = prepared(&unit(), &forces, &mut draw);
    let errors = test.accel_errors.unwrap();
    let truth = [
        0.01, -0.005, 0.003, 0.004, -0.003, 0.001, 0.002, -0.001, 0.003,
    ];
    for (index, (coefficient, truth)) in errors.coefficients.iter().zip(truth).enumerate() {
        // The matrix multiplies scale and input axis: their product differs by 1e-5.
        let difference = (coefficient.estimate - truth).abs();
        assert!(coefficient.determined, "{coefficient:?}");
        // The largest of nine normal deviates is below 4 with 99.9 %.
        assert!(
            difference < 4.0 * coefficient.sigma + 1e-5,
            "{coefficient:?} {truth}"
        );
        assert!((errors.covariance[index][index].sqrt() / coefficient.sigma - 1.0).abs() < 1e-12);
    }
    assert_eq!(errors.degrees_of_freedom, 3);
}

#[test]
fn six_positions_leave_misalignments_open_and_say_so() {
    let mut draw = Draw::new(2, 1);
    let forces = positions(6, &mut draw);
    let test = prepared(&unit(), &forces, &mut draw);
    let errors = test.accel_errors.clone().unwrap();
    let open = errors.coefficients.iter().filter(|c| !c.determined);
    let open: Vec<&str> = open.map(|c| &*c.name).collect();
    assert!(
        open.iter().all(|name| name.contains("misalignment")),
        "{open:?}"
    );
    assert!(open.len() >= 2, "{open:?}");
    let report = tested(&test.positions).unwrap();
    assert!(report.findings.is_empty(), "{:?}", report.findings);
    for (gyro, [bias, along]) in
        report
            .gyros
            .iter()
            .zip([[2000.0, 30.0], [-800.0, -20.0], [300.0, 10.0]])
    {
        let [first, second, third] = &gyro.extended.coefficients[..] else {
            panic!("{gyro:?}");
        };
        for (coefficient, truth) in [(first, bias), (second, along), (third, 0.0)] {
            let error = coefficient.estimate - truth;
            assert!(
                error.abs() < 4.0 * coefficient.sigma,
                "{coefficient:?} {truth}"
            );
        }
        assert_eq!(gyro.extended.degrees_of_freedom, 3);
        let undetermined = &gyro.undetermined;
        assert!(
            undetermined.iter().any(|name| name.ends_with("xxx")
                || name.ends_with("yyy")
                || name.ends_with("zzz")),
            "{undetermined:?}"
        );
    }
}

#[test]
fn a_term_across_is_named_in_six_positions() {
    let mut unit = unit();
    // Standard error of a stop 0.001 / √6000 rad/s, 2.7 deg/h, so that 60 deg/h/g is 32 sigmas: of two degrees of
    // freedom a gyro, all three tell the scatter of the stops.
    unit.gyro_g[(0, 2)] = 60.0 * PER_DEG_PER_H;
    let mut draw = Draw::new(3, 1);
    let forces = positions(6, &mut draw);
    let test = prepared(&unit, &forces, &mut draw);
    let report = tested(&test.positions).unwrap();
    let [finding] = &report.findings[..] else {
        panic!("{:?}", report.findings);
    };
    assert_eq!(finding.effect, "gyro_x.g_z");
    assert!(
        (finding.estimate - 60.0).abs() < 4.0 * finding.sigma,
        "{finding:?}"
    );
}

/// Logs of six positions with a turn-on of its own each: the bias of a log has a spread of 100 deg/h, 37 times the
/// standard error of a stop.
#[test]
fn turn_ons_of_six_logs_are_no_terms() {
    let forces = |draw: &mut Draw| positions(6, draw);
    let mut within = 0;
    for seed in 0..20 {
        let mut draw = Draw::new(seed, 5);
        let forces = forces(&mut draw);
        let logs: Vec<_> = forces
            .iter()
            .map(|force| {
                let mut unit = unit();
                unit.gyro_bias += 100.0 * PER_DEG_PER_H * vector(&mut draw);
                let samples = stop(&unit, *force, 1000, [0.0; 2], &mut draw);
                (log(&samples), samples.stops)
            })
            .collect();
        let test = prepare_logs(&logs, &description()).unwrap();
        let report = tested(&test.positions).unwrap();
        assert!(report.findings.is_empty(), "{seed}: {:?}", report.findings);
        let along = &report.gyros[0].extended.coefficients[1];
        within += u32::from((along.estimate - 30.0).abs() < 1.96 * along.sigma);
    }
    // Nineteen of twenty are expected; sixteen and less have a chance of 1.6 %.
    assert!(within >= 16, "{within}");
}

/// Stops of unequal length in one log, with biases that walk by ten standard errors from stop to stop.
#[test]
fn stops_of_unequal_length_are_evaluated() {
    let seconds = [60, 20, 20, 90, 20, 30, 20, 40];
    let mut found = 0;
    for seed in 0..10 {
        let mut draw = Draw::new(seed, 6);
        let forces = positions(8, &mut draw);
        let mut unit = unit();
        let mut samples = Samples::default();
        for (force, seconds) in forces.iter().zip(seconds) {
            unit.gyro_bias += 40.0 * PER_DEG_PER_H * vector(&mut draw);
            let stop = stop(&unit, *force, seconds * 100, [0.0; 2], &mut draw);
            let from = samples.gyro.len();
            samples.gyro.extend(stop.gyro);
            samples.accel.extend(stop.accel);
            samples.stops.push(from..samples.gyro.len());
        }
        let test = prepare_logs(&[(log(&samples), samples.stops)], &description()).unwrap();
        let report = tested(&test.positions).unwrap();
        found += report.findings.len();
    }
    assert_eq!(found, 0);
}

/// Three logs of three stops each, turned on between.
#[test]
fn logs_of_several_stops_have_each_a_bias() {
    let mut within = 0;
    for seed in 0..10 {
        let mut draw = Draw::new(seed, 7);
        let forces = positions(9, &mut draw);
        let order = [0, 2, 4, 1, 6, 8, 3, 5, 7];
        let logs: Vec<_> = order
            .chunks(3)
            .map(|stops| {
                let mut unit = unit();
                unit.gyro_bias += 200.0 * PER_DEG_PER_H * vector(&mut draw);
                let mut samples = Samples::default();
                for place in stops {
                    let stop = stop(&unit, forces[*place], 2000, [0.0; 2], &mut draw);
                    let from = samples.gyro.len();
                    samples.gyro.extend(stop.gyro);
                    samples.accel.extend(stop.accel);
                    samples.stops.push(from..samples.gyro.len());
                }
                (log(&samples), samples.stops)
            })
            .collect();
        let test = prepare_logs(&logs, &description()).unwrap();
        let report = tested(&test.positions).unwrap();
        assert_eq!(report.biases_of_further_logs, 2);
        // Turn-ons of 200 deg/h, 30 times the standard error of a stop, are told of some gyro at least.
        assert!(!report.log_biases.is_empty());
        assert_eq!(report.gyros[0].extended.degrees_of_freedom, 9 - 3 - 2);
        assert!(report.findings.is_empty(), "{:?}", report.findings);
        // White noise alone is left, which the law explains.
        assert!(
            report
                .gyros
                .iter()
                .all(|gyro| gyro.extended.p_value.unwrap() > 1e-4)
        );
        let along = &report.gyros[0].extended.coefficients[1];
        within += u32::from((along.estimate - 30.0).abs() < 1.96 * along.sigma);
    }
    assert!(within >= 8, "{within}");
}

#[test]
fn a_gyro_without_noise_is_told() {
    let mut still = unit();
    still.gyro_noise = 0.0;
    let mut draw = Draw::new(1, 8);
    let forces = positions(6, &mut draw);
    let test = prepared(&still, &forces, &mut draw);
    let error = tested(&test.positions).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::Saturated), "{error}");
}

#[test]
fn two_positions_determine_what_changes_between_them() {
    let mut draw = Draw::new(4, 1);
    let forces = [Vector3::z(), -Vector3::z()];
    let test = prepared(&unit(), &forces, &mut draw);
    let report = tested(&test.positions).unwrap();
    let names = |gyro: usize| -> Vec<&str> {
        report.gyros[gyro]
            .extended
            .coefficients
            .iter()
            .map(|c| &*c.name)
            .collect()
    };
    assert_eq!(names(0)[0], "gyro_x.bias");
    assert_eq!(names(2), ["gyro_z.bias", "gyro_z.g_z"]);
    assert!(
        report.gyros[2]
            .undetermined
            .contains(&"gyro_z.g_zz".to_owned())
    );
    let errors = test.accel_errors.unwrap();
    let determined = errors.coefficients.iter().filter(|c| c.determined);
    let determined: Vec<&str> = determined.map(|c| &*c.name).collect();
    assert_eq!(determined, ["accel_z.bias", "accel_z.scale"]);
    // Nothing is left to tell the noise between stops.
    assert!(!report.tells_noise());
    // Without a turn there is nothing to determine.
    let same = prepared(&unit(), &[Vector3::z(), Vector3::z()], &mut draw);
    let error = tested(&same.positions).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::Undetermined), "{error}");
}

#[test]
fn stops_in_the_hand_are_found() {
    for seed in 0..5 {
        let mut draw = Draw::new(seed, 2);
        let mut unit = unit();
        unit.gyro_bias = Vector3::new(0.02, -0.01, 0.015);
        // Tremor of 1 deg/s rms about each axis, and a noise below it.
        let samples = hand_held(&unit, 12, 100.0, 0.017, &mut draw);
        let found = find_stops(&log(&samples), &StopSettings::default()).unwrap();
        assert_eq!(
            found.len(),
            samples.stops.len(),
            "{seed}: {found:?} {:?}",
            samples.stops
        );
        for (found, truth) in found.iter().zip(&samples.stops) {
            // Half a second is left out at both ends, and turns begin and end slowly.
            assert!(
                found.start + 30 >= truth.start && found.end <= truth.end + 30,
                "{seed}"
            );
            assert!(
                2 * found.len() > truth.len() - 100,
                "{seed}: {found:?} {truth:?}"
            );
        }
    }
}
