//! The problem of one run by itself, and its initial trajectory.

use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::trajectory::Orientation;
use gyrocal::{Anchored, Chart, ChartInputs, Drift, FilterSettings, Surveyed};

use crate::attitude::{AttitudeHypothesis, AttitudePrior};
use crate::error::CalibrationError;
use crate::initial_trajectory::{InitialTrajectory, filtered_trajectory};
use crate::layout::Layout;
use crate::options::Options;
use crate::problem::{Problem, RunProblem};
use crate::run::{Run, WeightedRows};
use crate::solve::MAX_PASSES;
use crate::start::Start;
use crate::uncertainty::Uncertainty;
use gyrocal_hypothesis::ExtraColumns;

/// Mean NIS over values, 1 expected, above which a filter counts as diverged.
pub(crate) const DIVERGED_NIS: f64 = 10.0;

/// Rows of the first window of [`windowed_trajectory`].
const FIRST_WINDOW: usize = 16;

/// The first rows of a run with their noise, prior, trajectory and unknowns.
pub(crate) fn run_problem<'a, I: ChartInputs<f64>>(
    run: &Run<'a>,
    rows: usize,
    settings: &FilterSettings<f64>,
    prior: &AttitudePrior,
    points: Vec<Orientation>,
    parameter_unknowns: Vec<Vec<usize>>,
) -> RunProblem<'a, I> {
    RunProblem {
        rows: WeightedRows::new(run.record, rows, [settings.accel_noise_g; 3]),
        chart: Chart::for_model(settings.site),
        noise_density: [settings.drift_noise_density(); 3],
        prior: prior.orientation,
        prior_covariance: prior.covariance,
        points,
        parameter_unknowns,
        further: ExtraColumns::default(),
        amplitudes: Vec::new(),
        walks: Vec::new(),
        walk_changes: Vec::new(),
    }
}

/// Single-run problem over the first rows, at its initial trajectory.
pub(crate) fn single_run_problem<'a>(
    run: &Run<'a>,
    rows: usize,
    settings: &FilterSettings<f64>,
    prior: &AttitudePrior,
    start: &InitialTrajectory,
    options: &Options,
) -> Problem<'a, Anchored<Surveyed>, SurveyedInputs<f64>> {
    let layout = Layout::new(&[run.bench]);
    let mut values = vec![0.0; layout.unknowns.len()];
    values[..start.drift.len()].copy_from_slice(&start.drift);
    Problem {
        model: &Anchored(Surveyed),
        integration: options.discretisation.integration,
        longest_step_s: options.discretisation.longest_step_s,
        runs: vec![run_problem(
            run,
            rows,
            settings,
            prior,
            start.points.clone(),
            layout.parameter_unknowns(0),
        )],
        unknowns: layout.unknowns,
        values,
    }
}

/// The initial trajectory of a whole record: that of the filter, or, where the filter diverges or
/// the start is careful, that of [`windowed_trajectory`].
pub(crate) fn initial_trajectory(
    run: &Run<'_>,
    settings: &FilterSettings<f64>,
    hypothesis: &AttitudeHypothesis,
    options: &Options,
    from: Start,
) -> Result<InitialTrajectory, CalibrationError> {
    let rows = run.record.len();
    if !from.careful
        && let Ok(start) = filtered_trajectory(run.record, rows, settings, &hypothesis.start)
        && start.nis_mean < DIVERGED_NIS
    {
        return Ok(start);
    }
    windowed_trajectory(run, rows, settings, hypothesis, options, from)
}

/// The initial trajectory of the first rows by growing windows: each window is solved before the
/// filter runs over the next one, so that no linearisation is far from the solution. Windows that have none
/// are solved in stages, if asked for.
pub(crate) fn windowed_trajectory(
    run: &Run<'_>,
    all: usize,
    settings: &FilterSettings<f64>,
    hypothesis: &AttitudeHypothesis,
    options: &Options,
    from: Start,
) -> Result<InitialTrajectory, CalibrationError> {
    let mut settings_now = *settings;
    let mut attitude = hypothesis.start;
    let mut window = FIRST_WINDOW;
    loop {
        let rows = window.min(all);
        let start = filtered_trajectory(run.record, rows, &settings_now, &attitude)?;
        if rows == all {
            return Ok(InitialTrajectory {
                by_windows: true,
                ..start
            });
        }
        let at_start =
            || single_run_problem(run, rows, settings, &hypothesis.prior, &start, options);
        let mut problem = at_start();
        let mut solved = problem.solve(MAX_PASSES);
        if from.staged && solved.is_err() {
            problem = at_start();
            solved = problem.solve_in_stages(MAX_PASSES);
        }
        // After a window that does not converge the next one, with more rows, starts as it did.
        if let Ok(solution) = solved
            && let Some(uncertainty) = Uncertainty::new(&problem.unknowns, &solution)
        {
            attitude.orientation = problem.runs[0].points[0];
            let mut sigma = settings.drift_sigma.to_array();
            for (i, sigma) in sigma.iter_mut().enumerate() {
                // Three times: linearisation errors of the window are not in its covariance.
                *sigma = sigma.min(3.0 * uncertainty.conditional[(i, i)].sqrt());
            }
            settings_now.drift = Drift::from_array(core::array::from_fn(|i| problem.values[i]));
            settings_now.drift_sigma = Drift::from_array(sigma);
        }
        // Half as long again: over twice the time the filter diverges from a wide prior.
        window += window / 2;
    }
}
