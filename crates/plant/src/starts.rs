//! Where a fit starts.
//!
//! The usual start is a simulation with the declared values. Where the fit from there is poor, the fit is
//! led to the data: with noise of all states in every step the trajectory follows the outputs, and the
//! noise falls until none is left. This is repeated from random parameters until two starts end at the
//! same best fit.

use gyrocal_answer::Starts;
use gyrocal_hypothesis::ModelExtension;
use gyrocal_inference::stop;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::format::short;
use gyrocal_statistics::math::exp;
use gyrocal_words::behind;

use crate::dynamics::Dynamics;
use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;
use crate::lines::Course;
use crate::problem::Problem;
use crate::solve::{Iterate, Solution, Solver};

/// Deviance a value above which other starts are tried: what an effect of fifty standard deviations
/// leaves in a thousand values is less.
const POOR: f64 = 4.0;

/// Costs that differ by less are those of the same fit.
const SAME: f64 = 0.5;

/// Standard deviations of the noise of a step on the way, over the size of each state.
const LEVELS: [f64; 4] = [0.1, 0.01, 1e-3, 1e-4];

/// Standard deviation of a parameter without a prior on the way, over its size.
const LOOSE_PRIOR: f64 = 1.0;

/// Most random starts.
const MOST: usize = 8;

/// Standard deviation of the logarithm of a random parameter over its declared value.
const SPREAD: f64 = 0.5;

/// Difference of simulations with one and two steps between rows, in standard deviations of the noise, that
/// counts as none.
const RESOLVED: f64 = 0.05;

/// Relative difference of the derivatives of all steps with one and two steps between rows that counts as
/// none, and the most steps for it.
const SENSITIVE: f64 = 0.03;
const MOST_SENSITIVE: usize = 4;

/// Most Runge-Kutta steps between rows.
const MOST_SUBSTEPS: usize = 64;

