//! Parameters that walk, against the joint Gaussian density of outputs and walks.

use gyrocal_estimation::EstimationError;
use gyrocal_inference::{Column, ExtraColumns, KeptRecord, Pass, PassError, Walk, Walks};
use gyrocal_scalar::Model;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::chain::{Case, Chain, PRIOR, VARIANCE, none};
use crate::common::Pendulum;
use crate::density::Density;

const WALKS: [Walk; 2] = [
    Walk {
        parameter: 2,
        density: 0.8,
    },
    Walk {
        parameter: 3,
        density: 0.05,
    },
];
const ACTIVE: [usize; 2] = [2, 3];

/// Derivatives of all present outputs by the change of each parameter over each step.
fn by_each_step(chain: &Chain, walk: usize) -> DMatrix<f64> {
    let steps = chain.times_s.len() - 1;
    let present = chain.present();
    let outputs = |changed: usize, change: f64| {
        let mut points = vec![chain.trajectory()[0]];
        for row in 0..steps {
            let mut parameters = PRIOR;
            if row == changed {
                parameters[WALKS[walk].parameter] += change;
            }
            let torques = vec![0.0; chain.parts(row).0];
            points.push(chain.over(row, points[row], &parameters, &torques));
        }
        DVector::from_iterator(
            present.len(),
            present.iter().map(|(row, output)| {
                let predicted: [f64; 2] = Pendulum.output(&points[*row], &PRIOR, &());
                predicted[*output]
            }),
        )
    };
    let columns: Vec<DVector<f64>> = (0..steps)
        .map(|step| (outputs(step, 1e-4) - outputs(step, -1e-4)) / 2e-4)
        .collect();
    DMatrix::from_columns(&columns)
}

/// Covariance of the outputs with the change of each walk at each row (a row for each row and walk),
/// and of the outputs by the walks alone.
fn of_walks(chain: &Chain, factors: [f64; 2]) -> (DMatrix<f64>, DMatrix<f64>) {
    let rows = chain.times_s.len();
    let present = chain.present().len();
    let mut cross = DMatrix::zeros(2 * rows, present);
    let mut own = DMatrix::zeros(present, present);
    for walk in 0..2 {
        let each = by_each_step(chain, walk);
        for step in 0..rows - 1 {
            let duration_s = chain.times_s[step + 1] - chain.times_s[step];
            let variance = WALKS[walk].density * factors[walk] * duration_s;
            // The mean over a step of a walk that ends at u is u / 2 with a variance of a twelfth.
            let mut change = 0.5 * each.column(step);
            for later in step + 1..rows - 1 {
                change += each.column(later);
            }
            own += variance * (&change * change.transpose());
            own += variance / 12.0 * (each.column(step) * each.column(step).transpose());
            for row in step + 1..rows {
                let mut target = cross.row_mut(2 * row + walk);
                target += variance * change.transpose();
            }
        }
    }
    (cross, own)
}

struct Dense {
    residuals: DVector<f64>,
    covariance: DMatrix<f64>,
    cross: DMatrix<f64>,
}

fn dense(chain: &Chain, factors: [f64; 2]) -> Dense {
    let (residuals, without) = Density { chain }.outputs_given_parameters();
    let (cross, own) = of_walks(chain, factors);
    Dense {
        residuals,
        covariance: without + own,
        cross,
    }
}

const OWN: Walks<'static> = Walks {
    walks: &WALKS,
    changes: &[],
};

fn walking<'a>(chain: &'a Chain, points: &'a [[f64; 2]], further: &'a ExtraColumns) -> Case<'a> {
    chain
        .linearised(points, &PRIOR, &ACTIVE, further)
        .walking(OWN)
}

