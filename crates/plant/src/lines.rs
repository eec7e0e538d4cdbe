//! Columns of a linearised model, and what their amplitudes do to its parameters.

use std::sync::Arc;

use gyrocal_hypothesis::{Column, ModelExtension, Rows};

use crate::catalogue::Modulation;
use crate::loaded::LoadedPlant;
use crate::record::PlantRecord;

/// One column.
#[derive(Clone, Debug)]
pub(crate) enum Line {
    /// The initial value of a state.
    Start(usize),
    /// A parameter of the model.
    Parameter(usize),
    /// A parameter times a number for each step.
    Profile(usize, Arc<[f64]>),
    /// A sudden change of a state in the step after a row.
    Jump(usize, usize),
    /// A change of an output at each row.
    Output(usize, Arc<[f64]>),
}

impl Line {
    /// The parameter that it changes.
    pub(crate) fn parameter(&self) -> Option<usize> {
        match self {
            Self::Parameter(index) | Self::Profile(index, _) => Some(*index),
            Self::Start(_) | Self::Jump(..) | Self::Output(..) => None,
        }
    }

    /// The parameters that some lines change.
    pub(crate) fn parameters(lines: &[Self]) -> Vec<usize> {
        let mut all: Vec<usize> = lines.iter().filter_map(Self::parameter).collect();
        all.sort_unstable();
        all.dedup();
        all
    }

    /// A column of the search.
    pub(crate) fn of(column: &Column, states: usize, steps: usize, starts: &[usize]) -> Self {
        match column {
            Column::InitialState { state, .. } => Self::Start(*state),
            Column::StateJump { row, state } => Self::Jump(*row, *state),
            Column::Step { parameter, row } => {
                // A change belongs to the record that it happens in.
                let end = starts.iter().find(|start| *start > row).copied();
                let end = end.unwrap_or(steps);
                let profile =
                    (0..steps).map(|step| f64::from(u8::from((*row..end).contains(&step))));
                Self::Profile(parameter - states, profile.collect())
            }
            Column::TimeProfile { parameter, steps } => {
                Self::Profile(parameter - states, Arc::clone(steps))
            }
            Column::Output { output, change } => Self::Output(*output, Arc::clone(change)),
        }
    }
}

/// The lines of all parameters of the tables of a plant, at the shapes of an extension.
pub(crate) fn of_parameters(
    plant: &LoadedPlant,
    (record, rows): (&PlantRecord, &Rows),
    extension: &ModelExtension,
    wanted: &[usize],
) -> Vec<Line> {
    let tables = plant.tables();
    let states = plant.description.states.len();
    let sizes = plant.functions.sizes().parameters;
    let shapes = extension.all_shapes(tables);
    let line = |index: &usize| {
        let Some(parameter) = index.checked_sub(states) else {
            return Line::Start(*index);
        };
        let Some(own) = parameter.checked_sub(sizes) else {
            return Line::Parameter(parameter);
        };
        let modulated = plant.catalogue.modulated[own];
        match (modulated.course, modulated.output) {
            (Modulation::Weight(weight), Some(output)) => {
                Line::Output(output, rows.row_weights(tables, weight, &shapes))
            }
            (Modulation::Weight(weight), None) => {
                Line::Profile(modulated.of, rows.step_weights(tables, weight, &shapes))
            }
            (Modulation::Error(error, input), _) => {
                let inputs = &plant.description.inputs;
                let interpolate = inputs[input].interpolate;
                let steps = in_each(record, |part| {
                    error.steps(part, inputs.len(), input, interpolate)
                });
                Line::Profile(modulated.of, steps)
            }
        }
    };
    wanted.iter().map(line).collect()
}

/// Numbers for the steps of each record, and zero between two of them.
fn in_each(record: &PlantRecord, steps: impl Fn(&PlantRecord) -> Arc<[f64]>) -> Arc<[f64]> {
    if record.starts.is_empty() {
        return steps(record);
    }
    let mut all: Vec<f64> = Vec::with_capacity(record.len());
    for rows in record.records() {
        all.resize(rows.start, 0.0);
        all.extend_from_slice(&steps(&record.part(rows)));
    }
    all.into()
}

/// Parameters along a record: constant ones, and what changes them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    pub(crate) constant: Vec<f64>,
    /// Parameter, amplitude, number for each step.
    profiles: Vec<(usize, f64, Arc<[f64]>)>,
    /// Output, amplitude, number for each row.
    outputs: Vec<(usize, f64, Arc<[f64]>)>,
    /// Step, state, amplitude.
    jumps: Vec<(usize, usize, f64)>,
}

impl Course {
    /// The declared values of all parameters of a model.
    pub(crate) fn declared(plant: &LoadedPlant) -> Self {
        let declared = plant.description.parameters.iter().map(|one| one.value);
        let mut constant: Vec<f64> = declared.collect();
        constant.resize(plant.functions.sizes().parameters, 0.0);
        Self {
            constant,
            ..Self::default()
        }
    }

    /// Adds a line with its amplitude.
    pub(crate) fn add(&mut self, line: &Line, amplitude: f64) {
        match line {
            Line::Start(_) => {}
            Line::Parameter(index) => self.constant[*index] += amplitude,
            Line::Profile(index, steps) => {
                self.profiles.push((*index, amplitude, Arc::clone(steps)));
            }
            Line::Jump(step, state) => self.jumps.push((*step, *state, amplitude)),
            Line::Output(output, change) => {
                self.outputs.push((*output, amplitude, Arc::clone(change)));
            }
        }
    }

    /// Whether a parameter is zero in every row.
    pub(crate) fn is_zero(&self, parameter: usize) -> bool {
        let changes = self.profiles.iter().any(|(own, ..)| *own == parameter);
        self.constant[parameter] == 0.0 && !changes
    }

    /// Parameters in the step after a row; of the last row those of the step before it.
    pub(crate) fn at(&self, row: usize, parameters: &mut [f64]) {
        parameters.copy_from_slice(&self.constant);
        for (index, amplitude, steps) in &self.profiles {
            let value = steps.get(row).or(steps.last()).copied().unwrap_or(0.0);
            parameters[*index] += amplitude * value;
        }
    }

    /// Adds what changes outputs at a row.
    pub(crate) fn add_to_outputs(&self, row: usize, outputs: &mut [f64]) {
        for (output, amplitude, change) in &self.outputs {
            outputs[*output] += amplitude * change.get(row).copied().unwrap_or(0.0);
        }
    }

    /// Adds the jumps in the step after a row.
    pub(crate) fn add_jumps(&self, row: usize, states: &mut [f64]) {
        for (step, state, amplitude) in &self.jumps {
            if *step == row {
                states[*state] += amplitude;
            }
        }
    }
}
