//! Bounded influence of outliers: Huber's weights.

use gyrocal::Chart;
use gyrocal::estimation::Manifold;
use gyrocal::estimation::batch::Series;
use gyrocal::trajectory::Orientation;

use crate::problem::Problem;
use crate::run::Conditions;
use crate::solve::{Failure, Solution};

/// Rounds of weighting; weights of a record with a few outliers settle in three or four.
const MOST_ROUNDS: usize = 20;

/// Weights count as settled when none moved by more than this.
const SETTLED: f64 = 1e-3;

/// Solves with every value's residual bounded at `bound` standard deviations of its noise
/// (Huber, *Robust Statistics*, 1981): a value beyond it gets the weight bound / |residual|.
/// Returns the number of such values in each leg beside the solution.
///
/// Residuals are those of the smoothed trajectory, which a single sample hardly moves.
pub(crate) fn solve<D, I>(
    problem: &mut Problem<'_, D, I>,
    bound: f64,
    most_iterations: usize,
) -> Result<(Solution, Vec<usize>), Failure>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let mut solution = problem.solve(most_iterations, |_| ())?;
    let mut passes = solution.iterations;
    for _ in 0..MOST_ROUNDS {
        let mut moved = 0.0_f64;
        for index in 0..problem.legs.len() {
            let parameters = problem.parameters(index);
            let weights = weights(problem, index, &parameters, bound);
            let leg = &mut problem.legs[index];
            let none = vec![[1.0; 3]; weights.len()];
            let before = leg.rows.weights.as_ref().unwrap_or(&none);
            for (new, old) in weights.as_flattened().iter().zip(before.as_flattened()) {
                moved = moved.max((new - old).abs());
            }
            leg.rows.weights = Some(weights);
        }
        if moved < SETTLED {
            break;
        }
        solution = problem.solve(most_iterations, |_| ())?;
        passes += solution.iterations;
    }
    solution.iterations = passes;
    let bounded = problem
        .legs
        .iter()
        .map(|leg| {
            leg.rows.weights.as_ref().map_or(0, |weights| {
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
    let leg = &problem.legs[index];
    let mut chart = leg.chart;
    let mut moving = [0.0; 3];
    let declared = leg.rows.declared_noise_g();
    leg.points
        .iter()
        .enumerate()
        .map(|(row, point)| {
            problem.model.place(point, &mut moving, &mut chart);
            Series::<Chart<f64, I>, 3>::at(&leg.rows, row, &mut chart);
            let predicted = problem.model.output(&moving, parameters, &chart);
            let measured = Series::<Chart<f64, I>, 3>::measured(&leg.rows, row);
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