#[test]
fn the_likelihood_with_walks_is_that_of_the_joint_gaussian() {
    let chain = Chain::measured(3);
    let points = chain.trajectory();
    let no_columns = none();
    let pass = walking(&chain, &points, &no_columns);
    let factors = [1.0, 1.0, 1.0, 1.0, 1.7, 0.4];
    let score = pass.noise_score(&factors).unwrap();
    let dense = dense(&chain, [1.7, 0.4]);
    let cholesky = Cholesky::new(dense.covariance).unwrap();
    let squares = cholesky.solve(&dense.residuals).dot(&dense.residuals);
    let determinant = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
    let constant = score.values as f64 * core::f64::consts::TAU.ln();
    let expected = -0.5 * (squares + determinant + constant);
    // The effect of a walk is linearised: derivatives by differences of second order.
    assert!(
        (score.log_likelihood() - expected).abs() < 1e-4,
        "{} {expected}",
        score.log_likelihood()
    );
    // Without walks it is another likelihood.
    let without = pass.walking(Walks::default());
    let other = without.noise_score(&factors[..4]).unwrap();
    assert!((other.log_likelihood() - expected).abs() > 1.0);
}

#[test]
fn the_gradient_by_walks_and_columns_is_that_of_the_sums() {
    let chain = Chain::measured(4);
    let points = chain.trajectory();
    let no_columns = none();
    let pass = walking(&chain, &points, &no_columns);
    let at = [1.3, 0.6, 2.0, 1.0, 1.7, 0.4];
    let score = |factors: &[f64]| pass.noise_score_of_columns(factors, 0, &[]).unwrap();
    let found = score(&at);
    assert_eq!(found.gram.nrows(), 3);
    for k in 0..6 {
        let moved = |logarithm: f64| {
            let mut factors = at;
            factors[k] *= f64::exp(logarithm);
            score(&factors)
        };
        let step = 1e-3;
        let difference = |f: &dyn Fn(f64) -> f64| {
            (8.0 * (f(step) - f(-step)) - f(2.0 * step) + f(-2.0 * step)) / (12.0 * step)
        };
        // Rounding of sums of some thousands over the step.
        let same = |found: f64, expected: f64| {
            assert!(
                (found - expected).abs() < 1e-7 * (1.0 + expected.abs()),
                "{k}: {found} {expected}"
            );
        };
        same(
            found.d_log_variance[k],
            difference(&|logarithm| moved(logarithm).log_variance),
        );
        for i in 0..3 {
            for j in 0..3 {
                same(
                    found.d_gram[k][(i, j)],
                    difference(&|logarithm| moved(logarithm).gram[(i, j)]),
                );
            }
        }
    }
    let some = pass.noise_score_of_columns(&at, 4, &[]).unwrap();
    assert_eq!(some.d_gram[4..], found.d_gram[4..]);
    assert_eq!(some.information[28..30], found.information[28..30]);
    let reduced = pass.reduce().unwrap();
    let declared = score(&[1.0; 6]);
    // The same sums in another order.
    assert!((reduced.gram - declared.gram).abs().max() < 1e-8);
    assert!((reduced.log_variance - declared.log_variance).abs() < 1e-10);
}

