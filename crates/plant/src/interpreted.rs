//! The functions of a plant, interpreted from its program.

use std::sync::Arc;

use gyrocal_codegen::Program;
use gyrocal_codegen::program::{Model, ModelFunction};

use crate::error::PlantError;
use crate::functions::{Functions, OutputsAt, Point, RatesAt, Sizes, Workspace};
use crate::tape::Tape;

/// Part of a point that an input of a function is.
#[derive(Clone, Copy, Debug)]
enum Part {
    States,
    Parameters,
    /// Inputs from this place on.
    Inputs(usize),
}

/// A derivative: output of the function, and the place of each nonzero in the matrix by rows.
type Derivative = Option<(usize, Vec<usize>)>;

/// A compiled function with what its inputs and outputs are.
#[derive(Clone, Debug)]
struct Compiled {
    tape: Tape,
    parts: Vec<Part>,
    /// Row of each nonzero of the first output.
    rows: Vec<usize>,
    by_states: Derivative,
    by_parameters: Derivative,
    by_noises: Derivative,
}

/// A plant whose functions are lists of operations.
#[derive(Clone, Debug)]
pub struct Interpreted {
    sizes: Sizes,
    /// Rates, rates with derivatives, outputs, outputs with derivatives.
    functions: [Compiled; 4],
}

impl Interpreted {
    /// Compiles the model of a program.
    ///
    /// # Errors
    /// [`PlantError::NoPlant`] if the program has no model or calls functions of other Rust.
    pub fn new(program: &Program) -> Result<Self, PlantError> {
        let refuse = |problem: &str| PlantError::NoPlant {
            origin: program.origin.clone(),
            problem: problem.to_owned(),
        };
        let model = program
            .model
            .as_ref()
            .ok_or_else(|| refuse("the program has no model"))?;
        let length = |group: usize| program.groups[group].elements.len();
        let noises = model.noise.as_ref().map_or(0, |name| {
            let found = program.groups.iter().find(|group| group.name == *name);
            found.map_or(0, |group| group.elements.len())
        });
        let sizes = Sizes {
            states: length(model.moving),
            parameters: model.parameters.map_or(0, length),
            inputs: model.inputs.iter().map(|group| length(*group)).sum(),
            outputs: program.functions[model.output.value].outputs[0].rows,
            noises,
        };
        let compile = |index: usize| {
            compile(program, model, index)
                .ok_or_else(|| refuse("the program calls functions of other Rust"))
        };
        let both = |pair: &ModelFunction| -> Result<[Compiled; 2], PlantError> {
            Ok([compile(pair.value)?, compile(pair.jacobian)?])
        };
        let ([rates, rates_with], [outputs, outputs_with]) =
            (both(&model.rates)?, both(&model.output)?);
        Ok(Self {
            sizes,
            functions: [rates, rates_with, outputs, outputs_with],
        })
    }

    fn run(&self, index: usize, at: Point<'_>, workspace: &mut Workspace) {
        let compiled = &self.functions[index];
        let array = &mut workspace.tapes[index];
        compiled
            .tape
            .evaluate(array, |group, element| match compiled.parts[group] {
                Part::States => at.states[element],
                Part::Parameters => at.parameters[element],
                Part::Inputs(first) => at.inputs[first + element],
            });
    }

    fn values(&self, index: usize, workspace: &Workspace, values: &mut [f64]) {
        let compiled = &self.functions[index];
        let array = &workspace.tapes[index];
        for (place, row) in compiled.tape.output(0).iter().zip(&compiled.rows) {
            values[*row] = array[*place];
        }
    }

    /// The functions with parameters that are zero folded away, and the derivatives by those that are wanted.
    fn of_parameters(&self, is_zero: &[bool], wanted: &[bool]) -> Self {
        let functions = self.functions.each_ref();
        Self {
            sizes: self.sizes,
            functions: functions.map(|own| own.of_parameters(is_zero, wanted)),
        }
    }

    fn derivative(&self, index: usize, of: &Derivative, workspace: &Workspace, to: &mut [f64]) {
        let Some((output, places)) = of else { return };
        let array = &workspace.tapes[index];
        let tape = &self.functions[index].tape;
        for (from, place) in tape.output(*output).iter().zip(places) {
            to[*place] = array[*from];
        }
    }
}

