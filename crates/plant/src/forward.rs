//! Simulation of a run with what is uncertain of parameters and initial states.

use std::sync::Arc;

use gyrocal_answer::PlantFit;
use gyrocal_hypothesis::ModelExtension;
use gyrocal_inference::stop;
use gyrocal_record::ResultTable;
use nalgebra::{DMatrix, DVector};

use crate::error::PlantError;
use crate::linearised::Linearised;
use crate::loaded::LoadedPlant;
use crate::problem::Problem;
use crate::record::NamedRecord;
use crate::solve::Solver;
use crate::starts::substeps;

/// A simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Time of each row, s.
    pub time_s: Vec<f64>,
    /// The states.
    pub states: Vec<SimulatedCourse>,
    /// The outputs, without noise of the sensors.
    pub outputs: Vec<SimulatedCourse>,
    /// Parameters that the fit held, since its record does not determine them: the standard deviations leave them out.
    pub held: Vec<String>,
}

/// A state or an output at each row.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedCourse {
    /// Its id.
    pub id: String,
    /// Its unit.
    pub unit: String,
    /// Its value at each row, in `unit`.
    pub values: Vec<f64>,
    /// Standard deviations of these from those of parameters and initial states, to first order.
    pub sigmas: Vec<f64>,
}

impl SimulatedCourse {
    /// The largest standard deviation, in `unit`.
    #[must_use]
    pub fn largest_sigma(&self) -> f64 {
        self.sigmas.iter().copied().fold(0.0, f64::max)
    }
}

impl Simulation {
    /// Time, then each state and output with its standard deviation (`ID_sigma`).
    #[must_use]
    pub fn table(&self) -> ResultTable {
        let time_s = self.time_s.iter().copied().map(Some);
        let table = ResultTable::default().numbers("time_s", time_s);
        let all = self.states.iter().chain(&self.outputs);
        all.fold(table, |table, one| {
            let [values, sigmas] =
                [&one.values, &one.sigmas].map(|own| own.iter().copied().map(Some));
            let table = table.numbers(one.id.clone(), values);
            table.numbers(format!("{}_sigma", one.id), sigmas)
        })
    }
}

/// Differences from the declared initial states and parameters, and the covariance of these.
struct Known {
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    held: Vec<String>,
}

/// Simulates a run with the estimates of a fit and their covariance; without a fit with the declared values, of which
/// those without a declared standard deviation count as exact. Readings of the run are not used, and rates have no noise.
///
/// # Errors
/// [`PlantError::Input`] of a fit of another plant, or of a run in which the model leaves the numbers.
pub fn simulate(
    plant: &LoadedPlant,
    run: NamedRecord,
    fit: Option<&PlantFit>,
) -> Result<Simulation, PlantError> {
    let known = match fit {
        Some(fit) => Known::of_fit(plant, fit)?,
        None => Known::declared(plant),
    };
    let mut problem = Problem::new(plant, Arc::new(run.record), 1);
    problem.substeps = substeps(&problem, &known.values);
    let noise = problem.declared_noise();
    let solver = Solver::new(&problem, &ModelExtension::default(), noise);
    let course = solver.course(&known.values);
    let mut dynamics = solver.dynamics();
    let points = dynamics.simulate(&course, &problem.initial(&known.values));
    stop::check()?;
    let description = &plant.description;
    let states = description.states.len();
    if let Some(place) = points.iter().position(|value| !value.is_finite()) {
        return Err(PlantError::Input {
            origin: run.name,
            problem: format!(
                "the model gives no finite numbers from row {} on",
                place / states + 1
            ),
            advice: "give inputs that the plant bears".to_owned(),
        });
    }
    let lin = dynamics.linearise(&course, &points)?;
    let rows = points.chunks_exact(states).enumerate();
    let outputs: Vec<f64> = rows
        .flat_map(|(row, here)| dynamics.outputs(row, &course, here))
        .collect();
    let [state_sigmas, output_sigmas] = sigmas(&lin, &known.covariance);
    let mut sigmas = state_sigmas.iter().chain(&output_sigmas);
    if outputs.iter().any(|value| !value.is_finite()) || sigmas.any(|sigma| !sigma.is_finite()) {
        return Err(PlantError::Input {
            origin: run.name,
            problem: "its outputs, or their standard deviations, are no finite numbers".to_owned(),
            advice: "give inputs that the plant bears".to_owned(),
        });
    }
    let state_names = description.states.iter().map(|one| (&one.id, &one.unit));
    let output_names = description.outputs.iter().map(|one| (&one.id, &one.unit));
    Ok(Simulation {
        time_s: problem.record.time_s.clone(),
        states: courses(state_names, &points, &state_sigmas),
        outputs: courses(output_names, &outputs, &output_sigmas),
        held: known.held,
    })
}

