//! The batch estimator: from filtered trajectories to the joint solution.

use gyrocal::estimation::Manifold;
use gyrocal::estimation::batch::Linearisation;
use gyrocal::trajectory::{Orientation, angles_rad, platform_c_enu};
use gyrocal::{Chart, Drift, Recentring, Settings};

use crate::PARAMETERS;
use crate::begin::{begin, leg};
use crate::calibrate::Options;
use crate::error::CalibrationError;
use crate::fit::FitStatistics;
use crate::gyro_axes::GyroAxes;
use crate::layout::{Layout, SiteQuantity};
use crate::noise;
use crate::observability::unobservable;
use crate::problem::Problem;
use crate::result::{AzimuthSearch, Calibration, ConsiderSensitivity, RunResult};
use crate::robust;
use crate::run::{Conditions, Run};
use crate::settings::level;
use crate::solve::{Failure, Solution};
use crate::uncertainty::Uncertainty;

/// Steps after which an estimate that still moves is given up.
pub(crate) const MOST_ITERATIONS: usize = 50;

/// Calibrates on whole records with a model whose parameters are those of
/// [`gyrocal::Surveyed`]; `gyro_axes`, one for each run, for models in which gyros do not lie
/// along the platform's axes.
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
    let benches: Vec<_> = runs.iter().map(|run| run.bench).collect();
    let layout = Layout::new(&benches);
    let solve = |careful: bool, progress: &mut dyn FnMut(usize)| {
        let (mut problem, azimuths) =
            problem(model, runs, gyro_axes, &layout, options, careful, progress)?;
        let (solution, bounded) = match options.outlier_bound {
            Some(bound) => robust::solve(&mut problem, bound, MOST_ITERATIONS),
            None => problem
                .solve(MOST_ITERATIONS, |_| ())
                .map(|solution| (solution, vec![0; runs.len()])),
        }
        .map_err(CalibrationError::from)?;
        Ok::<_, CalibrationError>((problem, azimuths, solution, bounded))
    };
    // One pass of the filter is start enough for nearly every record.
    let (problem, azimuths, solution, bounded) =
        solve(false, progress).or_else(|_| solve(true, progress))?;
    let uncertainty = Uncertainty::new(&problem.unknowns, &solution)
        .ok_or(CalibrationError::NotPositiveDefinite)?;
    let runs = run_results(
        &problem,
        &solution,
        &layout,
        &uncertainty,
        azimuths,
        &bounded,
        options,
    )?;
    let last = runs
        .last()
        .map_or([[0.0; 3]; 3], |run| run.last_platform_c_enu);
    let prior_sigma: [f64; PARAMETERS] = core::array::from_fn(|i| problem.unknowns[i].sigma);
    Ok(Calibration {
        drift: Drift::from_array(core::array::from_fn(|i| problem.values[i])),
        covariance: core::array::from_fn(|i| core::array::from_fn(|j| uncertainty.total[(i, j)])),
        prior_sigma: Drift::from_array(prior_sigma),
        fit: FitStatistics::of_batch(&solution, &problem.unknowns, &uncertainty),
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
    })
}

/// A joint problem, and how the azimuth of each record was found.
type Started<'a, D, I> = (Problem<'a, D, I>, Vec<Option<AzimuthSearch>>);

