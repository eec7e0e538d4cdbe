//! One model fitted to several records, against other computations.

use gyrocal::Discretisation;
use gyrocal_calibration::{
    CalibrationError, FittedPlatform, NoiseModel, Options, Run, calibrate_runs, joined_record,
};
use gyrocal_hypothesis::{Column, FittedModel, ModelExtension};
use gyrocal_record::{Bench, Prior};
use gyrocal_testkit::dense_least_squares::DenseProblem;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};
use nalgebra::{DMatrix, DVector};

const COEFFICIENTS: usize = 9;

fn simulation(seed: u64, rows: usize, interval_s: f64) -> Simulation {
    of_platform(Coefficients::PAPER_LIKE, seed, rows, interval_s)
}

fn of_platform(coefficients: Coefficients, seed: u64, rows: usize, interval_s: f64) -> Simulation {
    simulate(&Scenario {
        seed,
        coefficients,
        initial: InitialAttitude::Random,
        interval_s,
        duration_s: (rows - 1) as f64 * interval_s,
        start_s: 1_000.0 * seed as f64,
        ..Scenario::default()
    })
    .unwrap()
}

fn options() -> Options {
    Options {
        discretisation: Discretisation {
            longest_step_s: 30.0,
            ..Discretisation::default()
        },
        ..Options::default()
    }
}

fn single(simulation: &Simulation) -> FittedPlatform<'_> {
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    FittedPlatform::nominal(&run, &options(), &NoiseModel::default()).unwrap()
}

fn joined(simulations: &[Simulation]) -> Result<FittedPlatform<'_>, CalibrationError> {
    let parts: Vec<_> = simulations.iter().map(single).collect();
    let benches: Vec<&Bench> = simulations.iter().map(|one| &one.bench).collect();
    FittedPlatform::joined(&parts, &benches)
}

/// The Gram matrices add: the information of two records, less the prior that each solution holds once too
/// often, is the sum of those of least squares on dense matrices.
#[test]
fn the_information_of_two_records_is_the_sum_of_dense_ones() {
    // Without drift: what is estimated is small, and the problems are linear in it.
    let mut simulations = [1, 2].map(|seed| of_platform(Coefficients::default(), seed, 40, 30.0));
    for one in &mut simulations {
        one.bench.prior = Prior {
            bias_sigma_deg_per_h: [0.02; 3],
            g_sigma_deg_per_h_per_g: [0.02; 3],
            gg_sigma_deg_per_h_per_g2: [0.02; 3],
            ..one.bench.prior
        };
    }
    let fit = joined(&simulations).unwrap();
    let prior = DMatrix::from_diagonal(&DVector::from_iterator(
        COEFFICIENTS,
        fit.prior_sigma().into_iter().map(|sigma| sigma.powi(-2)),
    ));
    let mut information = -prior;
    let mut gradient = DVector::zeros(COEFFICIENTS);
    for one in &simulations {
        let run = Run {
            record: &one.record,
            bench: &one.bench,
        };
        let dense = DenseProblem::new(run, 30.0).solve();
        let own = dense.covariance.view((0, 0), (COEFFICIENTS, COEFFICIENTS));
        let own = own.into_owned().try_inverse().unwrap();
        gradient += &own * DVector::from_row_slice(&dense.drift);
        information += own;
    }
    let expected = information.try_inverse().unwrap();
    let values = &expected * gradient;
    for i in 0..COEFFICIENTS {
        let sigma = expected[(i, i)].sqrt();
        // Both are linearised, about estimates 0.02 deg/h apart: a part in ten thousand of a platform that
        // turns by 15 deg/h.
        let off = (fit.values()[i] - values[i]) / sigma;
        assert!(off.abs() < 1e-3, "{i}: {off}");
        for j in 0..COEFFICIENTS {
            let scale = sigma * expected[(j, j)].sqrt();
            let off = (fit.covariance()[(i, j)] - expected[(i, j)]) / scale;
            assert!(off.abs() < 1e-3, "{i}, {j}: {off}");
        }
    }
}

#[test]
fn the_joint_fit_is_that_of_calibration_with_and_without_turn_ons() {
    for turn_on_sigma in [0.0, 0.01] {
        let mut simulations = [simulation(3, 300, 300.0), simulation(4, 200, 300.0)];
        for one in &mut simulations {
            one.bench.prior.turn_on_sigma_deg_per_h = [turn_on_sigma; 3];
        }
        let fit = joined(&simulations).unwrap();
        let runs = [0, 1].map(|index: usize| Run {
            record: &simulations[index].record,
            bench: &simulations[index].bench,
        });
        let expected = calibrate_runs(&runs, &options(), |_| ()).unwrap();
        for (i, drift) in expected.drift.to_array().into_iter().enumerate() {
            let sigma = expected.covariance[i][i].sqrt();
            // Steps end at a ten-thousandth of a sigma.
            assert!((fit.values()[i] - drift).abs() < 1e-3 * sigma, "{i}");
            assert!(
                (fit.covariance()[(i, i)].sqrt() / sigma - 1.0).abs() < 1e-3,
                "{i}"
            );
        }
        let offsets = fit.turn_ons_deg_per_h();
        for (run, expected) in expected.runs.iter().enumerate() {
            match expected.turn_on_deg_per_h {
                None => assert!(offsets.is_empty()),
                Some(expected) => {
                    for ([found, _], [offset, sigma]) in offsets[run].iter().zip(expected) {
                        assert!((found - offset).abs() < 1e-3 * sigma);
                    }
                }
            }
        }
        // With the offsets eliminated, the Gram matrix of the values is the inverse of their covariance.
        let gram = fit.conditional_gram(&[]).unwrap();
        let mut information = gram.view((1, 1), (COEFFICIENTS, COEFFICIENTS)).into_owned();
        for (i, sigma) in fit.prior_sigma().into_iter().enumerate() {
            information[(i, i)] += sigma.powi(-2);
        }
        let covariance = information.try_inverse().unwrap();
        for i in 0..COEFFICIENTS {
            let ratio = covariance[(i, i)] / fit.covariance()[(i, i)];
            // Rounding of two inversions.
            assert!((ratio - 1.0).abs() < 1e-6, "{i}: {ratio}");
        }
    }
}