/// Information on a walk where the columns have changed, and what of it lies along them, against differences
/// of the innovations of two passes.
#[test]
fn the_information_is_that_of_the_innovations_where_the_columns_have_changed() {
    let chain = Chain::measured(4);
    let points = chain.trajectory();
    let change = [0.7, -1.9];
    let half = 1e-4;
    // Innovation with its columns, variance, and the whitened row of each output.
    let rows = |logarithm: f64| {
        let mut walks = WALKS;
        walks[0].density *= f64::exp(logarithm);
        let no_columns = none();
        let pass = walking(&chain, &points, &no_columns).walking(Walks {
            walks: &walks,
            changes: &[],
        });
        let mut rows = Vec::new();
        pass.pass()
            .reduce(|seen| {
                let innovation =
                    seen.deviation * (seen.columns[0] + changed(seen.columns, &change));
                rows.push((innovation, seen.deviation.powi(2), seen.columns.to_vec()));
            })
            .unwrap();
        rows
    };
    let (before, at, after) = (rows(-half), rows(0.0), rows(half));
    let mut information = 0.0;
    let mut along = [0.0; 3];
    for ((before, at), after) in before.iter().zip(&at).zip(&after) {
        let by_mean = (after.0 - before.0) / (2.0 * half) / at.1.sqrt();
        let by_variance = (after.1 - before.1) / (2.0 * half) / at.1;
        information += 0.5 * by_variance * by_variance + by_mean * by_mean;
        for (sum, column) in along.iter_mut().zip(&at.2) {
            *sum += by_mean * column;
        }
    }
    let no_columns = none();
    let pass = walking(&chain, &points, &no_columns);
    let score = pass.noise_score_of_columns(&[1.0; 6], 0, &change).unwrap();
    let (walk, count) = (4, 6);
    // Differences of second order.
    let same = |found: f64, expected: f64| {
        let off = (found - expected).abs();
        assert!(off < 1e-6 * (1.0 + expected.abs()), "{found} {expected}");
    };
    same(score.information[walk * count + walk], information);
    for (found, expected) in score.with_rows[walk * 3..].iter().zip(along) {
        same(*found, expected);
    }
    let expected = pass.noise_score_of_columns(&[1.0; 6], 0, &[]).unwrap();
    assert!(score.information[28] > 1.1 * expected.information[28]);
    let wrong = pass.noise_score_of_columns(&[1.0; 6], 0, &[1.0]);
    assert!(matches!(
        wrong,
        Err(PassError::Estimation(
            EstimationError::InvalidArgument { .. }
        ))
    ));
}

fn changed(columns: &[f64], change: &[f64]) -> f64 {
    columns[1..].iter().zip(change).map(|(a, b)| a * b).sum()
}

#[test]
fn smoothed_walks_are_the_conditional_mean() {
    let chain = Chain::measured(5);
    let points = chain.trajectory();
    let no_columns = none();
    let pass = walking(&chain, &points, &no_columns);
    let smoothed = pass.smooth(&[0.0; 2]).unwrap();
    let dense = dense(&chain, [1.0; 2]);
    let weights = Cholesky::new(dense.covariance)
        .unwrap()
        .solve(&dense.residuals);
    let expected = &dense.cross * weights;
    let largest = expected.abs().max();
    assert!(largest > 0.01, "{largest}");
    for (found, expected) in smoothed.walks.iter().zip(expected.iter()) {
        // As the likelihood.
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
}

/// The cost of a smoothed trajectory with its walks is the least, which the innovations give too.
#[test]
fn the_smoothed_trajectory_has_the_least_cost() {
    let chain = Chain::measured(6);
    let mut points = chain.trajectory();
    let mut changes = vec![0.0; 2 * points.len()];
    fn walks(changes: &[f64]) -> Walks<'_> {
        Walks {
            walks: &WALKS,
            changes,
        }
    }
    let no_columns = none();
    for _ in 0..8 {
        let pass = chain
            .linearised(&points, &PRIOR, &ACTIVE, &no_columns)
            .walking(walks(&changes));
        let smoothed = pass.smooth(&[0.0; 2]).unwrap();
        for (point, correction) in points.iter_mut().zip(smoothed.corrections.chunks_exact(2)) {
            point[0] += correction[0];
            point[1] += correction[1];
        }
        for (change, correction) in changes.iter_mut().zip(&smoothed.walks) {
            *change += correction;
        }
    }
    let pass = chain
        .linearised(&points, &PRIOR, &ACTIVE, &no_columns)
        .walking(walks(&changes));
    let reduced = pass.reduce().unwrap();
    // Rounding: about the optimum both are the same sum of squares.
    assert!((reduced.trajectory_cost / reduced.gram[(0, 0)] - 1.0).abs() < 1e-9);
    // Over the kept record too.
    let kept = KeptRecord::new(&pass.trajectory).unwrap();
    let on_kept = Pass {
        record: &kept,
        ..pass.pass()
    };
    assert_eq!(on_kept.reduce_with_cost(|_| ()).unwrap(), reduced);
}