impl Known {
    fn declared(plant: &LoadedPlant) -> Self {
        let description = &plant.description;
        let states = description.states.iter().map(|state| state.sigma);
        let sigmas = states.chain(description.parameters.iter().map(|one| one.sigma));
        let variances = sigmas.map(|sigma| {
            if sigma.is_finite() {
                sigma * sigma
            } else {
                0.0
            }
        });
        let variances: Vec<f64> = variances.collect();
        Self {
            values: vec![0.0; variances.len()],
            covariance: DMatrix::from_diagonal(&DVector::from_vec(variances)),
            held: Vec::new(),
        }
    }

    /// Estimates by their names.
    fn of_fit(plant: &LoadedPlant, fit: &PlantFit) -> Result<Self, PlantError> {
        let description = &plant.description;
        let refuse = |problem: String| PlantError::Input {
            origin: format!("the fit of {}", fit.plant),
            problem,
            advice: format!("give what `plant fit --json` of {} wrote", description.name),
        };
        if fit.plant != description.name {
            return Err(refuse(format!("it is no fit of {}", description.name)));
        }
        let all = &fit.coefficients;
        let count = all.nominal.len();
        let rows = all.covariance.iter();
        if all.covariance.len() != count || rows.clone().any(|row| row.len() != count) {
            return Err(refuse(
                "its covariance has another size than its estimates".to_owned(),
            ));
        }
        let place = |name: String, declared: f64| {
            let mut own = all.nominal.iter();
            let found = own.position(|one| one.name == name);
            let found = found.ok_or_else(|| refuse(format!("it has no estimate of {name}")))?;
            Ok::<_, PlantError>((found, all.nominal[found].estimate - declared))
        };
        let states = description.states.iter();
        let states = states.map(|state| place(format!("initial {}", state.id), state.initial));
        let parameters = description.parameters.iter();
        let parameters = parameters.map(|one| place(one.id.clone(), one.value));
        let known: Vec<(usize, f64)> = states.chain(parameters).collect::<Result<_, _>>()?;
        Ok(Self {
            values: known.iter().map(|(_, value)| *value).collect(),
            covariance: DMatrix::from_fn(known.len(), known.len(), |i, j| {
                all.covariance[known[i].0][known[j].0]
            }),
            // What no record determines changes no output.
            held: fit
                .undetermined
                .iter()
                .filter(|direction| !direction.is_gauge)
                .filter_map(|direction| direction.held.clone())
                .collect(),
        })
    }
}

/// Standard deviations of states and of outputs, by rows, from the covariance of initial states and parameters.
fn sigmas(lin: &Linearised, covariance: &DMatrix<f64>) -> [Vec<f64>; 2] {
    let rows = &lin.rows;
    let (n, y, p) = (
        rows.layout.states,
        rows.layout.outputs,
        rows.layout.parameters.len(),
    );
    // Derivatives of the states by initial states and parameters.
    let mut by = DMatrix::identity(n, n + p);
    let deviations = |by: &DMatrix<f64>| -> Vec<f64> {
        let spread = by * covariance;
        let variances = (0..by.nrows()).map(|i| spread.row(i).dot(&by.row(i)));
        // Rounding may make a variance of nothing negative; the comparison leaves NaN as it is.
        let not_negative = variances.map(|variance| if variance < 0.0 { 0.0 } else { variance });
        not_negative.map(f64::sqrt).collect()
    };
    let with_parameters = |by_states: DMatrix<f64>, own: &[f64], by: &DMatrix<f64>| {
        let mut moved = &by_states * by;
        let own = DMatrix::from_row_slice(by_states.nrows(), p, own);
        let mut right = moved.columns_mut(n, p);
        right += own;
        moved
    };
    let count = rows.out_by_states.len() / (y * n).max(1);
    let (mut states, mut outputs) = (Vec::with_capacity(count * n), Vec::with_capacity(count * y));
    for row in 0..count {
        states.extend(deviations(&by));
        let here = DMatrix::from_row_slice(y, n, &rows.out_by_states[row * y * n..][..y * n]);
        let own = &rows.out_by_parameters[row * y * p..][..y * p];
        outputs.extend(deviations(&with_parameters(here, own, &by)));
        if row + 1 < count {
            let step = DMatrix::from_row_slice(n, n, &rows.by_states[row * n * n..][..n * n]);
            let own = &rows.by_parameters[row * n * p..][..n * p];
            by = with_parameters(step, own, &by);
        }
    }
    [states, outputs]
}

fn courses<'a>(
    names: impl ExactSizeIterator<Item = (&'a String, &'a String)>,
    values: &[f64],
    sigmas: &[f64],
) -> Vec<SimulatedCourse> {
    let count = names.len();
    let of = |all: &[f64], index: usize| all.iter().skip(index).step_by(count).copied().collect();
    let all = names
        .enumerate()
        .map(|(index, (id, unit))| SimulatedCourse {
            id: id.clone(),
            unit: unit.clone(),
            values: of(values, index),
            sigmas: of(sigmas, index),
        });
    all.collect()
}
