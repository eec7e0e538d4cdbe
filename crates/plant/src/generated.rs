//! The functions of a plant by generated Rust.

use gyrocal_scalar::{Model, NamedInputs, RatesJacobian};

use crate::functions::{Functions, OutputsAt, Point, RatesAt, Sizes, Workspace};

/// The group of a program that holds the inputs of a plant.
const INPUTS: &str = "inputs";

/// A generated model with `M` states and `Y` outputs as the functions of a plant.
#[derive(Clone, Copy, Debug)]
pub struct Generated<D, const M: usize, const Y: usize> {
    model: D,
    inputs: usize,
    noises: usize,
}

impl<D, const M: usize, const Y: usize> Generated<D, M, Y>
where
    D: Model<f64, M, Y>,
    D::Inputs: NamedInputs<f64>,
{
    /// A model with so many white noises of its rates.
    #[must_use]
    pub fn new(model: D, noises: usize) -> Self {
        let mut inputs = D::Inputs::filled(0.0);
        Self {
            model,
            inputs: inputs.group_mut(INPUTS).map_or(0, |group| group.len()),
            noises,
        }
    }

    fn inputs(at: Point<'_>) -> D::Inputs {
        let mut inputs = D::Inputs::filled(0.0);
        if let Some(group) = inputs.group_mut(INPUTS) {
            group.copy_from_slice(at.inputs);
        }
        inputs
    }

    fn states(at: Point<'_>) -> [f64; M] {
        core::array::from_fn(|index| at.states[index])
    }
}

impl<D, const M: usize, const Y: usize> Functions for Generated<D, M, Y>
where
    D: Model<f64, M, Y> + Send + Sync,
    D::Inputs: NamedInputs<f64>,
{
    fn sizes(&self) -> Sizes {
        Sizes {
            states: M,
            parameters: self.model.parameters(),
            inputs: self.inputs,
            outputs: Y,
            noises: self.noises,
        }
    }

    fn workspace(&self) -> Workspace {
        Workspace::default()
    }

    fn rates(&self, at: Point<'_>, _: &mut Workspace, rates: &mut [f64]) {
        let (states, inputs) = (Self::states(at), Self::inputs(at));
        rates.copy_from_slice(&self.model.rates(&states, at.parameters, &inputs));
    }

    fn rates_with(&self, at: Point<'_>, _: &mut Workspace, rates: &mut RatesAt) {
        let (states, inputs) = (Self::states(at), Self::inputs(at));
        let mut jacobian = RatesJacobian {
            moving: [[0.0; M]; M],
            noise: [[0.0; M]; M],
            parameters: &mut rates.by_parameters,
        };
        let values = self
            .model
            .rates_jacobian(&states, at.parameters, &inputs, &mut jacobian);
        rates.values.copy_from_slice(&values);
        rates
            .by_states
            .copy_from_slice(jacobian.moving.as_flattened());
        for (i, row) in jacobian.noise.iter().enumerate() {
            rates.by_noises[i * self.noises..(i + 1) * self.noises]
                .copy_from_slice(&row[..self.noises]);
        }
    }

    fn outputs(&self, at: Point<'_>, _: &mut Workspace, outputs: &mut [f64]) {
        let (states, inputs) = (Self::states(at), Self::inputs(at));
        outputs.copy_from_slice(&self.model.output(&states, at.parameters, &inputs));
    }

    fn outputs_with(&self, at: Point<'_>, _: &mut Workspace, outputs: &mut OutputsAt) {
        let (states, inputs) = (Self::states(at), Self::inputs(at));
        let leading = self.model.output_parameters();
        let mut d_moving = [[0.0; M]; Y];
        let mut d_parameters = vec![0.0; Y * leading];
        let values = self.model.output_jacobian(
            &states,
            at.parameters,
            &inputs,
            &mut d_moving,
            &mut d_parameters,
        );
        outputs.values.copy_from_slice(&values);
        outputs.by_states.copy_from_slice(d_moving.as_flattened());
        let all = self.model.parameters();
        for k in 0..Y {
            outputs.by_parameters[k * all..k * all + leading]
                .copy_from_slice(&d_parameters[k * leading..(k + 1) * leading]);
        }
    }
}
