//! Robust estimation: bounded influence of outliers by Huber's weights.

use gyrocal::Chart;
use gyrocal::estimation::Manifold;
use gyrocal::trajectory::Orientation;
use gyrocal_inference::Series;

use crate::error::CalibrationError;
use crate::problem::Problem;
use crate::run::Conditions;
use crate::solve::{MAX_PASSES, Solution};

/// Most rounds of reweighting; with a few outliers the weights converge in three or four.
const MAX_ROUNDS: usize = 20;

/// Largest change of a weight at which the reweighting has converged.
const CONVERGED: f64 = 1e-3;

/// Solves with every value's residual bounded at `bound` standard deviations of its noise
/// (Huber, *Robust Statistics*, 1981): a value beyond it gets the weight bound / |residual|.
/// Returns the solution and the number of such values in each run.
///
/// Residuals are those of the smoothed trajectory, on which a single sample has little influence.
pub(crate) fn solve_robust<D, I>(
    problem: &mut Problem<'_, D, I>,
    bound: f64,
) -> Result<(Solution, Vec<usize>), CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let mut solution = problem.solve(MAX_PASSES)?;
    let mut iterations = solution.iterations;
    for _ in 0..MAX_ROUNDS {
        let mut moved = 0.0_f64;
        for index in 0..problem.runs.len() {
            let parameters = problem.parameters(index);
            let weights = weights(problem, index, &parameters, bound);
            let run = &mut problem.runs[index];
            let none = vec![[1.0; 3]; weights.len()];
            let before = run.rows.weights.as_ref().unwrap_or(&none);
            for (new, old) in weights.as_flattened().iter().zip(before.as_flattened()) {
                moved = moved.max((new - old).abs());
            }
            run.rows.weights = Some(weights);
        }
        if moved < CONVERGED {
            break;
        }
        solution = problem.solve(MAX_PASSES)?;
        iterations += solution.iterations;
    }
    solution.iterations = iterations;
    let bounded = problem
        .runs
        .iter()
        .map(|run| {
            run.rows.weights.as_ref().map_or(0, |weights| {
                weights
                    .as_flattened()
                    .iter()
                    .filter(|weight| **weight < 1.0)
                    .count()
            })
        })
        .collect();
    Ok((solution, bounded))
}

/// Huber's weight of every value of a run.
fn weights<D, I>(
    problem: &Problem<'_, D, I>,
    index: usize,
    parameters: &[f64],
    bound: f64,
) -> Vec<[f64; 3]>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let run = &problem.runs[index];
    let mut chart = run.chart;
    let mut moving = [0.0; 3];
    let declared = run.rows.declared_noise_g();
    run.points
        .iter()
        .enumerate()
        .map(|(row, point)| {
            problem.model.place(point, &mut moving, &mut chart);
            Series::<Chart<f64, I>, 3>::at(&run.rows, row, &mut chart);
            let predicted = problem.model.output(&moving, parameters, &chart);
            let measured = Series::<Chart<f64, I>, 3>::measured(&run.rows, row);
            core::array::from_fn(|axis| {
                let residual = ((measured[axis] - predicted[axis]) / declared[axis]).abs();
                // A missing value compares as neither; its weight is not used.
                if residual > bound {
                    bound / residual
                } else {
                    1.0
                }
            })
        })
        .collect()
}
