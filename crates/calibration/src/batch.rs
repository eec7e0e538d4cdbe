//! The batch estimator: initial guess, Gauss-Newton solution and covariance of several runs.

use gyrocal::estimation::Manifold;
use gyrocal::trajectory::{Orientation, angles_rad, platform_c_enu};
use gyrocal::{Chart, Drift};
use gyrocal_inference::Pass;
use gyrocal_record::{Bench, NoiseEstimate};

use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::fit::FitStatistics;
use crate::gyro_axes::GyroAxes;
use crate::initial_guess::{Guessed, best_fit, initial_guess};
use crate::layout::{Layout, SiteQuantity};
use crate::noise;
use crate::observability::unobservable;
use crate::options::Options;
use crate::problem::Problem;
use crate::result::{AzimuthSearch, Calibration, ConsiderSensitivity, RunResult};
use crate::robust::solve_robust;
use crate::run::{Conditions, Run};
use crate::settings::filter_settings;
use crate::single_run::run_problem;
use crate::solve::{MAX_PASSES, Solution};
use crate::start::Start;
use crate::uncertainty::Uncertainty;
use crate::variances::{UncertaintySource, Variances};

/// The runs to be calibrated together, and how.
struct Task<'a, 'b, D> {
    model: &'a D,
    runs: &'b [Run<'a>],
    gyro_axes: Option<&'a [GyroAxes]>,
    layout: &'b Layout,
    options: &'b Options,
}

/// The joint problem at its solution.
struct Solved<'a, D, I> {
    problem: Problem<'a, D, I>,
    solution: Solution,
    /// Search for the azimuth of each run whose bench does not declare the attitude.
    azimuths: Vec<Option<AzimuthSearch>>,
    /// Number of values with a Huber weight below 1 in each run.
    bounded: Vec<usize>,
}

/// Calibrates on whole records with a model whose parameters are those of
/// [`gyrocal::Surveyed`]. `gyro_axes`, one for each run, are given for models in which the gyros do
/// not lie along the platform's axes.
pub(crate) fn calibrate<D, I>(
    model: &D,
    runs: &[Run<'_>],
    gyro_axes: Option<&[GyroAxes]>,
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let found = calibrate_with(model, runs, gyro_axes, options, progress, |_, _, _| Ok(()));
    found.map(|(calibration, ())| calibration)
}

/// The same with the parts of the variances.
pub(crate) fn calibrate_with_variances<D, I>(
    model: &D,
    runs: &[Run<'_>],
    options: &Options,
) -> Result<(Calibration, Variances), CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let parts = |solved: &Solved<'_, D, I>, layout: &Layout, uncertainty: &Uncertainty| {
        let source = |unknown| source_of(layout, unknown);
        let solution = &solved.solution;
        solved.problem.variances(solution, uncertainty, source)
    };
    calibrate_with(model, runs, None, options, &mut |_| (), parts)
}

/// Source of the prior of an unknown.
fn source_of(layout: &Layout, unknown: usize) -> UncertaintySource {
    if unknown < PARAMETERS {
        return UncertaintySource::Prior(unknown);
    }
    let of_site = layout.quantity(unknown).map(UncertaintySource::Site);
    let of_turn_on = || layout.turn_on_axis(unknown).map(UncertaintySource::TurnOn);
    of_site
        .or_else(of_turn_on)
        .unwrap_or(UncertaintySource::Effects)
}

/// Calibrates, and looks at the solution.
fn calibrate_with<D, I, R>(
    model: &D,
    runs: &[Run<'_>],
    gyro_axes: Option<&[GyroAxes]>,
    options: &Options,
    progress: &mut dyn FnMut(usize),
    look: impl FnOnce(&Solved<'_, D, I>, &Layout, &Uncertainty) -> Result<R, CalibrationError>,
) -> Result<(Calibration, R), CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let benches: Vec<_> = runs.iter().map(|run| run.bench).collect();
    let layout = Layout::new(&benches);
    let task = &Task {
        model,
        runs,
        gyro_axes,
        layout: &layout,
        options,
    };
    let solved = best_fit(
        |start| problem_at_guess(task, start, progress),
        |guess| solve(task, guess),
        |solved| (solved.solution.cost, solved.solution.values),
    )?;
    let (problem, solution) = (&solved.problem, &solved.solution);
    let uncertainty = Uncertainty::new(&problem.unknowns, solution)
        .ok_or(CalibrationError::NotPositiveDefinite)?;
    let seen = look(&solved, &layout, &uncertainty)?;
    let runs = run_results(&solved, &layout, &uncertainty, options)?;
    let last = runs
        .last()
        .map_or([[0.0; 3]; 3], |run| run.last_platform_c_enu);
    let prior_sigma: [f64; PARAMETERS] = core::array::from_fn(|i| problem.unknowns[i].sigma);
    let calibration = Calibration {
        drift: Drift::from_array(core::array::from_fn(|i| problem.values[i])),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| uncertainty.total[(i, j)])),
        prior_sigma: Drift::from_array(prior_sigma),
        fit: FitStatistics::of_batch(solution, &problem.unknowns, &uncertainty),
        platform_c_enu: last,
        final_angles_rad: angles_rad(&last),
        iterations: solution.iterations,
        runs,
        site_sensitivities: site_sensitivities(&layout, &benches, &uncertainty),
        unobservable: unobservable(
            &uncertainty
                .conditional
                .view((0, 0), (PARAMETERS, PARAMETERS))
                .into_owned(),
            &prior_sigma,
        ),
    };
    Ok((calibration, seen))
}

