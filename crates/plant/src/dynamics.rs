//! Steps of a plant from row to row, with their exact derivatives.

mod step_memory;

use std::sync::Arc;

use gyrocal_inference::{Layout, LinearisedRows, stop};

use crate::error::PlantError;
use crate::functions::{Functions, OutputsAt, Point, Sizes, Workspace};
use crate::late::LateInput;
use crate::linearised::Linearised;
use crate::lines::Course;
use crate::loaded::LoadedPlant;
use crate::record::PlantRecord;
use step_memory::StepMemory;

/// Shares of a step at which a classical Runge-Kutta rule takes the rates, and their weights.
const STAGES: [(f64, f64); 4] = [
    (0.0, 1.0 / 6.0),
    (0.5, 1.0 / 3.0),
    (0.5, 1.0 / 3.0),
    (1.0, 1.0 / 6.0),
];

/// Evaluation of a plant along a record.
pub(crate) struct Dynamics<'a> {
    plant: &'a LoadedPlant,
    functions: Arc<dyn Functions>,
    /// Parameters that derivatives are taken by.
    wanted: Arc<[usize]>,
    record: &'a PlantRecord,
    /// Runge-Kutta steps between rows.
    substeps: usize,
    sizes: Sizes,
    workspace: Workspace,
    inputs: Vec<f64>,
    interpolate: Vec<bool>,
    parameters: Vec<f64>,
    /// Inputs that act late, or whose dead time derivatives are taken by.
    late: Vec<LateInput>,
}

impl<'a> Dynamics<'a> {
    /// With derivatives by all parameters.
    pub(crate) fn new(plant: &'a LoadedPlant, record: &'a PlantRecord, substeps: usize) -> Self {
        let all = (0..plant.functions.sizes().parameters).collect();
        let late = plant.description.delays.iter().copied().map(LateInput::new);
        Self {
            late: late.collect(),
            ..Self::of(plant, record, substeps, (Arc::clone(&plant.functions), all))
        }
    }

    /// Of courses that change no parameters but the wanted ones and those that `course` has; with
    /// derivatives by the wanted ones alone.
    pub(crate) fn narrowed(
        plant: &'a LoadedPlant,
        record: &'a PlantRecord,
        substeps: usize,
        (course, wanted): (&Course, &[usize]),
    ) -> Self {
        let mut is_wanted = vec![false; plant.functions.sizes().parameters];
        for index in wanted {
            is_wanted[*index] = true;
        }
        let parameters = is_wanted.iter().enumerate();
        let mut is_zero: Vec<bool> = parameters
            .map(|(index, wanted)| !wanted && course.is_zero(index))
            .collect();
        let mut late = Vec::new();
        for delay in &plant.description.delays {
            if !is_zero[delay.time] {
                is_zero[delay.constant] = false;
                is_wanted[delay.constant] |= is_wanted[delay.time];
                late.push(LateInput::new(*delay));
            }
        }
        let functions = plant.functions.narrowed(&is_zero, &is_wanted);
        let functions = functions.unwrap_or_else(|| Arc::clone(&plant.functions));
        Self {
            late,
            ..Self::of(plant, record, substeps, (functions, wanted.into()))
        }
    }

    fn of(
        plant: &'a LoadedPlant,
        record: &'a PlantRecord,
        substeps: usize,
        (functions, wanted): (Arc<dyn Functions>, Arc<[usize]>),
    ) -> Self {
        let sizes = plant.functions.sizes();
        let inputs = plant.description.inputs.iter();
        Self {
            plant,
            record,
            substeps,
            sizes,
            workspace: functions.workspace(),
            functions,
            wanted,
            inputs: vec![0.0; sizes.inputs],
            interpolate: inputs.map(|input| input.interpolate).collect(),
            parameters: vec![0.0; sizes.parameters],
            late: Vec::new(),
        }
    }

    /// Sets the dead times of a course.
    fn set_late(&mut self, course: &Course) {
        for late in &mut self.late {
            let time_s = course.constant[late.delay.time];
            let interpolate = self.interpolate[late.delay.input];
            late.set(time_s, self.record, self.sizes.inputs, interpolate);
        }
    }

    /// Sets the parameters in the step after a row.
    fn set_parameters(&mut self, row: usize, course: &Course) {
        self.set_late(course);
        course.at(row, &mut self.parameters);
        for late in &mut self.late {
            late.beside = self.parameters[late.delay.constant];
        }
    }

    fn set_inputs(&mut self, row: usize, share: f64) {
        let count = self.sizes.inputs;
        for index in 0..count {
            let here = self.record.inputs[row * count + index];
            let next = self.record.inputs.get((row + 1) * count + index);
            self.inputs[index] = match next {
                Some(next) if self.interpolate[index] => here + share * (next - here),
                _ => here,
            };
        }
        for late in &mut self.late {
            let logged = self.inputs[late.delay.input];
            self.parameters[late.delay.constant] = late.beside + late.less(row, share, logged);
        }
    }

