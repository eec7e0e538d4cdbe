//! The batch estimator: from filtered trajectories to the joint solution.

use gyrocal::trajectory::{Orientation, angles_rad, platform_c_enu};
use gyrocal::{Anchored, Chart, Drift, Platform, Recentring, Settings};
use nalgebra::{Cholesky, DMatrix};

use crate::PARAMETERS;
use crate::attitude::{InitialAttitude, Trial, trials};
use crate::calibrate::{Calibration, Options};
use crate::error::CalibrationError;
use crate::fit::Fit;
use crate::layout::Layout;
use crate::run::{Rows, Run};
use crate::settings::level;
use crate::solve::{Failure, Leg, Problem, Solution};
use crate::start::{Start, filtered};

/// Passes after which an estimate that still moves is given up.
const MOST_ITERATIONS: usize = 50;

/// A mean NIS beyond which one pass of the filter has lost its way: three times what any model
/// error that is not gross leaves of it, far below what a filter astray has.
const ASTRAY: f64 = 30.0;

/// Rows of the first window of a start by growing windows.
const FIRST_WINDOW: usize = 64;

/// Calibrates on whole records.
pub(crate) fn calibrate(
    runs: &[Run<'_>],
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> Result<Calibration, CalibrationError> {
    let benches: Vec<_> = runs.iter().map(|run| run.bench).collect();
    let layout = Layout::new(&benches);
    let mut problem = Problem {
        model: &Anchored(Platform),
        integration: options.integration,
        longest_step_s: options.longest_step_s,
        unknowns: layout.unknowns.clone(),
        legs: Vec::with_capacity(runs.len()),
        values: layout
            .unknowns
            .iter()
            .map(|unknown| unknown.prior)
            .collect(),
    };
    let mut information = vec![0.0; PARAMETERS];
    for (index, run) in runs.iter().enumerate() {
        let settings = Settings {
            integration: options.integration,
            recentring: Recentring::EveryStep,
            longest_step_s: options.longest_step_s,
            ..level(run.bench)
        };
        let (prior, start) = begin(run, &settings, options)?;
        for i in 0..PARAMETERS {
            let weight = start.sigma[i].powi(-2);
            let sum = information[i] + weight;
            problem.values[i] += (start.drift[i] - problem.values[i]) * weight / sum;
            information[i] = sum;
        }
        let mut leg = leg(run, run.record.len(), &settings, &prior, start.points);
        leg.sums = layout.sums(index);
        problem.legs.push(leg);
        progress(run.record.len());
    }
    let solution = problem
        .solve(MOST_ITERATIONS, |_| ())
        .map_err(|failure| explain(failure, runs))?;
    report(&problem, &solution, &layout)
}

fn leg<'a>(
    run: &Run<'a>,
    rows: usize,
    settings: &Settings<f64>,
    prior: &InitialAttitude,
    points: Vec<Orientation>,
) -> Leg<'a> {
    Leg {
        rows: Rows::new(run.record, rows, [settings.accel_noise_g; 3]),
        chart: Chart::east_north_up(settings.site),
        noise_density: [settings.drift_noise_deg_per_h.powi(2) * 60.0; 3],
        prior: prior.orientation,
        prior_covariance: prior.covariance,
        points,
        sums: (0..PARAMETERS).map(|parameter| vec![parameter]).collect(),
    }
}

/// A start for one run, and the attitude prior that goes with it.
fn begin(
    run: &Run<'_>,
    settings: &Settings<f64>,
    options: &Options,
) -> Result<(InitialAttitude, Start), CalibrationError> {
    let mut trials = trials(run.record, run.bench)?.into_iter();
    match (trials.next(), trials.len()) {
        (Some(only), 0) => Ok((only.prior, start(run, settings, &only, options)?)),
        _ => todo!(),
    }
}