/// Solves the joint problem.
fn solve<'a, D, I>(
    task: &Task<'a, '_, D>,
    (mut problem, azimuths): ProblemAtGuess<'a, D, I>,
) -> Result<Solved<'a, D, I>, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let (solution, bounded) = match task.options.outlier_bound {
        Some(bound) => solve_robust(&mut problem, bound)?,
        None => (problem.solve(MAX_PASSES)?, vec![0; task.runs.len()]),
    };
    Ok(Solved {
        problem,
        solution,
        azimuths,
        bounded,
    })
}

/// The joint problem at its initial guess, with the search for each run's azimuth.
type ProblemAtGuess<'a, D, I> = (Problem<'a, D, I>, Vec<Option<AzimuthSearch>>);

/// The joint problem at its initial guess, and the search for each run's azimuth.
fn problem_at_guess<'a, D, I>(
    task: &Task<'a, '_, D>,
    start: Start,
    progress: &mut dyn FnMut(usize),
) -> Result<Guessed<ProblemAtGuess<'a, D, I>>, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let Task {
        runs,
        layout,
        options,
        ..
    } = *task;
    let mut problem = Problem {
        model: task.model,
        integration: options.discretisation.integration,
        longest_step_s: options.discretisation.longest_step_s,
        unknowns: layout.unknowns.clone(),
        runs: Vec::with_capacity(runs.len()),
        values: vec![0.0; layout.unknowns.len()],
    };
    let mut weights = [0.0; PARAMETERS];
    let mut azimuths = Vec::with_capacity(runs.len());
    let mut is_careful = true;
    for (index, run) in runs.iter().enumerate() {
        let settings = filter_settings(run.bench, options.moving_chart());
        let guess = initial_guess(run, &settings, options, start)
            .map_err(|error| error.of_record(index, runs.len()))?;
        let start = guess.start;
        is_careful &= start.by_windows;
        // Weighted means of the filters' drifts, which are those of gyros along the platform's axes.
        if task.gyro_axes.is_none() {
            for (i, sum) in weights.iter_mut().enumerate() {
                let weight: f64 = start.sigma[i].powi(-2);
                *sum += weight;
                problem.values[i] += (start.drift[i] - problem.values[i]) * weight / *sum;
            }
        }
        let points = match task.gyro_axes {
            Some(axes) => axes[index].trajectory(run.record, &guess.prior.orientation),
            None => start.points,
        };
        let mut run_problem = run_problem(
            run,
            run.record.len(),
            &settings,
            &guess.prior,
            points,
            layout.parameter_unknowns(index),
        );
        run_problem.rows.gyro_axes = task
            .gyro_axes
            .map(|axes| std::borrow::Cow::Borrowed(&axes[index]));
        // The weights of other outliers are found from the first solution.
        if options.outlier_bound.is_some() {
            for row in guess.gross_errors {
                run_problem.rows.exclude(row..row + 1);
            }
        }
        problem.runs.push(run_problem);
        azimuths.push(guess.azimuth);
        progress(run.record.len());
    }
    Ok(Guessed {
        guess: (problem, azimuths),
        is_careful,
    })
}

fn run_results<D, I>(
    solved: &Solved<'_, D, I>,
    layout: &Layout,
    uncertainty: &Uncertainty,
    options: &Options,
) -> Result<Vec<RunResult>, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let problem = &solved.problem;
    let attitude = |point: Option<&_>| point.map_or([[0.0; 3]; 3], platform_c_enu);
    let results = problem.runs.iter().enumerate().map(|(index, run)| {
        let turn_on_deg_per_h = layout.turn_ons[index].map(|first| {
            core::array::from_fn(|axis| {
                let unknown = first + axis;
                let place = uncertainty.estimated.iter().position(|e| *e == unknown);
                let variance = place.map_or(f64::NAN, |i| uncertainty.total[(i, i)]);
                [problem.values[unknown], variance.sqrt()]
            })
        });
        let noise = options.noise.then(|| noise_estimate(solved, index));
        Ok(RunResult {
            first_platform_c_enu: attitude(run.points.first()),
            last_platform_c_enu: attitude(run.points.last()),
            turn_on_deg_per_h,
            azimuth: solved.azimuths[index],
            noise: noise.transpose()?,
            bounded_values: solved.bounded[index],
        })
    });
    results.collect()
}

/// Maximum-likelihood estimate of a run's noise at the solution.
fn noise_estimate<D, I>(
    solved: &Solved<'_, D, I>,
    index: usize,
) -> Result<NoiseEstimate, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let parameters = solved.problem.parameters(index);
    solved.problem.with_run(index, &parameters, |pass| {
        let pass = pass.on(solved.solution.kept[index].as_deref());
        noise::estimate(|factors, first| {
            Pass { factors, ..pass }
                .noise_score_from(first)
                .map_err(|error| CalibrationError::pass(index, error))
        })
    })
}

/// Sensitivities of the coefficients to the considered parameters of the first run's site.
fn site_sensitivities(
    layout: &Layout,
    benches: &[&Bench],
    uncertainty: &Uncertainty,
) -> Vec<ConsiderSensitivity> {
    let Some(bench) = benches.first() else {
        return Vec::new();
    };
    SiteQuantity::ALL
        .into_iter()
        .filter_map(|quantity| {
            let unknown = layout.site_unknown(quantity);
            let considered = uncertainty
                .considered
                .iter()
                .find(|c| c.unknown == unknown)?;
            Some(ConsiderSensitivity {
                quantity,
                declared_sigma: quantity.declared_sigma(bench),
                from_record_sigma: considered.from_records_sigma,
                // A true value above the assumed one biases the estimates by the opposite of what
                // assuming the larger value would change.
                bias_per_unit: core::array::from_fn(|i| -considered.sensitivity[i]),
            })
        })
        .collect()
}