    fn interval_s(&self, row: usize) -> f64 {
        (self.record.time_s[row + 1] - self.record.time_s[row]) / self.substeps as f64
    }

    /// States at the next row; before a record that begins there those that are declared and their changes.
    pub(crate) fn next(&mut self, row: usize, course: &Course, states: &[f64]) -> Vec<f64> {
        if self.record.begins(row + 1) {
            let mut here = self.declared();
            course.add_jumps(row, &mut here);
            return here;
        }
        self.set_parameters(row, course);
        let (n, h) = (self.sizes.states, self.interval_s(row));
        let mut here = states.to_vec();
        let (mut stage, mut rates) = (vec![0.0; n], vec![0.0; n]);
        for substep in 0..self.substeps {
            let mut sum = vec![0.0; n];
            rates.fill(0.0);
            for (share, weight) in STAGES {
                self.set_inputs(row, (substep as f64 + share) / self.substeps as f64);
                for i in 0..n {
                    stage[i] = here[i] + h * share * rates[i];
                }
                let at = Point {
                    states: &stage,
                    parameters: &self.parameters,
                    inputs: &self.inputs,
                };
                self.functions.rates(at, &mut self.workspace, &mut rates);
                for (sum, rate) in sum.iter_mut().zip(&rates) {
                    *sum += weight * rate;
                }
            }
            for (here, sum) in here.iter_mut().zip(&sum) {
                *here += h * sum;
            }
        }
        course.add_jumps(row, &mut here);
        here
    }

    fn declared(&self) -> Vec<f64> {
        let states = self.plant.description.states.iter();
        states.map(|state| state.initial).collect()
    }

    /// Outputs at a row.
    pub(crate) fn outputs(&mut self, row: usize, course: &Course, states: &[f64]) -> Vec<f64> {
        self.set_parameters(row, course);
        self.set_inputs(row, 0.0);
        let mut outputs = vec![0.0; self.sizes.outputs];
        let at = Point {
            states,
            parameters: &self.parameters,
            inputs: &self.inputs,
        };
        self.functions
            .outputs(at, &mut self.workspace, &mut outputs);
        course.add_to_outputs(row, &mut outputs);
        outputs
    }

    /// States at all rows from those at the first, without noise; NaN from where the job is asked to end.
    pub(crate) fn simulate(&mut self, course: &Course, initial: &[f64]) -> Vec<f64> {
        let mut points = initial.to_vec();
        let mut here = initial.to_vec();
        for row in 0..self.record.len().saturating_sub(1) {
            if stop::check_at(row).is_err() {
                points.resize(self.record.len() * initial.len(), f64::NAN);
                break;
            }
            here = self.next(row, course, &here);
            points.extend_from_slice(&here);
        }
        points
    }

    /// Defects of a trajectory and residuals of its outputs, without derivatives; NaN from where the job is asked to
    /// end.
    pub(crate) fn differences(&mut self, course: &Course, points: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (n, y, rows) = (self.sizes.states, self.sizes.outputs, self.record.len());
        let mut defects = Vec::with_capacity(rows * n);
        let mut residuals = Vec::with_capacity(rows * y);
        for row in 0..rows {
            if stop::check_at(row).is_err() {
                defects.resize(rows.saturating_sub(1) * n, f64::NAN);
                residuals.resize(rows * y, f64::NAN);
                break;
            }
            let here = &points[row * n..(row + 1) * n];
            let outputs = self.outputs(row, course, here);
            let measured = &self.record.outputs[row * y..(row + 1) * y];
            residuals.extend(measured.iter().zip(&outputs).map(|(m, o)| m - o));
            if row + 1 < rows {
                let next = self.next(row, course, here);
                let given = &points[(row + 1) * n..(row + 2) * n];
                defects.extend(given.iter().zip(&next).map(|(given, next)| given - next));
            }
        }
        (defects, residuals)
    }

