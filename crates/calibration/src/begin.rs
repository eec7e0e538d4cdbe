//! Where Gauss-Newton steps begin: at a filtered trajectory near enough to the solution.

use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::trajectory::{Orientation, rotation_between};
use gyrocal::{Anchored, Chart, ChartInputs, Drift, Settings, Surveyed};

use crate::attitude::{InitialAttitude, Trial, trials};
use crate::batch::MOST_ITERATIONS;
use crate::calibrate::Options;
use crate::error::CalibrationError;
use crate::further::Further;
use crate::gross_errors::gross_errors;
use crate::layout::Layout;
use crate::problem::{Leg, Problem};
use crate::result::AzimuthSearch;
use crate::run::{Rows, Run};
use crate::start::{Start, filtered};
use crate::uncertainty::Uncertainty;

/// A mean NIS beyond which one pass of the filter may have lost its way.
const ASTRAY: f64 = 10.0;

/// Rows of the first window of a start by growing windows.
const FIRST_WINDOW: usize = 16;

/// Rows over which azimuths are compared: two days of minutes.
const COMPARED_ROWS: usize = 2880;

/// Azimuths that are followed to their solution.
const FOLLOWED: usize = 3;

/// Solutions whose first attitudes differ by less are one, rad.
const SAME_ATTITUDE_RAD: f64 = 0.02;

/// A start for one run, the attitude prior that goes with it, and how its azimuth was found.
pub(crate) struct Beginning {
    pub(crate) prior: InitialAttitude,
    pub(crate) start: Start,
    pub(crate) azimuth: Option<AzimuthSearch>,
    /// Rows that it passes over: see [`gross_errors`].
    pub(crate) gross_errors: Vec<usize>,
}

/// Finds where to begin; `careful` goes by growing windows whatever the filter says.
pub(crate) fn begin(
    run: &Run<'_>,
    settings: &Settings<f64>,
    options: &Options,
    careful: bool,
) -> Result<Beginning, CalibrationError> {
    let gross_errors = gross_errors(run.record, settings.accel_noise_g);
    if gross_errors.is_empty() {
        return begin_through(run, settings, options, careful);
    }
    let values = gross_errors
        .iter()
        .flat_map(|row| [0, 1, 2].map(|axis| [*row, axis]));
    let run = Run {
        record: &run.record.without(values),
        bench: run.bench,
    };
    Ok(Beginning {
        gross_errors,
        ..begin_through(&run, settings, options, careful)?
    })
}

/// The same through all rows.
fn begin_through(
    run: &Run<'_>,
    settings: &Settings<f64>,
    options: &Options,
    careful: bool,
) -> Result<Beginning, CalibrationError> {
    let trials = trials(run.record, run.bench)?;
    if let [only] = trials.as_slice() {
        return Ok(Beginning {
            prior: only.prior,
            start: start(run, run.record.len(), settings, only, options, careful)?,
            azimuth: None,
            gross_errors: Vec::new(),
        });
    }
    let (chosen, search) = search(run, settings, &trials, options)?;
    Ok(Beginning {
        prior: chosen.prior,
        start: start(run, run.record.len(), settings, &chosen, options, careful)?,
        azimuth: Some(search),
        gross_errors: Vec::new(),
    })
}

pub(crate) fn leg<'a, I: ChartInputs<f64>>(
    run: &Run<'a>,
    rows: usize,
    settings: &Settings<f64>,
    prior: &InitialAttitude,
    points: Vec<Orientation>,
    sums: Vec<Vec<usize>>,
) -> Leg<'a, I> {
    Leg {
        rows: Rows::new(run.record, rows, [settings.accel_noise_g; 3]),
        chart: Chart::for_model(settings.site),
        noise_density: [settings.drift_noise_density(); 3],
        prior: prior.orientation,
        prior_covariance: prior.covariance,
        points,
        sums,
        further: Further::default(),
        amplitudes: Vec::new(),
    }
}

/// One run by itself, to be solved over its first rows.
pub(crate) fn alone<'a>(
    run: &Run<'a>,
    rows: usize,
    settings: &Settings<f64>,
    prior: &InitialAttitude,
    start: &Start,
    options: &Options,
) -> Problem<'a, Anchored<Surveyed>, SurveyedInputs<f64>> {
    let layout = Layout::new(&[run.bench]);
    let mut values = vec![0.0; layout.unknowns.len()];
    values[..start.drift.len()].copy_from_slice(&start.drift);
    Problem {
        model: &Anchored(Surveyed),
        integration: options.integration,
        longest_step_s: options.longest_step_s,
        legs: vec![leg(
            run,
            rows,
            settings,
            prior,
            start.points.clone(),
            layout.sums(0),
        )],
        unknowns: layout.unknowns,
        values,
    }
}

