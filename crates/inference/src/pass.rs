//! A pass over a linearised record: one row after the other, with the columns carried along.

use core::ops::Range;

use gyrocal_estimation::EstimationError;
use gyrocal_scalar::Scalar;
use nalgebra::DMatrix;

use crate::column::Column;
use crate::filter::Filter;
use crate::gram::Gram;
use crate::record::{KeptRecord, Layout, LinearisedRecord, LinearisedRows, OutputOf, StepOf};
use crate::small::{add_triangle, dot, squared};
use crate::walks::{Walks, WithWalks};

const NOT_DRIVEN: EstimationError = EstimationError::InvalidArgument {
    expected: "noise that drives every moving state, and a positive definite prior",
};

/// What a pass goes over, and with which columns and noise.
#[derive(Clone, Copy)]
pub struct Pass<'a> {
    /// The record.
    pub record: &'a dyn LinearisedRecord,
    /// The columns.
    pub columns: &'a [Column],
    /// Parameters that walk at random about their values.
    pub walks: Walks<'a>,
    /// Factors of the declared variances: of the outputs, of the noises, of the walks. All are one if there
    /// are none.
    pub factors: &'a [f64],
    /// Further variance of each state in each step, while a fit is on its way; none if there are none.
    pub loose: &'a [f64],
    /// Rows whose outputs are left out.
    pub left_out: &'a Range<usize>,
    /// Number of rows, from the first; those that the record has if there are more.
    pub rows: usize,
}

impl core::fmt::Debug for Pass<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Pass")
            .field("rows", &self.record.rows())
            .field("columns", &self.columns.len())
            .field("walks", &self.walks.walks.len())
            .finish_non_exhaustive()
    }
}

/// Result of the first pass over a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// [`Gram`] matrix of residual and columns. The columns are derivatives of the innovations:
    /// minus those of the predictions.
    pub gram: DMatrix<f64>,
    /// Number of output values used.
    pub values: usize,
    /// Number of rows with at least one of them.
    pub rows: usize,
    /// Sum of the natural logarithms of the innovations' variances.
    pub log_variance: f64,
    /// Twice the cost of the trajectory itself: squares of output residuals, of the noise between
    /// points, and of the first point's distance from its prior, each over its covariance. NaN where it was
    /// not asked for.
    pub trajectory_cost: f64,
    /// Deviation of the last point and then of the walks there, each with its derivatives by columns:
    /// rows of 1 + columns.
    pub last: Vec<f64>,
    /// Covariance of the last point and of the walks there given the parameters, by rows.
    pub last_covariance: Vec<f64>,
}

/// One output of one row, whitened.
#[derive(Clone, Copy, Debug)]
pub struct Whitened<'a> {
    /// The row.
    pub row: usize,
    /// Index of the output.
    pub output: usize,
    /// Standard deviation of the innovation given the outputs before it.
    pub deviation: f64,
    /// Innovation and columns over [`Self::deviation`].
    pub columns: &'a [f64],
}

/// An output that the filter has taken.
pub(crate) struct Taken<'a> {
    pub(crate) whitened: Whitened<'a>,
    pub(crate) jacobian: &'a [f64],
    /// Variance of the output's noise.
    pub(crate) variance: f64,
    /// Square of the residual of the trajectory over it.
    pub(crate) cost: f64,
    /// Covariance of the states with the output before the update.
    pub(crate) cross: &'a [f64],
}

/// A step that the filter has made.
pub(crate) struct Made<'a> {
    pub(crate) by_states: &'a [f64],
    pub(crate) shares: &'a [f64],
    /// What the trajectory differs from the model by.
    pub(crate) defects: &'a [f64],
    /// Covariance of all noise of the step.
    pub(crate) noise: &'a [f64],
}

/// Sees what a pass does. It is called through a pointer, so that a pass is compiled once.
pub(crate) trait Watch {
    /// Before the outputs of a row.
    fn at(&mut self, _row: usize, _filter: &Filter) {}

    fn take(&mut self, _taken: &Taken<'_>) {}

    fn step(&mut self, _made: &Made<'_>) -> Result<(), EstimationError> {
        Ok(())
    }
}

impl<'a> Pass<'a> {
    /// A pass over a whole record with its declared noise.
    #[must_use]
    pub fn new(record: &'a dyn LinearisedRecord, columns: &'a [Column]) -> Self {
        Self {
            record,
            columns,
            walks: Walks::default(),
            factors: &[],
            loose: &[],
            left_out: &(0..0),
            rows: usize::MAX,
        }
    }