    /// The model about a trajectory.
    pub(crate) fn linearise(
        &mut self,
        course: &Course,
        points: &[f64],
    ) -> Result<Linearised, PlantError> {
        let Sizes {
            states: n,
            outputs: y,
            noises: w,
            ..
        } = self.sizes;
        let wanted = Arc::clone(&self.wanted);
        let p = wanted.len();
        let rows = self.record.len();
        let mut lin = LinearisedRows::new(Layout {
            states: n,
            outputs: y,
            noises: w,
            parameters: Arc::clone(&wanted),
            of_outputs: p,
        });
        let mut by_noises = Vec::with_capacity(rows * n * w);
        let declared = &self.plant.description;
        let variances = declared.outputs.iter().map(|one| one.sigma.powi(2));
        let variances: Vec<f64> = variances.collect();
        let mut out = OutputsAt::new(self.sizes);
        let mut step = StepMemory::new(self.sizes, p);
        for row in 0..rows {
            stop::check_at(row)?;
            let here = &points[row * n..(row + 1) * n];
            self.set_parameters(row, course);
            self.set_inputs(row, 0.0);
            let at = Point {
                states: here,
                parameters: &self.parameters,
                inputs: &self.inputs,
            };
            self.functions
                .outputs_with(at, &mut self.workspace, &mut out);
            let measured = &self.record.outputs[row * y..(row + 1) * y];
            let mut predicted = out.values.clone();
            course.add_to_outputs(row, &mut predicted);
            lin.residuals
                .extend(measured.iter().zip(&predicted).map(|(m, o)| m - o));
            all_finite(row, &predicted)?;
            lin.variances.extend_from_slice(&variances);
            lin.out_by_states.extend_from_slice(&out.by_states);
            for by in out.by_parameters.chunks_exact(self.sizes.parameters.max(1)) {
                lin.out_by_parameters
                    .extend(wanted.iter().map(|index| by[*index]));
            }
            if row + 1 == rows {
                break;
            }
            self.step_with(row, here, &mut step);
            let mut next = step.states.clone();
            course.add_jumps(row, &mut next);
            let given = &points[(row + 1) * n..(row + 2) * n];
            lin.defects
                .extend(given.iter().zip(&next).map(|(given, next)| given - next));
            all_finite(row, &step.by_all)?;
            let interval_s = self.record.time_s[row + 1] - self.record.time_s[row];
            lin.step_s.push(interval_s);
            let first = by_noises.len();
            for by in step.by_all.chunks_exact(n + p + w) {
                lin.by_states.extend_from_slice(&by[..n]);
                lin.by_parameters.extend_from_slice(&by[n..n + p]);
                let noises = by[n + p..].iter().zip(&declared.noises);
                by_noises.extend(noises.map(|(by, one)| by * one.density / interval_s.sqrt()));
            }
            let own = &by_noises[first..];
            for noise in 0..w {
                for i in 0..n {
                    let by = own[i * w + noise];
                    lin.shares.extend((0..=i).map(|j| by * own[j * w + noise]));
                }
            }
        }
        Ok(Linearised {
            rows: lin,
            by_noises,
        })
    }

    /// A step with its derivatives: the variational equation by the same stages.
    fn step_with(&mut self, row: usize, states: &[f64], step: &mut StepMemory) {
        let n = self.sizes.states;
        let columns = n + self.wanted.len() + self.sizes.noises;
        let h = self.interval_s(row);
        step.by_all.fill(0.0);
        if self.record.begins(row + 1) {
            step.states = self.declared();
            return;
        }
        step.states.copy_from_slice(states);
        for i in 0..n {
            step.by_all[i * columns + i] = 1.0;
        }
        for substep in 0..self.substeps {
            step.sum.fill(0.0);
            step.slope.fill(0.0);
            step.rates.values.fill(0.0);
            let mut sum = vec![0.0; n];
            for (share, weight) in STAGES {
                self.set_inputs(row, (substep as f64 + share) / self.substeps as f64);
                for i in 0..n {
                    step.stage[i] = step.states[i] + h * share * step.rates.values[i];
                }
                for (target, (by, slope)) in step
                    .moved
                    .iter_mut()
                    .zip(step.by_all.iter().zip(&step.slope))
                {
                    *target = by + h * share * slope;
                }
                let at = Point {
                    states: &step.stage,
                    parameters: &self.parameters,
                    inputs: &self.inputs,
                };
                self.functions
                    .rates_with(at, &mut self.workspace, &mut step.rates);
                for late in &self.late {
                    step.rates.set_by_time(late, self.sizes.parameters);
                }
                step.set_slope(self.sizes, &self.wanted);
                for (sum, rate) in sum.iter_mut().zip(&step.rates.values) {
                    *sum += weight * rate;
                }
                for (sum, slope) in step.sum.iter_mut().zip(&step.slope) {
                    *sum += weight * slope;
                }
            }
            for (state, sum) in step.states.iter_mut().zip(&sum) {
                *state += h * sum;
            }
            for (by, sum) in step.by_all.iter_mut().zip(&step.sum) {
                *by += h * sum;
            }
        }
    }
}

fn all_finite(row: usize, values: &[f64]) -> Result<(), PlantError> {
    let all = values.iter().all(|value| value.is_finite());
    all.then_some(()).ok_or(PlantError::NotFinite { row })
}