/// What happens in one record is not seen in the other, and the shared columns are sums.
#[test]
fn columns_of_one_record_stay_in_it() {
    let simulations = [simulation(5, 120, 300.0), simulation(6, 90, 300.0)];
    let fit = joined(&simulations).unwrap();
    let rows = fit.record_rows();
    assert_eq!(rows, [0..120, 120..210]);
    let in_first = Column::Step {
        parameter: 0,
        row: 40,
    };
    let in_second = [
        Column::Step {
            parameter: 0,
            row: 150,
        },
        Column::InitialState { row: 120, state: 1 },
        Column::StateJump { row: 130, state: 2 },
    ];
    let mut columns = vec![in_first];
    columns.extend(in_second);
    let alone = |run: usize| fit.conditional_in(run, &columns).unwrap().gram;
    let (first, second) = (alone(0), alone(1));
    let at = |column: usize| 1 + COEFFICIENTS + column;
    for column in 0..4 {
        let (own, other) = match column {
            0 => (&first, &second),
            _ => (&second, &first),
        };
        assert!(own[(at(column), at(column))] > 0.0);
        assert!(other.column(at(column)).amax() == 0.0, "{column}");
    }
    let both = fit.conditional_gram(&columns).unwrap();
    let off = (&both - (first + second)).amax() / both.amax();
    // Rounding of one sum.
    assert!(off < 1e-15, "{off}");
    // A step at the first row of the second record is its parameter there: the other record has the rest.
    let whole = Column::Step {
        parameter: 0,
        row: 120,
    };
    let own = fit.conditional_in(1, &[whole]).unwrap().gram;
    let difference = (own[(at(0), at(0))] - own[(1, 1)]).abs();
    assert!(difference <= 1e-12 * own[(1, 1)], "{difference}");
}

/// Without temperature its columns are zero without a pass; all others are those of the pass with all.
#[test]
fn the_gram_matrix_of_records_without_temperature_is_that_of_all_columns() {
    for turn_on_sigma in [0.0, 0.01] {
        let mut simulations = [simulation(11, 120, 300.0), simulation(12, 90, 300.0)];
        for one in &mut simulations {
            assert!(one.record.temperature_c.is_none());
            one.bench.prior.turn_on_sigma_deg_per_h = [turn_on_sigma; 3];
        }
        let fit = joined(&simulations).unwrap();
        let further = [
            Column::Step {
                parameter: 1,
                row: 40,
            },
            Column::StateJump { row: 150, state: 2 },
        ];
        let found = fit.signatures_gram(&further).unwrap();
        let expected = fit.signatures(&further, |_| ()).unwrap().gram;
        assert_eq!(found.shape(), expected.shape());
        // Four effects of temperature of each gyro and each accelerometer.
        let zeros = expected.diagonal().iter().filter(|x| **x == 0.0).count();
        assert!(zeros >= 24, "{zeros}");
        for i in 0..expected.nrows() {
            for j in 0..expected.ncols() {
                let scale = (expected[(i, i)] * expected[(j, j)]).sqrt();
                // Rounding of sums over 600 values.
                let off = (found[(i, j)] - expected[(i, j)]).abs();
                assert!(off <= 1e-10 * scale, "{i}, {j}: {off} of {scale}");
            }
        }
    }
}

#[test]
fn rows_of_all_records_are_on_one_clock() {
    let simulations = [simulation(7, 50, 60.0), simulation(8, 60, 120.0)];
    let records = simulations.each_ref().map(|one| &one.record);
    let (record, starts) = joined_record(&records);
    assert_eq!(starts, [50]);
    assert_eq!(record.len(), 110);
    assert_eq!(record.time_s[0], records[0].time_s[0]);
    // Ten intervals of the second record lie between them.
    assert!((record.time_s[50] - record.time_s[49] - 1200.0).abs() < 1e-6);
    let fit = joined(&simulations).unwrap();
    assert_eq!(fit.predicted_g().len(), 110);
    assert_eq!(fit.whitened().unwrap().len(), 110);
    let jumps = fit.jumps().unwrap();
    assert!(jumps[0].is_none() && jumps[50].is_none() && jumps[51].is_some());
    // An extension is refitted in all records, with every row counted once.
    let extension = ModelExtension {
        parameters: vec![(COEFFICIENTS + 1, 1.0)],
        ..ModelExtension::default()
    };
    let refitted = fit.refitted(&extension).unwrap();
    assert!(refitted.cost() <= fit.cost() + 1e-6);
    assert_eq!(refitted.values().len(), COEFFICIENTS + 1);
}

#[test]
fn benches_that_contradict_each_other_are_refused() {
    let mut simulations = [simulation(9, 40, 60.0), simulation(10, 40, 60.0)];
    simulations[1].bench.prior.bias_sigma_deg_per_h = [0.5; 3];
    let error = joined(&simulations).err().unwrap();
    assert!(
        matches!(
            error,
            CalibrationError::UnlikeBenches {
                record: 1,
                key: "[prior]"
            }
        ),
        "{error}"
    );
}
