//! A record linearised about a trajectory: the interface between models and what is inferred from them.

use std::sync::Arc;

use gyrocal_estimation::EstimationError;

use crate::error::PassError;

/// Numbers of states, outputs and noises of a linearised record, and its parameters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Number of moving states.
    pub states: usize,
    /// Number of outputs.
    pub outputs: usize,
    /// Number of noises that drive states.
    pub noises: usize,
    /// Parameters that there are derivatives by, in rising order.
    pub parameters: Arc<[usize]>,
    /// How many of them, from the first, outputs may depend on directly.
    pub of_outputs: usize,
}

impl Layout {
    /// Place of the derivatives by a parameter.
    #[must_use]
    pub fn place(&self, parameter: usize) -> Option<usize> {
        self.parameters.binary_search(&parameter).ok()
    }

    /// Elements of the lower triangle of a covariance of the states.
    #[must_use]
    pub fn triangle(&self) -> usize {
        self.states * (self.states + 1) / 2
    }
}

/// What is known of the first point before the record.
#[derive(Clone, Debug, PartialEq)]
pub struct Start {
    /// Mean of its correction: the prior's less the trajectory's.
    pub deviation: Vec<f64>,
    /// Covariance of its correction, by rows.
    pub covariance: Vec<f64>,
    /// Its squared distance from the mean over that covariance.
    pub cost: f64,
    /// States whose first values have variances of their own that go with a noise: state, noise, variance at the
    /// declared size of the noise.
    pub noises: Vec<(usize, usize, f64)>,
}

impl Start {
    /// A first point that is known, or whose states are columns.
    #[must_use]
    pub fn known(states: usize) -> Self {
        Self {
            deviation: vec![0.0; states],
            covariance: vec![0.0; states * states],
            cost: 0.0,
            noises: Vec::new(),
        }
    }
}

/// Consecutive rows of a linearised record with the steps after them. All matrices are by rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearisedRows {
    /// Sizes.
    pub layout: Layout,
    /// Number of the first row.
    pub first: usize,
    /// For each step its length, s.
    pub step_s: Vec<f64>,
    /// Derivative of the next states by the states.
    pub by_states: Vec<f64>,
    /// By the parameters.
    pub by_parameters: Vec<f64>,
    /// Lower triangles of the covariances of the next states that each noise adds at its declared size.
    pub shares: Vec<f64>,
    /// Next states of the trajectory less those of the model.
    pub defects: Vec<f64>,
    /// For each row outputs less those of the model; NaN where one is missing.
    pub residuals: Vec<f64>,
    /// Declared variances of their noise.
    pub variances: Vec<f64>,
    /// Derivative of the outputs by the states.
    pub out_by_states: Vec<f64>,
    /// By the first [`Layout::of_outputs`] parameters.
    pub out_by_parameters: Vec<f64>,
}

/// One step of a linearised record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepOf<'a> {
    pub(crate) step_s: f64,
    pub(crate) by_states: &'a [f64],
    pub(crate) by_parameters: &'a [f64],
    pub(crate) shares: &'a [f64],
    pub(crate) defects: &'a [f64],
}

/// One output of one row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutputOf<'a> {
    pub(crate) residual: f64,
    pub(crate) variance: f64,
    pub(crate) by_states: &'a [f64],
    pub(crate) by_parameters: &'a [f64],
}

/// Element `index` of a list of slices of one length.
fn slice(all: &[f64], index: usize, length: usize) -> &[f64] {
    &all[index * length..(index + 1) * length]
}

impl LinearisedRows {
    /// No rows yet.
    #[must_use]
    pub fn new(layout: Layout) -> Self {
        Self {
            layout,
            ..Self::default()
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.residuals.len() / self.layout.outputs.max(1)
    }

    /// Forgets the rows; `first` will be the next.
    pub(crate) fn clear(&mut self, first: usize) {
        self.first = first;
        for all in [
            &mut self.step_s,
            &mut self.by_states,
            &mut self.by_parameters,
            &mut self.shares,
            &mut self.defects,
            &mut self.residuals,
            &mut self.variances,
            &mut self.out_by_states,
            &mut self.out_by_parameters,
        ] {
            all.clear();
        }
    }

    /// The step after a row, counted from the first of these.
    pub(crate) fn step(&self, index: usize) -> StepOf<'_> {
        let Layout { states, noises, .. } = self.layout;
        let p = self.layout.parameters.len();
        StepOf {
            step_s: self.step_s[index],
            by_states: slice(&self.by_states, index, states * states),
            by_parameters: slice(&self.by_parameters, index, states * p),
            shares: slice(&self.shares, index, noises * self.layout.triangle()),
            defects: slice(&self.defects, index, states),
        }
    }

    /// An output of a row, counted from the first of these.
    pub(crate) fn output(&self, index: usize, output: usize) -> OutputOf<'_> {
        let place = index * self.layout.outputs + output;
        OutputOf {
            residual: self.residuals[place],
            variance: self.variances[place],
            by_states: slice(&self.out_by_states, place, self.layout.states),
            by_parameters: slice(&self.out_by_parameters, place, self.layout.of_outputs),
        }
    }
}

/// A record linearised about a trajectory.
pub trait LinearisedRecord {
    /// Its sizes.
    fn layout(&self) -> Layout;

    /// Number of rows.
    fn rows(&self) -> usize;

    /// What is known of the first point.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if it is not a positive definite prior.
    fn start(&self) -> Result<Start, EstimationError>;

    /// Hands over the first `rows` rows and the steps between them in rising order, some at a time; there may
    /// be more of both.
    ///
    /// # Errors
    /// Those of the model, those of `take`, and [`PassError::Stopped`].
    fn visit(
        &self,
        rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), PassError>,
    ) -> Result<(), PassError>;
}

/// A whole record whose first point is known or has its states as columns.
impl LinearisedRecord for LinearisedRows {
    fn layout(&self) -> Layout {
        self.layout.clone()
    }

    fn rows(&self) -> usize {
        self.rows()
    }

    fn start(&self) -> Result<Start, EstimationError> {
        Ok(Start::known(self.layout.states))
    }

    fn visit(
        &self,
        _rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), PassError>,
    ) -> Result<(), PassError> {
        take(self)
    }
}

/// A linearised record in memory, for further passes about the same trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptRecord {
    layout: Layout,
    start: Start,
    rows: usize,
    blocks: Vec<LinearisedRows>,
}

impl KeptRecord {
    /// Linearises a record once.
    ///
    /// # Errors
    /// As [`LinearisedRecord::visit`].
    pub fn new(record: &dyn LinearisedRecord) -> Result<Self, PassError> {
        let mut blocks = Vec::new();
        record.visit(record.rows(), &mut |rows| {
            blocks.push(rows.clone());
            Ok(())
        })?;
        Ok(Self {
            layout: record.layout(),
            start: record.start()?,
            rows: record.rows(),
            blocks,
        })
    }
}

impl LinearisedRecord for KeptRecord {
    fn layout(&self) -> Layout {
        self.layout.clone()
    }

    fn rows(&self) -> usize {
        self.rows
    }

    fn start(&self) -> Result<Start, EstimationError> {
        Ok(self.start.clone())
    }

    fn visit(
        &self,
        rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), PassError>,
    ) -> Result<(), PassError> {
        let mut blocks = self.blocks.iter();
        blocks
            .by_ref()
            .take_while(|block| block.first < rows)
            .try_for_each(take)
    }
}
