//! A pass in progress.

use gyrocal_estimation::EstimationError;

use super::{Made, Pass, Taken, Watch, Whitened};
use crate::column::Column;
use crate::error::PassError;
use crate::filter::Filter;
use crate::record::{Layout, LinearisedRecord, LinearisedRows, OutputOf, StepOf};
use crate::small::{add_triangle, dot};
use crate::stop;

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
pub(super) struct Running<'a> {
    pass: &'a Pass<'a>,
    layout: Layout,
    places: Vec<Place>,
    /// Number of columns, from the first, that are the first parameters of the record in their order.
    leading: usize,
    change: Option<&'a [f64]>,
    pub(super) filter: Filter,
    /// Covariance of the noise of a step.
    noise: Vec<f64>,
    /// For each parameter what the change of the columns changes it by.
    by_change: Vec<f64>,
    /// Columns beside the leading ones that drive states in a step: column, place, weight.
    driving: Vec<(usize, usize, f64)>,
}

impl<'a> Running<'a> {
    pub(super) fn new(
        pass: &'a Pass<'a>,
        record: &dyn LinearisedRecord,
        change: Option<&'a [f64]>,
        watch: &mut dyn Watch,
    ) -> Result<Self, EstimationError> {
        let mut start = record.start()?;
        let layout = record.layout();
        let count = pass.columns.len();
        let factors = layout.outputs + layout.noises;
        if pass.count() == 0
            || !(pass.factors.is_empty() || pass.factors.len() == factors)
            || !(pass.loose.is_empty() || pass.loose.len() == layout.states)
            || change.is_some_and(|change| change.len() != count)
        {
            return Err(EstimationError::InvalidArgument {
                expected: "rows, one factor for each output and each noise, and one change a column",
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
        for (state, noise, declared) in core::mem::take(&mut start.noises) {
            let factor = pass.factors.get(layout.outputs + noise);
            let variance = declared * factor.copied().unwrap_or(1.0);
            start.covariance[state * layout.states + state] += variance;
            watch.begin(state, noise, variance);
        }
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

    pub(super) fn block(
        &mut self,
        block: &LinearisedRows,
        rows: usize,
        watch: &mut dyn Watch,
    ) -> Result<(), PassError> {
        for index in 0..block.rows() {
            let row = block.first + index;
            if row >= rows {
                break;
            }
            stop::check_at(row)?;
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