/// One pass of the filter if that finds its way; else windows that double in length, each solved
/// before the next begins, so that linearisation never reaches far beyond what is known.
fn start(
    run: &Run<'_>,
    settings: &Settings<f64>,
    trial: &Trial,
    options: &Options,
) -> Result<Start, CalibrationError> {
    let all = run.record.len();
    let first = filtered(run.record, all, settings, &trial.start);
    match first {
        Ok(start) if start.nis_mean < ASTRAY => return Ok(start),
        _ => {}
    }
    let mut settings_now = *settings;
    let mut attitude = trial.start;
    let mut window = FIRST_WINDOW;
    loop {
        let rows = window.min(all);
        let started = filtered(run.record, rows, &settings_now, &attitude)?;
        if rows == all {
            return Ok(started);
        }
        let mut problem = Problem {
            model: &Anchored(Platform),
            integration: options.integration,
            longest_step_s: options.longest_step_s,
            unknowns: Layout::new(&[run.bench]).unknowns,
            legs: vec![leg(run, rows, settings, &trial.prior, started.points)],
            values: started.drift.to_vec(),
        };
        // A window that does not converge leaves what it had: the next has more to go by.
        if let Ok(solution) = problem.solve(MOST_ITERATIONS, |_| ())
            && let Some(covariance) = covariance(&problem, &solution)
        {
            attitude.orientation = problem.legs[0].points[0];
            let mut sigma = settings.drift_sigma.to_array();
            for (i, sigma) in sigma.iter_mut().enumerate() {
                // Three times: linearisation errors of the window are not in its covariance.
                *sigma = sigma.min(3.0 * covariance[(i, i)].sqrt());
            }
            settings_now.drift = Drift::from_array(core::array::from_fn(|i| problem.values[i]));
            settings_now.drift_sigma = Drift::from_array(sigma);
        }
        window *= 2;
    }
}

/// Covariance of the unknowns that are estimated.
fn covariance<D>(problem: &Problem<'_, D>, solution: &Solution) -> Option<DMatrix<f64>>
where
    D: gyrocal::estimation::Manifold<3, 3, Inputs = Chart<f64>, Point = Orientation>,
{
    let estimated = problem.estimated();
    let count = estimated.len();
    let mut information = DMatrix::from_fn(count, count, |i, j| {
        solution.information[(estimated[i], estimated[j])]
    });
    for (i, index) in estimated.iter().enumerate() {
        information[(i, i)] += problem.unknowns[*index].sigma.powi(-2);
    }
    Cholesky::new(information).map(|cholesky| cholesky.inverse())
}

fn report<D>(
    problem: &Problem<'_, D>,
    solution: &Solution,
    layout: &Layout,
) -> Result<Calibration, CalibrationError>
where
    D: gyrocal::estimation::Manifold<3, 3, Inputs = Chart<f64>, Point = Orientation>,
{
    let _ = layout;
    let covariance = covariance(problem, solution).ok_or(CalibrationError::NotPositiveDefinite)?;
    let last = problem
        .legs
        .last()
        .and_then(|leg| leg.points.last())
        .map_or([[0.0; 3]; 3], platform_c_enu);
    Ok(Calibration {
        drift: Drift::from_array(core::array::from_fn(|i| problem.values[i])),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| covariance[(i, j)])),
        prior_sigma: Drift::from_array(core::array::from_fn(|i| problem.unknowns[i].sigma)),
        fit: Fit::of_batch(solution, &problem.unknowns, &covariance),
        platform_c_enu: last,
        final_angles_rad: angles_rad(&last),
        iterations: solution.iterations,
    })
}

fn explain(failure: Failure, runs: &[Run<'_>]) -> CalibrationError {
    let _ = runs;
    match failure {
        Failure::Pass(run, source) => CalibrationError::Pass {
            run: run + 1,
            source,
        },
        Failure::NoDescent { iterations } => CalibrationError::NoDescent { iterations },
        Failure::NotConverged {
            iterations,
            last_step,
        } => CalibrationError::NotConverged {
            iterations,
            last_step,
        },
        Failure::Singular => CalibrationError::NotPositiveDefinite,
    }
}
