//! Process noise of states and correlated noise of outputs, against the joint Gaussian density of all outputs.

use chacha20::ChaCha12Rng;
use gyrocal_inference::{Column, Correlated, FurtherNoise, Layout, LinearisedRows, Pass, Process};
use nalgebra::{Cholesky, DMatrix, DVector};
use rand::SeedableRng;

use crate::noise::normal;

const ROWS: usize = 14;
const STATES: usize = 2;
const OUTPUTS: usize = 2;

/// The step after this row leads to another record.
const LAST_OF_FIRST: usize = 8;

const PROCESS: [Process; 2] = [
    Process {
        state: 0,
        density: 0.02,
    },
    Process {
        state: 1,
        density: 0.3,
    },
];

const CORRELATED: [Correlated; 2] = [
    Correlated {
        output: 1,
        time_s: 1.7,
        variance: 0.4,
    },
    Correlated {
        output: 0,
        time_s: 0.3,
        variance: 0.1,
    },
];

const COLUMNS: [Column; 1] = [Column::Parameter { parameter: 0 }];

/// Two records of a linear plant one after the other, with steps of several lengths and a missing value.
fn record() -> LinearisedRows {
    let mut rng = ChaCha12Rng::seed_from_u64(5);
    let mut rows = LinearisedRows::new(Layout {
        states: STATES,
        outputs: OUTPUTS,
        noises: 0,
        parameters: [0].into(),
        of_outputs: 1,
    });
    for row in 0..ROWS {
        if row + 1 < ROWS {
            rows.step_s.push(0.2 + 0.1 * (row % 4) as f64);
            let begins = row == LAST_OF_FIRST;
            let by = [0.9, 0.2, -0.3, 0.8].map(|by| if begins { 0.0 } else { by });
            rows.by_states.extend(by);
            rows.by_parameters
                .extend([normal(&mut rng), normal(&mut rng)]);
            rows.defects.extend([0.0, 0.0]);
        }
        rows.residuals.extend([normal(&mut rng), normal(&mut rng)]);
        rows.variances.extend([0.5, 0.2]);
        rows.out_by_states.extend([1.0, 0.5, -0.4, 1.2]);
        rows.out_by_parameters.extend([0.1, normal(&mut rng)]);
    }
    rows.residuals[7] = f64::NAN;
    rows
}

/// Factors of the outputs, of the process noises, of the correlated noises.
const FACTORS: [f64; 6] = [1.3, 0.8, 2.0, 0.6, 1.7, 0.9];

/// Covariance of all outputs.
fn covariance(rows: &LinearisedRows, factors: &[f64]) -> DMatrix<f64> {
    let time: Vec<f64> = core::iter::once(0.0)
        .chain(rows.step_s.iter().scan(0.0, |sum, step| {
            *sum += step;
            Some(*sum)
        }))
        .collect();
    let record = |row: usize| usize::from(row > LAST_OF_FIRST);
    let transition =
        |row: usize| DMatrix::from_row_slice(STATES, STATES, &rows.by_states[4 * row..4 * row + 4]);
    let of_states = |row: usize| {
        DMatrix::from_row_slice(OUTPUTS, STATES, &rows.out_by_states[4 * row..4 * row + 4])
    };
    // Covariance of the states at a row with those at an earlier one.
    let mut own = vec![DMatrix::zeros(STATES, STATES)];
    for row in 0..ROWS - 1 {
        let mut next = transition(row) * &own[row] * transition(row).transpose();
        if row != LAST_OF_FIRST {
            for (index, process) in PROCESS.iter().enumerate() {
                let variance = factors[2 + index] * process.density * rows.step_s[row];
                next[(process.state, process.state)] += variance;
            }
        }
        own.push(next);
    }
    DMatrix::from_fn(ROWS * OUTPUTS, ROWS * OUTPUTS, |a, b| {
        let (late, early) = (a.max(b), a.min(b));
        let (late, one) = (late / OUTPUTS, late % OUTPUTS);
        let (early, other) = (early / OUTPUTS, early % OUTPUTS);
        let mut states = own[early].clone();
        for row in early..late {
            states = transition(row) * states;
        }
        let (h, g) = (of_states(late), of_states(early));
        let mut sum = (h * states * g.transpose())[(one, other)];
        if a == b {
            sum += factors[one] * rows.variances[a];
        }
        if one == other && record(late) == record(early) {
            for (index, noise) in CORRELATED.iter().enumerate() {
                if noise.output == one {
                    let kept = (-(time[late] - time[early]) / noise.time_s).exp();
                    sum += factors[4 + index] * noise.variance * kept;
                }
            }
        }
        sum
    })
}