impl Compiled {
    fn of_parameters(&self, is_zero: &[bool], wanted: &[bool]) -> Self {
        let columns = wanted.len();
        let read = [&self.by_states, &self.by_noises];
        let read: Vec<usize> = read.into_iter().flatten().map(|own| own.0).collect();
        let is_wanted = |place: &usize| wanted[place % columns];
        let tape = self.tape.narrowed(
            |group, element| matches!(self.parts[group], Part::Parameters) && is_zero[element],
            |output, index| match &self.by_parameters {
                Some((own, places)) if *own == output => is_wanted(&places[index]),
                _ => output == 0 || read.contains(&output),
            },
        );
        let by_parameters = self.by_parameters.as_ref().map(|(output, places)| {
            let places = places.iter().copied().filter(is_wanted);
            (*output, places.collect())
        });
        Self {
            tape,
            by_parameters,
            ..self.clone()
        }
    }
}

fn compile(program: &Program, model: &Model, index: usize) -> Option<Compiled> {
    let function = &program.functions[index];
    let parts = function.inputs.iter().map(|group| {
        if *group == model.moving {
            return Part::States;
        }
        if Some(*group) == model.parameters {
            return Part::Parameters;
        }
        let before = model.inputs.iter().take_while(|other| *other != group);
        Part::Inputs(before.map(|one| program.groups[*one].elements.len()).sum())
    });
    let value = &function.outputs[0];
    let derivative = |group: Option<&str>| -> Derivative {
        let name = format!("{}_d_{}", value.name, group?);
        let found = function
            .outputs
            .iter()
            .position(|output| output.name == name)?;
        let output = &function.outputs[found];
        let places = output.nonzeros.iter();
        Some((
            found,
            places
                .map(|(row, column)| row * output.columns + column)
                .collect(),
        ))
    };
    let name = |group: usize| program.groups[group].name.as_str();
    Some(Compiled {
        tape: Tape::new(function)?,
        parts: parts.collect(),
        rows: value.nonzeros.iter().map(|(row, _)| *row).collect(),
        by_states: derivative(Some(name(model.moving))),
        by_parameters: derivative(model.parameters.map(name)),
        by_noises: derivative(model.noise.as_deref()),
    })
}

impl Functions for Interpreted {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn narrowed(&self, is_zero: &[bool], wanted: &[bool]) -> Option<Arc<dyn Functions>> {
        Some(Arc::new(self.of_parameters(is_zero, wanted)))
    }

    fn workspace(&self) -> Workspace {
        Workspace {
            tapes: [0, 1, 2, 3].map(|index: usize| self.functions[index].tape.array()),
        }
    }

    fn rates(&self, at: Point<'_>, workspace: &mut Workspace, rates: &mut [f64]) {
        self.run(0, at, workspace);
        self.values(0, workspace, rates);
    }

    fn rates_with(&self, at: Point<'_>, workspace: &mut Workspace, rates: &mut RatesAt) {
        self.run(1, at, workspace);
        self.values(1, workspace, &mut rates.values);
        let own = &self.functions[1];
        self.derivative(1, &own.by_states, workspace, &mut rates.by_states);
        self.derivative(1, &own.by_parameters, workspace, &mut rates.by_parameters);
        self.derivative(1, &own.by_noises, workspace, &mut rates.by_noises);
    }

    fn outputs(&self, at: Point<'_>, workspace: &mut Workspace, outputs: &mut [f64]) {
        self.run(2, at, workspace);
        self.values(2, workspace, outputs);
    }

    fn outputs_with(&self, at: Point<'_>, workspace: &mut Workspace, outputs: &mut OutputsAt) {
        self.run(3, at, workspace);
        self.values(3, workspace, &mut outputs.values);
        let own = &self.functions[3];
        self.derivative(3, &own.by_states, workspace, &mut outputs.by_states);
        self.derivative(3, &own.by_parameters, workspace, &mut outputs.by_parameters);
    }
}
