//! Columns of a linearised plant, and what their amplitudes do to its parameters.

use std::sync::Arc;

use gyrocal_hypothesis::{Column, ModelExtension, Rows};

use crate::catalogue::Modulation;
use crate::loaded::LoadedPlant;
use crate::play;
use crate::record::PlantRecord;

/// The parameters that some columns change, in rising order.
pub(crate) fn parameters_of(lines: &[Column]) -> Vec<usize> {
    let mut all: Vec<usize> = lines.iter().filter_map(Column::parameter).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// The initial value of a state.
pub(crate) fn initial(state: usize) -> Column {
    Column::InitialState { row: 0, state }
}

/// A column of the search, whose parameters begin with the initial states, as one of the model.
pub(crate) fn of_search(column: &Column, states: usize, steps: usize, starts: &[usize]) -> Column {
    match column {
        Column::InitialState { state, .. } => initial(*state),
        Column::StateJump { .. } | Column::Output { .. } => column.clone(),
        Column::Parameter { parameter } => Column::Parameter {
            parameter: parameter - states,
        },
        Column::Step { parameter, row } => {
            // A change belongs to the record that it happens in.
            let end = starts.iter().find(|start| *start > row).copied();
            let end = end.unwrap_or(steps);
            let profile = (0..steps).map(|step| f64::from(u8::from((*row..end).contains(&step))));
            Column::TimeProfile {
                parameter: parameter - states,
                steps: profile.collect(),
            }
        }
        Column::TimeProfile { parameter, steps } => Column::TimeProfile {
            parameter: parameter - states,
            steps: Arc::clone(steps),
        },
    }
}

/// The lines of all parameters of the tables of a plant, at the shapes of an extension.
pub(crate) fn of_parameters(
    plant: &LoadedPlant,
    (record, rows): (&PlantRecord, &Rows),
    extension: &ModelExtension,
    wanted: &[usize],
) -> Vec<Column> {
    let tables = plant.tables();
    let states = plant.description.states.len();
    let sizes = plant.functions.sizes().parameters;
    let shapes = extension.all_shapes(tables);
    let line = |index: &usize| {
        let Some(parameter) = index.checked_sub(states) else {
            return initial(*index);
        };
        let Some(own) = parameter.checked_sub(sizes) else {
            return Column::Parameter { parameter };
        };
        let modulated = plant.catalogue.modulated[own];
        match (modulated.course, modulated.output) {
            (Modulation::Weight(weight), Some(output)) => {
                let change = rows.row_weights(tables, weight, &shapes);
                Column::Output { output, change }
            }
            (Modulation::Weight(weight), None) => {
                let steps = rows.step_weights(tables, weight, &shapes);
                profile(modulated.of, steps)
            }
            (Modulation::Play(input), _) => {
                let inputs = &plant.description.inputs;
                let interpolate = inputs[input].interpolate;
                let steps = in_each(record, |part| {
                    play::steps(part, (inputs.len(), input), interpolate)
                });
                profile(modulated.of, steps)
            }
        }
    };
    wanted.iter().map(line).collect()
}

/// A parameter times a number for each step.
pub(crate) fn profile(parameter: usize, steps: Arc<[f64]>) -> Column {
    Column::TimeProfile { parameter, steps }
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
    /// Parameter, amplitude, the column that has its number for each step.
    profiles: Vec<(usize, f64, Column)>,
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
        for knee in &plant.description.knees {
            constant[knee.constant] = knee.value;
        }
        Self {
            constant,
            ..Self::default()
        }
    }

    /// Adds a column with its amplitude.
    pub(crate) fn add(&mut self, line: &Column, amplitude: f64) {
        match line {
            Column::InitialState { .. } => {}
            Column::Parameter { parameter } => self.constant[*parameter] += amplitude,
            Column::TimeProfile { parameter, .. } | Column::Step { parameter, .. } => {
                self.profiles.push((*parameter, amplitude, line.clone()));
            }
            Column::StateJump { row, state } => self.jumps.push((*row, *state, amplitude)),
            Column::Output { output, change } => {
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
        for (index, amplitude, column) in &self.profiles {
            parameters[*index] += amplitude * column.weight(row);
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
