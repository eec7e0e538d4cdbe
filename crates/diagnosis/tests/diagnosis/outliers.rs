//! Gross errors in rows that the noise audit cannot test.

use gyrocal_answer::{FindingKind, Verdict};
use gyrocal_diagnosis::{DiagnoseOptions, OpenLoopSimulation, diagnose};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, Simulation, simulate};

fn simulation(hidden: &[Hidden]) -> Simulation {
    simulate(&Scenario {
        seed: 5,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        interval_s: 120.0,
        duration_s: 2.0 * 86_400.0,
        hidden: hidden.to_vec(),
        ..Scenario::default()
    })
    .unwrap()
}

/// A hundred and ten thousand sigmas: no fit converges with the second.
#[test]
fn an_outlier_is_found_wherever_it_stands() {
    let sound = simulation(&[]);
    for (row, size_g) in [
        (0, 1e-3),
        (8, 1e-3),
        (30, 1e-3),
        (700, 1e-3),
        (8, 0.1),
        (700, 0.1),
        (1440, 0.1),
    ] {
        let mut record = sound.record.clone();
        record.accel_g[row][2] += size_g;
        let found = diagnose(&record, &sound.bench, &DiagnoseOptions::default()).unwrap();
        let case = format!("row {row}, {size_g} g");
        let result = &found.result;
        assert_eq!(result.verdict, Verdict::EffectsFound, "{case}");
        let names: Vec<&str> = result.findings.iter().map(|f| f.effect.as_str()).collect();
        assert_eq!(names, ["accel.outliers"], "{case}");
        assert_eq!(result.findings[0].kind, FindingKind::Noise);
        assert_eq!(result.findings[0].coverage, None);
        let [only] = found.audit.outliers.as_slice() else {
            panic!("{case}: {:?}", found.audit.outliers)
        };
        assert_eq!((only.row, only.axis), (row, 2));
        // A hundredth is noise; an hour after the start the filter is still settling, too.
        assert!((only.size_g / size_g - 1.0).abs() < 0.1, "{case}: {only:?}");
        // It is none of the other things that are said.
        assert!(!result.norm.as_ref().unwrap().accelerometers, "{case}");
        assert!(!result.is_unexplained(), "{case}");
    }
}

/// Fault-free values deviate from the nominal model with a large hidden term, and not from the model
/// that includes it.
#[test]
fn what_a_cause_explains_is_no_outlier() {
    let term = Hidden::new("gyro_x.g_y", &[("size", 0.05)]).unwrap();
    let simulation = simulation(&[term]);
    let found = diagnose(
        &simulation.record,
        &simulation.bench,
        &DiagnoseOptions::default(),
    );
    let found = found.unwrap();
    assert_eq!(found.result.findings[0].effect, "gyro_x.g_y");
    assert!(
        found.audit.outliers.is_empty(),
        "{:?}",
        found.audit.outliers
    );
}

/// An outlier, a missing value and a cause: the errors of the axes are of the same values as those before and after.
#[test]
fn open_loop_errors_are_of_the_values_that_the_audit_leaves() {
    let term = Hidden::new("gyro_x.g_y", &[("size", 0.05)]).unwrap();
    let Simulation {
        mut record, bench, ..
    } = simulation(&[term]);
    record.accel_g[700][2] += 0.1;
    record.accel_g[300][0] = f64::NAN;
    let found = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    let nominal = OpenLoopSimulation::new(&found.nominal, &record).unwrap();
    // A gross error takes its row with it.
    assert_eq!(nominal.left_out, 3);
    let shown = found.result.residuals.as_ref().unwrap();
    assert_eq!(shown.free_run_rms_g, nominal.axis_rms_g);
    let before = found.result.gain.as_ref().unwrap().free_run_rms_g;
    assert_eq!(before.unwrap().before, nominal.rms_g);
    let squares = nominal.axis_rms_g.map(|rms_g| rms_g * rms_g);
    let of_axes = (squares.iter().sum::<f64>() / 3.0).sqrt();
    // Three sums in another order.
    assert!((of_axes / nominal.rms_g - 1.0).abs() < 1e-14);
    let sound = nominal.residuals_g[2].iter().enumerate();
    let sound = sound.filter(|(row, _)| *row != 700);
    let squares: f64 = sound.map(|(_, residual_g)| residual_g * residual_g).sum();
    let of_axis = (squares / (record.len() - 1) as f64).sqrt();
    assert_eq!(nominal.axis_rms_g[2], of_axis);
}

/// A warm-up that turns the platform by a third of a degree in the first hour: the filter without it is led
/// astray, so that no fit converges from its trajectory, and its innovations jump where no reading does.
#[test]
fn a_quick_warm_up_is_neither_hopeless_nor_an_outlier() {
    let parameters = [("size", 0.434), ("time_constant_h", 0.717)];
    let warm_up = Hidden::new("gyro_x.warmup", &parameters).unwrap();
    let simulation = simulate(&Scenario {
        seed: 1,
        latitude_deg: -7.6,
        coefficients: Coefficients {
            bias_deg_per_h: [-0.5516, -0.8654, 0.4793],
            g_deg_per_h_per_g: [-0.26, -0.2441, -0.0553],
            gg_deg_per_h_per_g2: [0.0793, 0.0127, 0.0452],
        },
        initial: InitialAttitude::AnglesDeg([-33.6, 18.7, -87.0]),
        interval_s: 240.0,
        duration_s: 213_360.0,
        gaps_s: vec![[14_160.0, 37_680.0], [119_760.0, 125_040.0]],
        hidden: vec![warm_up],
        ..Scenario::default()
    })
    .unwrap();
    let options = DiagnoseOptions::default();
    let result = diagnose(&simulation.record, &simulation.bench, &options)
        .unwrap()
        .result;
    let names: Vec<&str> = result.findings.iter().map(|f| f.effect.as_str()).collect();
    assert_eq!(names, ["gyro_x.warmup"]);
    for (found, (name, truth)) in result.findings[0].parameters.iter().zip(parameters) {
        assert_eq!(found.name, name);
        // One in sixteen thousand is farther off than four sigmas.
        let off = (found.estimate - truth).abs();
        assert!(off < 4.0 * found.sigma.unwrap(), "{name}: {found:?}");
    }
}