#[test]
fn scores_of_jumps_beside_walks_are_those_of_columns() {
    let chain = Chain::measured(7);
    let points = chain.trajectory();
    let mut jumps = Vec::new();
    walking(&chain, &points, &none())
        .pass()
        .jumps(|row, score| jumps.push((row, score.clone())))
        .unwrap();
    for (row, score) in &jumps {
        for state in 0..2 {
            let knock = ExtraColumns::new(vec![Column::StateJump {
                row: row - 1,
                state,
            }]);
            let gram = walking(&chain, &points, &knock).reduce().unwrap().gram;
            let same = |found: f64, expected: f64| {
                // Columns are derivatives of the innovations; those of a jump have the other sign.
                // Rounding of sums of some thousands.
                let scale = 1.0 + expected.abs() + gram[(3, 3)];
                assert!(
                    (found - expected).abs() < 1e-9 * scale,
                    "{found} {expected}"
                );
            };
            same(score.columns[0][state], -gram[(0, 3)]);
            same(score.columns[1][state], -gram[(1, 3)]);
            same(score.columns[2][state], -gram[(2, 3)]);
            same(score.information[3 * state], gram[(3, 3)]);
        }
    }
    assert!(jumps.len() == chain.times_s.len() - 1 && VARIANCE[0] > 0.0);
}

/// A walk of the bias of the angle's sensor, which the states do not notice.
#[test]
fn a_walk_that_outputs_depend_on_is_that_of_the_joint_gaussian() {
    let chain = Chain::measured(3);
    let points = chain.trajectory();
    let walks = [Walk {
        parameter: 0,
        density: 2e-4,
    }];
    let no_columns = none();
    let pass = chain
        .linearised(&points, &PRIOR, &[0], &no_columns)
        .walking(Walks {
            walks: &walks,
            changes: &[],
        });
    let score = pass.noise_score(&[1.0; 5]).unwrap();
    let (residuals, mut covariance) = Density { chain: &chain }.outputs_given_parameters();
    let present = chain.present();
    for (i, (row, output)) in present.iter().enumerate() {
        for (j, (other, of)) in present.iter().enumerate() {
            if (*output, *of) == (0, 0) {
                let since_s = chain.times_s[*row.min(other)] - chain.times_s[0];
                covariance[(i, j)] += walks[0].density * since_s;
            }
        }
    }
    let cholesky = Cholesky::new(covariance).unwrap();
    let squares = cholesky.solve(&residuals).dot(&residuals);
    let determinant = 2.0 * cholesky.l().diagonal().map(f64::ln).sum();
    let constant = score.values as f64 * core::f64::consts::TAU.ln();
    let expected = -0.5 * (squares + determinant + constant);
    // Rounding, and covariances of the other noise by differences.
    let found = score.log_likelihood();
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
}

#[test]
fn walks_that_cannot_be_are_refused() {
    let chain = Chain::measured(8);
    let points = chain.trajectory();
    let refused = |walk: Walk, active: &[usize], changes: &[f64]| {
        let walks = [walk];
        let no_columns = none();
        let pass = chain
            .linearised(&points, &PRIOR, active, &no_columns)
            .walking(Walks {
                walks: &walks,
                changes,
            });
        assert!(matches!(
            pass.reduce(),
            Err(PassError::Estimation(
                EstimationError::InvalidArgument { .. }
            ))
        ));
    };
    let good = WALKS[0];
    // Not active; without a variance; not one change a row.
    refused(good, &[3], &[]);
    refused(
        Walk {
            density: 0.0,
            ..good
        },
        &ACTIVE,
        &[],
    );
    refused(good, &ACTIVE, &[0.0; 3]);
}