    /// The same over a record that was linearised before, if there is one.
    #[must_use]
    pub fn on(self, kept: Option<&'a KeptRecord>) -> Self {
        match kept {
            Some(kept) => Self {
                record: kept,
                ..self
            },
            None => self,
        }
    }

    /// Eliminates the states. `watch` sees every whitened output value in the order of the filter.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`] if columns, factors or walks do not belong to the record, and
    /// those of the model.
    pub fn reduce(&self, mut watch: impl FnMut(&Whitened<'_>)) -> Result<Reduced, EstimationError> {
        self.reduced(&mut watch, false)
    }

    /// The same with the cost of the trajectory.
    ///
    /// # Errors
    /// As [`Self::reduce`], and [`EstimationError::InvalidArgument`] if the noise does not drive every state.
    pub fn reduce_with_cost(
        &self,
        mut watch: impl FnMut(&Whitened<'_>),
    ) -> Result<Reduced, EstimationError> {
        self.reduced(&mut watch, true)
    }

    fn reduced(
        &self,
        watch: &mut dyn FnMut(&Whitened<'_>),
        with_cost: bool,
    ) -> Result<Reduced, EstimationError> {
        let mut sums = Sums {
            gram: Gram::new(self.columns.len()),
            values: 0,
            rows: 0,
            last_row: None,
            log_variance: 0.0,
            cost: if with_cost {
                self.record.start()?.cost
            } else {
                f64::NAN
            },
            watch,
        };
        let filter = self.run(None, &mut sums)?;
        Ok(Reduced {
            gram: sums.gram.finish(),
            values: sums.values,
            rows: sums.rows,
            log_variance: sums.log_variance,
            trajectory_cost: sums.cost,
            last: filter.columns,
            last_covariance: filter.covariance,
        })
    }

    /// Number of rows.
    pub(crate) fn count(&self) -> usize {
        self.rows.min(self.record.rows())
    }

    /// Numbers of states and of noises, those of walks with them.
    pub(crate) fn sizes(&self) -> (usize, usize) {
        let (own, walks) = (self.record.layout(), self.walks.walks.len());
        (own.states + walks, own.noises + walks)
    }

    /// Makes the pass; with a `change` of the columns all are folded into the mean.
    pub(crate) fn run(
        &self,
        change: Option<&[f64]>,
        watch: &mut dyn Watch,
    ) -> Result<Filter, EstimationError> {
        let with_walks;
        let record: &dyn LinearisedRecord = if self.walks.walks.is_empty() {
            self.record
        } else {
            with_walks = WithWalks::new(self.record, self.walks)?;
            &with_walks
        };
        let rows = self.count();
        let mut running = Running::new(self, record, change)?;
        record.visit(rows, &mut |block| running.block(block, rows, watch))?;
        Ok(running.filter)
    }
}

/// What a column is in a pass.
enum Place {
    /// Derivatives by the parameter at this place.
    Parameter(usize),
    /// A change of a state in one step.
    Jump { row: usize, state: usize },
    /// A change of an output.
    Output(usize),
    /// A change of the first point.
    Start,
}

/// A pass in progress.
struct Running<'a> {
    pass: &'a Pass<'a>,
    layout: Layout,
    places: Vec<Place>,
    /// Number of columns, from the first, that are the first parameters of the record in their order.
    leading: usize,
    change: Option<&'a [f64]>,
    filter: Filter,
    /// Covariance of the noise of a step.
    noise: Vec<f64>,
    /// For each parameter what the change of the columns changes it by.
    by_change: Vec<f64>,
    /// Columns beside the leading ones that drive states in a step: column, place, weight.
    driving: Vec<(usize, usize, f64)>,
}

impl<'a> Running<'a> {
    fn new(
        pass: &'a Pass<'a>,
        record: &dyn LinearisedRecord,
        change: Option<&'a [f64]>,
    ) -> Result<Self, EstimationError> {
        let start = record.start()?;
        let layout = record.layout();
        let count = pass.columns.len();
        let factors = layout.outputs + layout.noises;
        if pass.count() == 0
            || !(pass.factors.is_empty() || pass.factors.len() == factors)
            || !(pass.loose.is_empty() || pass.loose.len() == layout.states)
            || change.is_some_and(|change| change.len() != count)
        {
            return Err(EstimationError::InvalidArgument {
                expected: "rows, one factor for each output, each noise and each walk, and one change a column",
            });
        }
        let places = pass.columns.iter().map(|column| place(column, &layout));
        let places =
            places
                .collect::<Option<Vec<_>>>()
                .ok_or(EstimationError::InvalidArgument {
                    expected: "columns of parameters, states and outputs of the record",
                })?;
        let is_driven = layout.noises > 0 || !pass.loose.is_empty();
        let folded = if change.is_some() { 0 } else { count };
        let mut filter = Filter::new(folded, &start, is_driven);
        for (index, column) in pass.columns.iter().enumerate() {
            if let Column::InitialState { row: 0, state } = column {
                match change {
                    Some(change) => filter.row_mut(*state)[0] += change[index],
                    None => filter.row_mut(*state)[index + 1] = 1.0,
                }
            }
        }
        let is_leading = |(index, column): &(usize, &Column)| matches!(column, Column::Parameter { parameter } if layout.parameters.get(*index) == Some(parameter));
        Ok(Self {
            leading: pass
                .columns
                .iter()
                .enumerate()
                .take_while(is_leading)
                .count(),
            noise: vec![0.0; layout.states * layout.states],
            by_change: vec![0.0; layout.parameters.len()],
            driving: Vec::new(),
            pass,
            layout,
            places,
            change,
            filter,
        })
    }

    fn factor(&self, noise: usize) -> f64 {
        self.pass.factors.get(noise).copied().unwrap_or(1.0)
    }

    fn block(
        &mut self,
        block: &LinearisedRows,
        rows: usize,
        watch: &mut dyn Watch,
    ) -> Result<(), EstimationError> {
        for index in 0..block.rows() {
            let row = block.first + index;
            if row >= rows {
                break;
            }
            watch.at(row, &self.filter);
            for output in 0..self.layout.outputs {
                let own = block.output(index, output);
                if !own.residual.is_nan() && !self.pass.left_out.contains(&row) {
                    self.observe(row, output, &own, watch)?;
                }
            }
            if row + 1 < rows {
                self.advance(row, &block.step(index), watch)?;
            }
        }
        Ok(())
    }

    /// Updates with an output.
    fn observe(
        &mut self,
        row: usize,
        output: usize,
        own: &OutputOf<'_>,
        watch: &mut dyn Watch,
    ) -> Result<(), EstimationError> {
        let variance = own.variance * self.factor(output);
        if !(variance > 0.0 && variance.is_finite()) {
            return Err(EstimationError::InvalidNoise { output });
        }
        self.filter.whitened[0] = own.residual;
        let direct = |index: usize| {
            let column = &self.pass.columns[index];
            match (&self.places[index], column) {
                (Place::Parameter(place), _) => match own.by_parameters.get(*place) {
                    Some(by) if *by != 0.0 => by * column.weight(row),
                    _ => 0.0,
                },
                (Place::Output(of), Column::Output { change, .. }) if *of == output => {
                    change.get(row).copied().unwrap_or(0.0)
                }
                _ => 0.0,
            }
        };
        let count = self.pass.columns.len();
        if let Some(change) = self.change {
            let changed = (0..count).map(|index| direct(index) * change[index]);
            self.filter.whitened[0] -= changed.sum::<f64>();
        } else {
            let whitened = &mut self.filter.whitened[1..];
            for (value, by) in whitened[..self.leading].iter_mut().zip(
                own.by_parameters
                    .iter()
                    .copied()
                    .chain(core::iter::repeat(0.0)),
            ) {
                *value = -by;
            }
            for index in self.leading..count {
                whitened[index] = -direct(index);
            }
        }
        let deviation = self.filter.update(own.by_states, variance)?;
        watch.take(&Taken {
            whitened: Whitened {
                row,
                output,
                deviation,
                columns: &self.filter.whitened,
            },
            jacobian: own.by_states,
            variance,
            cost: own.residual * own.residual / variance,
            cross: &self.filter.cross,
        });
        Ok(())
    }

    /// Predicts to the next row.
    fn advance(
        &mut self,
        row: usize,
        step: &StepOf<'_>,
        watch: &mut dyn Watch,
    ) -> Result<(), EstimationError> {
        let n = self.layout.states;
        self.noise.fill(0.0);
        let triangle = self.layout.triangle().max(1);
        for (index, share) in step.shares.chunks_exact(triangle).enumerate() {
            let factor = self.factor(self.layout.outputs + index);
            add_triangle(&mut self.noise, n, share, factor);
        }
        for (state, variance) in self.pass.loose.iter().enumerate() {
            self.noise[state * n + state] += variance;
        }
        self.filter.predict(step.by_states, &self.noise);
        for (state, defect) in step.defects.iter().enumerate() {
            self.filter.row_mut(state)[0] -= defect;
        }
        match self.change {
            Some(change) => self.drive_mean(row, step.by_parameters, change),
            None => self.drive_columns(row, step.by_parameters),
        }
        watch.step(&Made {
            by_states: step.by_states,
            shares: step.shares,
            defects: step.defects,
            noise: &self.noise,
        })
    }

    /// Adds what drives the columns.
    fn drive_columns(&mut self, row: usize, by_parameters: &[f64]) {
        let p = self.layout.parameters.len();
        self.driving.clear();
        for (index, place) in self.places.iter().enumerate().skip(self.leading) {
            match place {
                Place::Parameter(place) => {
                    let weight = self.pass.columns[index].weight(row);
                    if weight != 0.0 {
                        self.driving.push((index + 1, *place, weight));
                    }
                }
                Place::Jump { row: at, state } if *at == row => {
                    self.filter.row_mut(*state)[index + 1] += 1.0;
                }
                _ => {}
            }
        }
        for state in 0..self.layout.states {
            let by = &by_parameters[state * p..(state + 1) * p];
            let target = self.filter.row_mut(state);
            for (value, by) in target[1..=self.leading].iter_mut().zip(by) {
                *value += by;
            }
            for (column, place, weight) in &self.driving {
                target[*column] += by[*place] * weight;
            }
        }
    }

    /// Adds what drives the mean where the columns change.
    fn drive_mean(&mut self, row: usize, by_parameters: &[f64], change: &[f64]) {
        let p = self.layout.parameters.len();
        self.by_change.fill(0.0);
        for ((place, column), change) in self.places.iter().zip(self.pass.columns).zip(change) {
            match place {
                Place::Parameter(place) => self.by_change[*place] += column.weight(row) * change,
                Place::Jump { row: at, state } if *at == row => {
                    self.filter.row_mut(*state)[0] += change;
                }
                _ => {}
            }
        }
        for state in 0..self.layout.states {
            let by = &by_parameters[state * p..(state + 1) * p];
            self.filter.row_mut(state)[0] += dot(by, &self.by_change);
        }
    }
}

/// Where a column finds its derivatives; `None` if the record has no such parameter, state or output.
fn place(column: &Column, layout: &Layout) -> Option<Place> {
    Some(match column {
        Column::InitialState { state, .. } if *state < layout.states => Place::Start,
        Column::StateJump { row, state } if *state < layout.states => Place::Jump {
            row: *row,
            state: *state,
        },
        Column::Output { output, .. } if *output < layout.outputs => Place::Output(*output),
        _ => Place::Parameter(layout.place(column.parameter()?)?),
    })
}

/// Sums of the first pass.
struct Sums<'w> {
    gram: Gram,
    values: usize,
    rows: usize,
    last_row: Option<usize>,
    log_variance: f64,
    cost: f64,
    watch: &'w mut dyn FnMut(&Whitened<'_>),
}

impl Watch for Sums<'_> {
    fn take(&mut self, taken: &Taken<'_>) {
        let whitened = &taken.whitened;
        self.gram.add(whitened.columns);
        self.values += 1;
        self.rows += usize::from(self.last_row != Some(whitened.row));
        self.last_row = Some(whitened.row);
        self.log_variance += 2.0 * Scalar::ln(whitened.deviation);
        self.cost += taken.cost;
        (self.watch)(whitened);
    }

    fn step(&mut self, made: &Made<'_>) -> Result<(), EstimationError> {
        if !self.cost.is_nan() {
            self.cost += squared(made.noise, made.defects).ok_or(NOT_DRIVEN)?;
        }
        Ok(())
    }
}
