//! Search for an unknown azimuth by multiple starts.

use gyrocal::FilterSettings;
use gyrocal::trajectory::{Orientation, rotation_between};

use crate::attitude::{AttitudeHypothesis, AttitudePrior};
use crate::error::CalibrationError;
use crate::initial_trajectory::{InitialTrajectory, filtered_trajectory};
use crate::options::Options;
use crate::result::AzimuthSearch;
use crate::run::Run;
use crate::single_run::{DIVERGED_NIS, single_run_problem, windowed_trajectory};
use crate::solve::MAX_PASSES;
use crate::start::Start;
use crate::uncertainty::Uncertainty;

/// Rows over which azimuths are compared: two days of minutes.
const COMPARED_ROWS: usize = 2880;

/// Number of hypotheses, best ranked first, that are solved if one of them fits.
const SOLVED_HYPOTHESES: usize = 3;

/// Least rotation between first attitudes of different solutions, rad.
const SAME_ATTITUDE_RAD: f64 = 0.02;

/// Solution from one hypothesis over the compared rows.
struct HypothesisSolution<'a> {
    hypothesis: &'a AttitudeHypothesis,
    log_likelihood: f64,
    /// Smoothed attitude at the first row.
    orientation: Orientation,
    /// True if residuals are about as large as the noise.
    fits: bool,
}

/// Compares hypotheses over the first rows: the filter ranks them, the best are solved, and the
/// solution of the largest likelihood is chosen. Returns its hypothesis, moved to the solution.
pub(crate) fn search_azimuth(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    hypotheses: &[AttitudeHypothesis],
    options: &Options,
) -> Result<(AttitudeHypothesis, AzimuthSearch), CalibrationError> {
    let rows = run.record.len().min(COMPARED_ROWS);
    let mut solutions = ranked_solutions(run, rows, settings, hypotheses, options);
    if !solutions.iter().any(|solution| solution.fits) {
        solutions.extend(hypotheses.iter().filter_map(|hypothesis| {
            let from = Start::CAREFUL;
            let start = windowed_trajectory(run, rows, settings, hypothesis, options, from).ok()?;
            solve_from(run, rows, settings, hypothesis, &start, options)
        }));
    }
    solutions.sort_by(|a, b| b.log_likelihood.total_cmp(&a.log_likelihood));
    let Some(best) = solutions.first() else {
        return Err(CalibrationError::NoAzimuth {
            starts: hypotheses.len(),
        });
    };
    let at_solution = |attitude: &AttitudePrior| AttitudePrior {
        orientation: best.orientation,
        ..*attitude
    };
    let chosen = AttitudeHypothesis {
        prior: at_solution(&best.hypothesis.prior),
        start: at_solution(&best.hypothesis.start),
    };
    Ok((chosen, comparison(hypotheses.len(), best, &solutions[1..])))
}

/// Solves the hypotheses in the order of their filters' mean NIS, until enough are solved and one
/// of them fits: a start may end in a local minimum.
fn ranked_solutions<'a>(
    run: &Run<'_>,
    rows: usize,
    settings: &FilterSettings<f64>,
    hypotheses: &'a [AttitudeHypothesis],
    options: &Options,
) -> Vec<HypothesisSolution<'a>> {
    let mut starts: Vec<(&AttitudeHypothesis, InitialTrajectory)> = hypotheses
        .iter()
        .filter_map(|hypothesis| {
            let start = filtered_trajectory(run.record, rows, settings, &hypothesis.start).ok()?;
            Some((hypothesis, start))
        })
        .collect();
    starts.sort_by(|a, b| a.1.nis_mean.total_cmp(&b.1.nis_mean));
    let mut solutions: Vec<HypothesisSolution<'a>> = Vec::new();
    for (index, (hypothesis, start)) in starts.iter().enumerate() {
        if index >= SOLVED_HYPOTHESES && solutions.iter().any(|solution| solution.fits) {
            break;
        }
        solutions.extend(solve_from(run, rows, settings, hypothesis, start, options));
    }
    solutions
}

/// Solution of a hypothesis over the first rows; `None` if the iteration does not converge.
fn solve_from<'a>(
    run: &Run<'_>,
    rows: usize,
    settings: &FilterSettings<f64>,
    hypothesis: &'a AttitudeHypothesis,
    start: &InitialTrajectory,
    options: &Options,
) -> Option<HypothesisSolution<'a>> {
    let mut problem = single_run_problem(run, rows, settings, &hypothesis.prior, start, options);
    let solution = problem.solve(MAX_PASSES).ok()?;
    let uncertainty = Uncertainty::new(&problem.unknowns, &solution)?;
    Some(HypothesisSolution {
        hypothesis,
        log_likelihood: -0.5
            * (solution.cost + solution.log_variance - uncertainty.log_determinant()),
        orientation: problem.runs[0].points[0],
        fits: solution.cost < DIVERGED_NIS * solution.values as f64,
    })
}

/// Compares the best solution with the best of the `others`, in falling order of likelihood, that
/// has another attitude.
fn comparison(
    starts: usize,
    best: &HypothesisSolution<'_>,
    others: &[HypothesisSolution<'_>],
) -> AzimuthSearch {
    let other = others.iter().find_map(|other| {
        let rotation = rotation_between(&best.orientation, &other.orientation);
        let angle = rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
        let up = best.orientation[1];
        let about_up: f64 = rotation.iter().zip(&up).map(|(a, b)| a * b).sum();
        (angle > SAME_ATTITUDE_RAD)
            .then_some((best.log_likelihood - other.log_likelihood, about_up))
    });
    let (margin, other_rad) = other.unwrap_or((f64::INFINITY, 0.0));
    AzimuthSearch {
        starts,
        margin,
        other_rad,
    }
}