/// The best fit of the nominal model.
pub(crate) fn best(
    problem: &Problem,
    noise: &FittedNoise,
    first: Option<&[f64]>,
) -> Result<(Solution, Starts), PlantError> {
    let mut found: Vec<Solution> = Vec::new();
    let mut failed = Failed::default();
    let mut starts = Starts {
        tried: 1,
        agreeing: 0,
    };
    let declared = vec![0.0; problem.nominal()];
    let values = first.unwrap_or(&declared);
    match simulated(problem, noise, values) {
        Ok(solution) => found.push(solution),
        Err(error) => failed.take(error),
    }
    let count = problem
        .record
        .outputs
        .iter()
        .filter(|value| !value.is_nan())
        .count();
    let is_poor = |solution: &Solution| solution.cost > POOR * count as f64;
    let mut draw = Draw::new(0, 0);
    for index in 0..=MOST {
        if found.first().is_some_and(|best| !is_poor(best)) {
            break;
        }
        if found.len() >= 2 && found[1].cost - found[0].cost < SAME {
            break;
        }
        let values = if index == 0 {
            values.to_vec()
        } else {
            random(problem, &mut draw)
        };
        starts.tried += 1;
        match led(problem, noise, &values) {
            Ok(solution) => found.push(solution),
            Err(error) => failed.take(error),
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }
    let least = found.first().map_or(f64::INFINITY, |best| best.cost);
    starts.agreeing = found.iter().filter(|one| one.cost - least < SAME).count();
    let best = found.into_iter().next();
    let best = best.map(|best| (best, starts));
    stop::finished(best.ok_or_else(|| failed.of(problem, count)))
}

/// Why starts failed, and how near the nearest came.
#[derive(Default)]
struct Failed {
    reason: String,
    reached: Option<Box<(f64, Vec<f64>)>>,
}

impl Failed {
    /// Takes another failure in, if it came nearer.
    fn take(&mut self, error: PlantError) {
        let (reason, reached) = match error {
            PlantError::NoFit { reason, reached } => (reason, reached),
            other => (other.to_string(), None),
        };
        let cost = |one: &Option<Box<(f64, Vec<f64>)>>| one.as_ref().map(|one| one.0);
        let nearer = match (cost(&reached), cost(&self.reached)) {
            (Some(new), Some(old)) => new < old,
            (new, old) => new.is_some() || old.is_none(),
        };
        if nearer {
            *self = Self { reason, reached };
        }
    }

    /// The error, with the best fit so far in words.
    fn of(self, problem: &Problem, readings: usize) -> PlantError {
        let Self {
            mut reason,
            reached,
        } = self;
        if let Some((cost, values)) = reached.as_deref() {
            let description = &problem.plant.description;
            let states = description.states.iter();
            let states = states.map(|one| (format!("initial {}", one.id), one.initial, &*one.unit));
            let parameters = description.parameters.iter();
            let parameters = parameters.map(|one| (one.id.clone(), one.value, &*one.unit));
            let all = states.chain(parameters).zip(values);
            let all = all.map(|((name, declared, unit), value)| {
                format!("{name} {}{}", short(declared + value, 4), behind(unit))
            });
            let all: Vec<String> = all.collect();
            reason += &format!(
                "; the best fit so far leaves residuals of {} times the declared noise, at {}",
                short((cost / readings.max(1) as f64).sqrt(), 3),
                all.join(", ")
            );
        }
        PlantError::NoFit { reason, reached }
    }
}

/// From a simulation.
fn simulated(
    problem: &Problem,
    noise: &FittedNoise,
    values: &[f64],
) -> Result<Solution, PlantError> {
    let extension = ModelExtension::default();
    let solver = Solver::new(problem, &extension, noise.clone());
    let values = &solver.with_first_values(values, &solver.searched());
    let course = solver.course(values);
    let mut dynamics = solver.dynamics();
    let points = dynamics.simulate(&course, &problem.initial(values));
    if let Some(place) = points.iter().position(|value| !value.is_finite()) {
        let row = place / problem.plant.description.states.len();
        return Err(PlantError::NotFinite { row });
    }
    let values = values.to_vec();
    solver.solve(Iterate { points, values })
}

/// Led to the data by noise that falls.
fn led(problem: &Problem, noise: &FittedNoise, values: &[f64]) -> Result<Solution, PlantError> {
    let extension = ModelExtension::default();
    let sizes = state_sizes(problem, values);
    let initial = problem.initial(values);
    let mut at = Iterate {
        points: initial.repeat(problem.record.len()),
        values: values.to_vec(),
    };
    for level in LEVELS {
        let mut solver = Solver::new(problem, &extension, noise.clone());
        let loose = sizes.iter().map(|size| (level * size).powi(2));
        solver.noise.loose = loose.collect();
        let parameters = problem.plant.description.parameters.iter();
        let states = sizes.len();
        for (sigma, own) in solver.sigmas[states..].iter_mut().zip(parameters) {
            let size = if own.value == 0.0 {
                1.0
            } else {
                own.value.abs()
            };
            *sigma = sigma.min(LOOSE_PRIOR * size);
        }
        // The next level starts from here all the same.
        if let Ok(solution) = solver.solve(at.clone()) {
            at = solution.at;
        }
    }
    let solver = Solver::new(problem, &extension, noise.clone());
    let own = solver.solve(at.clone());
    // A trajectory that was led may be better as a simulation.
    own.or_else(|_| simulated(problem, noise, &at.values))
}

/// A model with known parameters led to the data, which its initial states alone are to fit.
pub(crate) fn led_by(solver: &Solver<'_>, sizes: &[f64]) -> Result<Solution, PlantError> {
    if !solver.noise.is_declared() {
        // Noise that the plant does not declare goes on from where the declared one leads.
        let declared = with_noise(solver, solver.noise.loosened(Vec::new()));
        if let Ok(found) = led_by(&declared, sizes) {
            return Ok(solver.solve(found.at.clone()).unwrap_or(found));
        }
    }
    let problem = solver.problem;
    let values = vec![0.0; solver.lines.len()];
    let mut at = Iterate {
        points: problem.initial(&values).repeat(problem.record.len()),
        values,
    };
    for level in LEVELS {
        let loose = sizes.iter().map(|size| (level * size).powi(2)).collect();
        let own = with_noise(solver, solver.noise.loosened(loose));
        if let Ok(solution) = own.solve(at.clone()) {
            at = solution.at;
        }
    }
    solver.solve(at.clone()).or_else(|error| {
        // A trajectory that was led may be better as a simulation.
        let course = solver.course(&at.values);
        let mut dynamics = solver.dynamics();
        let points = dynamics.simulate(&course, &problem.initial(&at.values));
        if !points.iter().all(|value| value.is_finite()) {
            return Err(error);
        }
        solver.solve(Iterate {
            points,
            values: at.values,
        })
    })
}

/// The same model in other noise.
fn with_noise<'a>(solver: &Solver<'a>, noise: FittedNoise) -> Solver<'a> {
    Solver {
        problem: solver.problem,
        lines: solver.lines.clone(),
        sigmas: solver.sigmas.clone(),
        base: solver.base.clone(),
        parameters: solver.parameters.clone(),
        noise,
    }
}