/// One pass of the filter if that finds its way; else windows that grow by half, each solved
/// before the next begins, so that linearisation never reaches far beyond what is known.
fn start(
    run: &Run<'_>,
    all: usize,
    settings: &Settings<f64>,
    trial: &Trial,
    options: &Options,
    careful: bool,
) -> Result<Start, CalibrationError> {
    if !careful
        && let Ok(start) = filtered(run.record, all, settings, &trial.start)
        && start.nis_mean < ASTRAY
    {
        return Ok(start);
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
        let mut problem = alone(run, rows, settings, &trial.prior, &started, options);
        // A window that does not converge leaves what it had: the next has more to go by.
        if let Ok(solution) = problem.solve(MOST_ITERATIONS, |_| ())
            && let Some(uncertainty) = Uncertainty::new(&problem.unknowns, &solution)
        {
            attitude.orientation = problem.legs[0].points[0];
            let mut sigma = settings.drift_sigma.to_array();
            for (i, sigma) in sigma.iter_mut().enumerate() {
                // Three times: linearisation errors of the window are not in its covariance.
                *sigma = sigma.min(3.0 * uncertainty.conditional[(i, i)].sqrt());
            }
            settings_now.drift = Drift::from_array(core::array::from_fn(|i| problem.values[i]));
            settings_now.drift_sigma = Drift::from_array(sigma);
        }
        // Half as long again: over twice the time a wide prior goes astray.
        window += window / 2;
    }
}

/// Where a trial leads.
struct Followed {
    log_likelihood: f64,
    orientation: Orientation,
    /// Whether residuals are about as large as the noise.
    fits: bool,
}

/// A trial's solution over the first rows; `None` if it has none.
fn follow(
    run: &Run<'_>,
    rows: usize,
    settings: &Settings<f64>,
    trial: &Trial,
    start: &Start,
    options: &Options,
) -> Option<Followed> {
    let mut problem = alone(run, rows, settings, &trial.prior, start, options);
    let solution = problem.solve(MOST_ITERATIONS, |_| ()).ok()?;
    let uncertainty = Uncertainty::new(&problem.unknowns, &solution)?;
    Some(Followed {
        log_likelihood: -0.5
            * (solution.cost + solution.log_variance - uncertainty.log_determinant()),
        orientation: problem.legs[0].points[0],
        fits: solution.cost < ASTRAY * solution.values as f64,
    })
}

/// Tries azimuths on the first rows: the filter ranks them, the best are followed to their
/// solutions, and the likeliest solution is taken.
fn search(
    run: &Run<'_>,
    settings: &Settings<f64>,
    trials: &[Trial],
    options: &Options,
) -> Result<(Trial, AzimuthSearch), CalibrationError> {
    let rows = run.record.len().min(COMPARED_ROWS);
    let mut passes: Vec<(&Trial, Start)> = trials
        .iter()
        .filter_map(|trial| {
            let start = filtered(run.record, rows, settings, &trial.start).ok()?;
            Some((trial, start))
        })
        .collect();
    passes.sort_by(|a, b| a.1.nis_mean.total_cmp(&b.1.nis_mean));
    let mut solutions: Vec<(f64, Orientation, &Trial)> = Vec::new();
    let mut fits = false;
    for (index, (trial, start)) in passes.iter().enumerate() {
        // A start may end in a valley of its own: go on until one fits the record.
        if fits && index >= FOLLOWED {
            break;
        }
        if let Some(followed) = follow(run, rows, settings, trial, start, options) {
            fits |= followed.fits;
            solutions.push((followed.log_likelihood, followed.orientation, trial));
        }
    }
    if !fits {
        for trial in trials {
            let Ok(start) = start(run, rows, settings, trial, options, true) else {
                continue;
            };
            if let Some(followed) = follow(run, rows, settings, trial, &start, options) {
                solutions.push((followed.log_likelihood, followed.orientation, trial));
            }
        }
    }
    solutions.sort_by(|a, b| b.0.total_cmp(&a.0));
    let Some((best, orientation, trial)) = solutions.first() else {
        return Err(CalibrationError::NoAzimuth {
            starts: trials.len(),
        });
    };
    let other = solutions.iter().skip(1).find_map(|(likelihood, other, _)| {
        let turn = rotation_between(orientation, other);
        let angle = turn.iter().map(|x| x * x).sum::<f64>().sqrt();
        let about_up: f64 = turn.iter().zip(&orientation[1]).map(|(a, b)| a * b).sum();
        (angle > SAME_ATTITUDE_RAD).then_some((best - likelihood, about_up))
    });
    let (margin, other_rad) = other.unwrap_or((f64::INFINITY, 0.0));
    let at_solution = |attitude: &InitialAttitude| InitialAttitude {
        orientation: *orientation,
        ..*attitude
    };
    Ok((
        Trial {
            prior: at_solution(&trial.prior),
            start: at_solution(&trial.start),
        },
        AzimuthSearch {
            starts: trials.len(),
            margin,
            other_rad,
        },
    ))
}
