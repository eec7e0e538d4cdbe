//! A generated model along a trajectory in its moving chart, as a linearised record.

use core::ops::Range;

use gyrocal_estimation::{EstimationError, Integration, Manifold};

use crate::augmented::Walks;
use crate::column::{Column, ExtraColumns};
use crate::error::PassError;
use crate::record::{Layout, LinearisedRecord, LinearisedRows, Start};
use crate::series::Series;
use crate::small::squared;
use crate::step::{Stepper, map_columns, sandwich};
use crate::stop;

/// Rows that are linearised before they are handed over.
const BLOCK: usize = 256;

/// A record with the trajectory of a model.
pub struct Trajectory<'a, D, S, const M: usize, const Y: usize>
where
    D: Manifold<M, Y>,
{
    /// The model.
    pub model: &'a D,
    /// Its inputs; chart and held values are set row by row.
    pub inputs: D::Inputs,
    /// The record.
    pub series: &'a S,
    /// Integration rule of the rates.
    pub integration: Integration,
    /// Longest interval integrated in one step, s; longer ones are divided.
    pub longest_step_s: f64,
    /// Spectral densities of the noise inputs: unit squared times seconds.
    pub noise_density: [f64; M],
    /// Mean of the prior of the first point.
    pub prior: D::Point,
    /// Covariance of its error, as a correction of that point.
    pub prior_covariance: [[f64; M]; M],
    /// The trajectory, one point a row.
    pub points: &'a [D::Point],
    /// All parameters of the model.
    pub parameters: &'a [f64],
    /// Indices of those that derivatives are wanted by, in rising order.
    pub wanted: &'a [usize],
    /// Columns that are no parameters, with their present amplitudes.
    pub further: &'a ExtraColumns,
    /// Parameters that walk at random about their values.
    pub walks: Walks<'a>,
}