/// Sizes of the states: of a simulation, or before the record.
fn state_sizes(problem: &Problem, values: &[f64]) -> Vec<f64> {
    let solver = Solver::new(
        problem,
        &ModelExtension::default(),
        problem.declared_noise(),
    );
    let course = solver.course(values);
    let mut dynamics = solver.dynamics();
    let points = dynamics.simulate(&course, &problem.initial(values));
    let states = &problem.plant.description.states;
    let (n, rows) = (states.len(), problem.record.len() as f64);
    states
        .iter()
        .enumerate()
        .map(|(i, state)| {
            let own = points.iter().skip(i).step_by(n);
            let root = (own.map(|value| value * value).sum::<f64>() / rows).sqrt();
            let known = if state.sigma.is_finite() {
                state.sigma
            } else {
                state.initial.abs()
            };
            match (root.is_finite() && root < 1e6 * known.max(1.0), known > 0.0) {
                (true, _) if root > 0.0 => root.max(known),
                (_, true) => known,
                _ => 1.0,
            }
        })
        .collect()
}

/// Random parameters about the declared ones; initial states as declared.
fn random(problem: &Problem, draw: &mut Draw) -> Vec<f64> {
    let states = problem.plant.description.states.len();
    let mut values = vec![0.0; states];
    values.extend(problem.plant.description.parameters.iter().map(|own| {
        if own.value == 0.0 {
            0.1 * draw.normal()
        } else {
            own.value * (exp(SPREAD * draw.normal()) - 1.0)
        }
    }));
    values
}

/// Runge-Kutta steps between rows that resolve the derivatives by all parameters: a sign among the terms of
/// a catalogue changes within a step that the simulation itself does not need to divide.
fn sensitive_substeps(problem: &Problem, course: &Course, initial: &[f64]) -> usize {
    let columns = |substeps: usize| {
        let mut dynamics = Dynamics::new(&problem.plant, &problem.record, substeps);
        let points = dynamics.simulate(course, initial);
        let lin = dynamics.linearise(course, &points).ok()?;
        Some(lin.rows.by_parameters)
    };
    let sizes = problem.plant.functions.sizes();
    let mut count = 1;
    let Some(mut coarse) = columns(count) else {
        return 1;
    };
    while count < MOST_SENSITIVE {
        let Some(fine) = columns(2 * count) else {
            return count;
        };
        let (mut off, mut whole) = (vec![0.0; sizes.parameters], vec![0.0; sizes.parameters]);
        for (place, (coarse, fine)) in coarse.iter().zip(&fine).enumerate() {
            off[place % sizes.parameters] += (coarse - fine).powi(2);
            whole[place % sizes.parameters] += fine * fine;
        }
        let worst = off
            .iter()
            .zip(&whole)
            .map(|(off, whole)| if *whole > 0.0 { off / whole } else { 0.0 });
        if worst.fold(0.0, f64::max) < SENSITIVE * SENSITIVE {
            break;
        }
        count *= 2;
        coarse = fine;
    }
    count
}

/// Runge-Kutta steps between rows that resolve a simulation with these values.
pub(crate) fn substeps(problem: &Problem, values: &[f64]) -> usize {
    let noise = problem.declared_noise();
    let solver = Solver::new(problem, &ModelExtension::default(), noise);
    let course = solver.course(values);
    let initial = problem.initial(values);
    let outputs = |substeps: usize| {
        let (plant, record) = (&problem.plant, &problem.record);
        let mut dynamics = Dynamics::narrowed(plant, record, substeps, (&course, &[]));
        let points = dynamics.simulate(&course, &initial);
        let n = initial.len();
        let rows = points.chunks_exact(n).enumerate();
        rows.map(|(row, states)| dynamics.outputs(row, &course, states))
            .collect::<Vec<_>>()
    };
    let sigmas = problem.plant.description.outputs.iter();
    let sigmas: Vec<f64> = sigmas.map(|output| output.sigma).collect();
    let mut count = sensitive_substeps(problem, &course, &initial);
    let mut coarse = outputs(count);
    while count < MOST_SUBSTEPS {
        let fine = outputs(2 * count);
        let pairs = coarse.iter().flatten().zip(fine.iter().flatten());
        let errors = pairs
            .enumerate()
            .map(|(place, (coarse, fine))| (coarse - fine).abs() / sigmas[place % sigmas.len()]);
        let worst = errors.fold(0.0, f64::max);
        let is_finite = coarse
            .iter()
            .chain(&fine)
            .flatten()
            .all(|one| one.is_finite());
        if is_finite && worst < RESOLVED {
            break;
        }
        if !is_finite && count >= 4 {
            // The simulation runs away by itself: the model is unstable, and no step is too long for that.
            return 1;
        }
        count *= 2;
        coarse = fine;
    }
    count
}