fn log_likelihood(rows: &LinearisedRows, factors: &[f64]) -> f64 {
    let seen: Vec<usize> = (0..ROWS * OUTPUTS)
        .filter(|place| !rows.residuals[*place].is_nan())
        .collect();
    let all = covariance(rows, factors);
    let residuals = DVector::from_fn(seen.len(), |i, _| rows.residuals[seen[i]]);
    let cholesky = Cholesky::new(all.select_rows(&seen).select_columns(&seen)).unwrap();
    let logarithm: f64 = cholesky.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum();
    let constant = seen.len() as f64 * core::f64::consts::TAU.ln();
    -0.5 * (cholesky.solve(&residuals).dot(&residuals) + logarithm + constant)
}

fn pass<'a>(rows: &'a LinearisedRows, factors: &'a [f64]) -> Pass<'a> {
    Pass {
        further: FurtherNoise {
            process: &PROCESS,
            correlated: &CORRELATED,
            ..FurtherNoise::default()
        },
        factors,
        ..Pass::new(rows, &COLUMNS)
    }
}

#[test]
fn the_likelihood_with_coloured_noise_is_that_of_the_joint_gaussian() {
    let rows = record();
    let found = pass(&rows, &FACTORS).noise_score().unwrap();
    let expected = log_likelihood(&rows, &FACTORS);
    // Rounding of some thirty values.
    assert!((found.log_likelihood() - expected).abs() < 1e-10 * expected.abs());
    let step = 1e-5;
    for (index, gradient) in found.gradient().iter().enumerate() {
        let at = |change: f64| {
            let mut factors = FACTORS;
            factors[index] *= change.exp();
            log_likelihood(&rows, &factors)
        };
        let difference = (at(step) - at(-step)) / (2.0 * step);
        // The error of central differences and rounding at this step.
        assert!((gradient - difference).abs() < 1e-8, "{index}");
    }
}

#[test]
fn columns_in_coloured_noise_are_whitened_with_the_joint_covariance() {
    let rows = record();
    let gram = pass(&rows, &FACTORS).reduce(|_| ()).unwrap().gram;
    // The column by an independent recursion: the change of the outputs by the parameter.
    let mut state = DVector::zeros(STATES);
    let mut column = Vec::new();
    for row in 0..ROWS {
        let by = &rows.out_by_states[4 * row..4 * row + 4];
        let outputs = DMatrix::from_row_slice(OUTPUTS, STATES, by) * &state;
        for (output, value) in outputs.iter().enumerate() {
            column.push(-value - rows.out_by_parameters[row * OUTPUTS + output]);
        }
        if row + 1 < ROWS {
            let by = &rows.by_states[4 * row..4 * row + 4];
            let driven = DVector::from_row_slice(&rows.by_parameters[2 * row..2 * row + 2]);
            state = DMatrix::from_row_slice(STATES, STATES, by) * state + driven;
        }
    }
    let seen: Vec<usize> = (0..ROWS * OUTPUTS)
        .filter(|place| !rows.residuals[*place].is_nan())
        .collect();
    let all = covariance(&rows, &FACTORS);
    let cholesky = Cholesky::new(all.select_rows(&seen).select_columns(&seen)).unwrap();
    let both = DMatrix::from_fn(seen.len(), 2, |i, j| match j {
        0 => rows.residuals[seen[i]],
        _ => column[seen[i]],
    });
    let expected = both.tr_mul(&cholesky.solve(&both));
    // Rounding of sums of some thirty products.
    assert!((gram - &expected).amax() < 1e-11 * expected.amax());
}

#[test]
fn noise_that_cannot_be_is_refused() {
    let rows = record();
    let of = |process: &[Process], correlated: &[Correlated]| {
        let further = FurtherNoise {
            process,
            correlated,
            ..FurtherNoise::default()
        };
        let pass = Pass {
            further,
            ..Pass::new(&rows, &COLUMNS)
        };
        pass.reduce(|_| ()).map(|_| ())
    };
    assert!(of(&PROCESS, &CORRELATED).is_ok());
    for wrong in [
        Process {
            state: STATES,
            density: 1.0,
        },
        Process {
            state: 0,
            density: 0.0,
        },
    ] {
        assert!(of(&[wrong], &[]).is_err(), "{wrong:?}");
    }
    let right = CORRELATED[0];
    for wrong in [
        Correlated {
            output: OUTPUTS,
            ..right
        },
        Correlated {
            time_s: f64::NAN,
            ..right
        },
        Correlated {
            variance: f64::INFINITY,
            ..right
        },
    ] {
        assert!(of(&[], &[wrong]).is_err(), "{wrong:?}");
    }
}
