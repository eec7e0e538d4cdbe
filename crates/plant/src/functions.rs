//! The functions of a plant, with sizes that are known at run time.

use std::sync::Arc;

/// Sizes of a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// States.
    pub states: usize,
    /// Constant parameters: nominal ones, then sizes of effects.
    pub parameters: usize,
    /// Inputs.
    pub inputs: usize,
    /// Outputs.
    pub outputs: usize,
    /// White noises of the rates.
    pub noises: usize,
}

/// Where functions are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// States.
    pub states: &'a [f64],
    /// Parameters.
    pub parameters: &'a [f64],
    /// Inputs.
    pub inputs: &'a [f64],
}

/// Rates of the states with their derivatives, matrices by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct RatesAt {
    /// The rates.
    pub values: Vec<f64>,
    /// By the states.
    pub by_states: Vec<f64>,
    /// By the parameters.
    pub by_parameters: Vec<f64>,
    /// By the noises.
    pub by_noises: Vec<f64>,
}

impl RatesAt {
    /// Zeros.
    #[must_use]
    pub fn new(sizes: Sizes) -> Self {
        let n = sizes.states;
        Self {
            values: vec![0.0; n],
            by_states: vec![0.0; n * n],
            by_parameters: vec![0.0; n * sizes.parameters],
            by_noises: vec![0.0; n * sizes.noises],
        }
    }
}

/// Outputs with their derivatives, matrices by rows.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputsAt {
    /// The outputs.
    pub values: Vec<f64>,
    /// By the states.
    pub by_states: Vec<f64>,
    /// By the parameters.
    pub by_parameters: Vec<f64>,
}

impl OutputsAt {
    /// Zeros.
    #[must_use]
    pub fn new(sizes: Sizes) -> Self {
        let y = sizes.outputs;
        Self {
            values: vec![0.0; y],
            by_states: vec![0.0; y * sizes.states],
            by_parameters: vec![0.0; y * sizes.parameters],
        }
    }
}

/// Memory of an evaluation, kept from one to the next.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    pub(crate) tapes: [Vec<f64>; 4],
}

/// Rates and outputs of a plant and their exact derivatives. Structural zeros of a derivative are left as
/// they are: what is passed in has zeros there.
pub trait Functions: Send + Sync {
    /// Sizes.
    fn sizes(&self) -> Sizes;

    /// The same functions for a model in which some parameters are zero and derivatives by some are wanted,
    /// by the index of a parameter; others may be left as they are. `None` if that saves nothing.
    fn narrowed(&self, is_zero: &[bool], wanted: &[bool]) -> Option<Arc<dyn Functions>> {
        let _ = (is_zero, wanted);
        None
    }

    /// A workspace for evaluations.
    fn workspace(&self) -> Workspace;

    /// Rates of the states.
    fn rates(&self, at: Point<'_>, workspace: &mut Workspace, rates: &mut [f64]);

    /// Rates and their derivatives.
    fn rates_with(&self, at: Point<'_>, workspace: &mut Workspace, rates: &mut RatesAt);

    /// Outputs.
    fn outputs(&self, at: Point<'_>, workspace: &mut Workspace, outputs: &mut [f64]);

    /// Outputs and their derivatives.
    fn outputs_with(&self, at: Point<'_>, workspace: &mut Workspace, outputs: &mut OutputsAt);
}