/// The joint problem at its start.
fn problem<'a, D, I>(
    model: &'a D,
    runs: &[Run<'a>],
    gyro_axes: Option<&'a [GyroAxes]>,
    layout: &Layout,
    options: &Options,
    careful: bool,
    progress: &mut dyn FnMut(usize),
) -> Result<Started<'a, D, I>, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    let mut problem = Problem {
        model,
        integration: options.integration,
        longest_step_s: options.longest_step_s,
        unknowns: layout.unknowns.clone(),
        legs: Vec::with_capacity(runs.len()),
        values: vec![0.0; layout.unknowns.len()],
    };
    let mut weights = [0.0; PARAMETERS];
    let mut azimuths = Vec::with_capacity(runs.len());
    for (index, run) in runs.iter().enumerate() {
        let settings = Settings {
            integration: options.integration,
            recentring: Recentring::EveryStep,
            longest_step_s: options.longest_step_s,
            ..level(run.bench)
        };
        let beginning = begin(run, &settings, options, careful)
            .map_err(|error| error.of_record(index, runs.len()))?;
        let start = beginning.start;
        // The filter's drifts are those of gyros along the platform's axes.
        if gyro_axes.is_none() {
            for (i, sum) in weights.iter_mut().enumerate() {
                let weight: f64 = start.sigma[i].powi(-2);
                *sum += weight;
                problem.values[i] += (start.drift[i] - problem.values[i]) * weight / *sum;
            }
        }
        let prior = beginning.prior;
        let mut leg = leg(
            run,
            run.record.len(),
            &settings,
            &prior,
            start.points,
            layout.sums(index),
        );
        leg.rows.gyro_axes = gyro_axes.map(|axes| &axes[index]);
        // Weights of the others are found from where the first solution is.
        if options.outlier_bound.is_some() {
            for row in beginning.gross_errors {
                leg.rows.leave_out(row..row + 1);
            }
        }
        problem.legs.push(leg);
        azimuths.push(beginning.azimuth);
        progress(run.record.len());
    }
    Ok((problem, azimuths))
}

fn run_results<D, I>(
    problem: &Problem<'_, D, I>,
    solution: &Solution,
    layout: &Layout,
    uncertainty: &Uncertainty,
    azimuths: Vec<Option<AzimuthSearch>>,
    bounded: &[usize],
    options: &Options,
) -> Result<Vec<RunResult>, CalibrationError>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    azimuths
        .into_iter()
        .enumerate()
        .map(|(index, azimuth)| {
            let points = &problem.legs[index].points;
            let attitude = |point: Option<&_>| point.map_or([[0.0; 3]; 3], platform_c_enu);
            let turn_on_deg_per_h = layout.turn_ons[index].map(|first| {
                core::array::from_fn(|axis| {
                    let unknown = first + axis;
                    let place = uncertainty.estimated.iter().position(|e| *e == unknown);
                    let variance = place.map_or(f64::NAN, |i| uncertainty.total[(i, i)]);
                    [problem.values[unknown], variance.sqrt()]
                })
            });
            let noise = if options.noise {
                let parameters = problem.parameters(index);
                let found = problem.with_leg(index, &parameters, |pass| {
                    let tape = solution.tapes[index].as_deref();
                    let pass = Linearisation { tape, ..*pass };
                    noise::estimate(|factors| pass.noise_score(factors))
                });
                Some(found.map_err(|error| CalibrationError::from(Failure::Pass(index, error)))?)
            } else {
                None
            };
            Ok(RunResult {
                first_platform_c_enu: attitude(points.first()),
                last_platform_c_enu: attitude(points.last()),
                turn_on_deg_per_h,
                azimuth,
                noise,
                bounded_values: bounded[index],
            })
        })
        .collect()
}

fn site_sensitivities(
    layout: &Layout,
    benches: &[&gyrocal_record::Bench],
    uncertainty: &Uncertainty,
) -> Vec<ConsiderSensitivity> {
    let Some(bench) = benches.first() else {
        return Vec::new();
    };
    SiteQuantity::ALL
        .into_iter()
        .filter_map(|quantity| {
            let unknown = layout.site_unknown(quantity);
            let find = |(index, _): &&(usize, _)| *index == unknown;
            let (_, taken) = uncertainty
                .sensitivities
                .iter()
                .find(|(i, _)| *i == unknown)?;
            let (_, from_record_sigma) = uncertainty.from_records.iter().find(find)?;
            Some(ConsiderSensitivity {
                quantity,
                declared_sigma: quantity.declared_sigma(bench),
                from_record_sigma: *from_record_sigma,
                // An error that is there and not assumed is taken for the opposite of what
                // assuming it would change.
                bias_per_unit: core::array::from_fn(|i| -taken[i]),
            })
        })
        .collect()
}