impl<D, S, const M: usize, const Y: usize> Clone for Trajectory<'_, D, S, M, Y>
where
    D: Manifold<M, Y>,
{
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, S, const M: usize, const Y: usize> Copy for Trajectory<'_, D, S, M, Y> where
    D: Manifold<M, Y>
{
}

impl<'a, D, S, const M: usize, const Y: usize> Trajectory<'a, D, S, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
{
    fn stepper(&self) -> Stepper<'a, D, D::Inputs, M, Y> {
        Stepper::new(
            self.model,
            self.inputs,
            self.integration,
            self.longest_step_s,
            self.noise_density,
        )
    }

    fn check(&self) -> Result<(), EstimationError> {
        let count = self.parameters.len();
        let rises = self.wanted.windows(2).all(|pair| pair[0] < pair[1]);
        if self.points.is_empty()
            || self.points.len() != self.series.rows()
            || count != self.model.parameters()
            || !rises
            || self.wanted.last().is_some_and(|index| *index >= count)
        {
            return Err(EstimationError::InvalidArgument {
                expected: "one point a row, all parameters of the model, and rising indices of those wanted",
            });
        }
        Ok(())
    }

    /// Sets the parameters that walk to their values in the step after a row.
    fn set_walks(&self, row: usize, parameters: &mut [f64]) {
        for (index, walk) in self.walks.walks.iter().enumerate() {
            parameters[walk.parameter] =
                self.parameters[walk.parameter] + self.walks.change(row, index);
        }
    }

    /// Change of the states over the step just made by what the further columns are.
    fn driven(&self, row: usize, columns: &[f64]) -> [f64; M] {
        let p = self.parameters.len();
        let mut change = [0.0; M];
        for (column, amplitude) in self.further.present() {
            match column {
                Column::StateJump { row: at, state } if *at == row => change[*state] += amplitude,
                _ => {
                    if let Some(parameter) = column.parameter() {
                        let weight = amplitude * column.weight(row);
                        for i in 0..M {
                            change[i] += weight * columns[i * p + parameter];
                        }
                    }
                }
            }
        }
        change
    }

    /// Adds a row to a block.
    fn add_row(
        &self,
        row: usize,
        (inputs, d_parameters): (&mut D::Inputs, &mut [f64]),
        to: &mut LinearisedRows,
    ) {
        let mut moving = [0.0; M];
        self.model.place(&self.points[row], &mut moving, inputs);
        self.series.at(row, inputs);
        let mut d_moving = [[0.0; M]; Y];
        let predicted = if self.model.has_chart() {
            self.model.output_jacobian_at_origin(
                self.parameters,
                inputs,
                &mut d_moving,
                d_parameters,
            )
        } else {
            self.model.output_jacobian(
                &moving,
                self.parameters,
                inputs,
                &mut d_moving,
                d_parameters,
            )
        };
        let measured = self.series.measured(row);
        let q = self.model.output_parameters();
        for output in 0..Y {
            let direct = &d_parameters[output * q..(output + 1) * q];
            let mut residual = measured[output] - predicted[output];
            residual -= self.further.output_change(row, output);
            for (column, amplitude) in self.further.present() {
                let by = column
                    .parameter()
                    .and_then(|parameter| direct.get(parameter));
                residual -= by.map_or(0.0, |by| amplitude * column.weight(row) * by);
            }
            to.residuals.push(residual);
            to.out_by_states.extend_from_slice(&d_moving[output]);
            let of_outputs = self.wanted.iter().filter_map(|index| direct.get(*index));
            to.out_by_parameters.extend(of_outputs);
        }
        to.variances
            .extend_from_slice(&self.series.noise_variance(row));
    }

    /// Adds the step after a row to a block.
    fn add_step(
        &self,
        row: usize,
        (stepper, parameters): (&mut Stepper<'a, D, D::Inputs, M, Y>, &mut [f64]),
        to: &mut LinearisedRows,
    ) -> Result<(), EstimationError> {
        self.set_walks(row, parameters);
        let (mut step, predicted) =
            stepper.advance(self.series, row, &self.points[row], parameters)?;
        let mut jump = self.model.difference(&predicted, &self.points[row + 1]);
        let p = self.parameters.len();
        if let Some(corrected) = self.model.corrected(&jump) {
            step.correct(&corrected);
            map_columns(&corrected.point, &mut stepper.columns, p);
        }
        for (jump, driven) in jump.iter_mut().zip(self.driven(row, &stepper.columns)) {
            *jump -= driven;
        }
        to.step_s
            .push(self.series.time_s(row + 1) - self.series.time_s(row));
        to.defects.extend_from_slice(&jump);
        to.by_states.extend_from_slice(step.moving.as_flattened());
        for i in 0..M {
            let own = &stepper.columns[i * p..(i + 1) * p];
            to.by_parameters
                .extend(self.wanted.iter().map(|index| own[*index]));
        }
        for share in &step.shares {
            for (i, of_row) in share.iter().enumerate() {
                to.shares.extend_from_slice(&of_row[..=i]);
            }
        }
        Ok(())
    }

    /// Open-loop simulation: the trajectory of the model from the first point, without measurements
    /// and without noise; further columns enter with their amplitudes. Parameters that walk stay as
    /// they are at the first row.
    ///
    /// # Errors
    /// Those of the model, and [`PassError::Stopped`].
    pub fn free_run(&self) -> Result<Vec<D::Point>, PassError> {
        self.free_run_over(0..self.points.len())
    }

    /// The same over some rows, from the point at the first of them.
    ///
    /// # Errors
    /// As [`Self::free_run`], and [`EstimationError::InvalidArgument`] if there are no such rows.
    pub fn free_run_over(&self, rows: Range<usize>) -> Result<Vec<D::Point>, PassError> {
        self.check()?;
        if rows.is_empty() || rows.end > self.points.len() {
            return Err(EstimationError::InvalidArgument {
                expected: "rows of the record, and at least one",
            }
            .into());
        }
        let mut stepper = self.stepper();
        let mut inputs = self.inputs;
        let mut points = Vec::with_capacity(rows.len());
        let mut point = self.points[rows.start];
        points.push(point);
        let mut parameters = self.parameters.to_vec();
        self.set_walks(rows.start, &mut parameters);
        for row in rows.start..rows.end - 1 {
            stop::check_at(row)?;
            let (_, predicted) = stepper.advance(self.series, row, &point, &parameters)?;
            let turn = self.driven(row, &stepper.columns);
            let mut moving = [0.0; M];
            self.model.place(&predicted, &mut moving, &mut inputs);
            self.model.correct(&mut moving, &mut inputs, &turn);
            point = self.model.point(&moving, &inputs);
            points.push(point);
        }
        Ok(points)
    }
}

impl<D, S, const M: usize, const Y: usize> LinearisedRecord for Trajectory<'_, D, S, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
{
    fn layout(&self) -> Layout {
        let q = self.model.output_parameters();
        Layout {
            states: M,
            outputs: Y,
            noises: M,
            parameters: self.wanted.into(),
            of_outputs: self.wanted.partition_point(|index| *index < q),
        }
    }

    fn rows(&self) -> usize {
        self.points.len()
    }

    fn start(&self) -> Result<Start, EstimationError> {
        self.check()?;
        let mut mean = self.model.difference(&self.points[0], &self.prior);
        // The prior is of a correction of its own mean; here it counts as one of the first point.
        let covariance = match self.model.corrected(&mean.map(|component| -component)) {
            Some(corrected) => sandwich(&corrected.correction, &self.prior_covariance),
            None => self.prior_covariance,
        };
        for (column, amplitude) in self.further.present() {
            if let Column::InitialState { row: 0, state } = column {
                mean[*state] += amplitude;
            }
        }
        let cost = squared(self.prior_covariance.as_flattened(), &mean).ok_or(
            EstimationError::InvalidArgument {
                expected: "a positive definite prior of the first point",
            },
        )?;
        Ok(Start {
            deviation: mean.to_vec(),
            covariance: covariance.as_flattened().to_vec(),
            cost,
            noises: Vec::new(),
        })
    }

    fn visit(
        &self,
        rows: usize,
        take: &mut dyn FnMut(&LinearisedRows) -> Result<(), PassError>,
    ) -> Result<(), PassError> {
        self.check()?;
        let rows = rows.min(self.points.len());
        let mut stepper = self.stepper();
        let mut inputs = self.inputs;
        let mut parameters = self.parameters.to_vec();
        let mut d_parameters = vec![0.0; Y * self.model.output_parameters()];
        let mut block = LinearisedRows::new(self.layout());
        for row in 0..rows {
            stop::check_at(row)?;
            self.add_row(row, (&mut inputs, &mut d_parameters), &mut block);
            if row + 1 < rows {
                self.add_step(row, (&mut stepper, &mut parameters), &mut block)?;
            }
            if block.rows() == BLOCK || row + 1 == rows {
                take(&block)?;
                block.clear(row + 1);
            }
        }
        Ok(())
    }
}
