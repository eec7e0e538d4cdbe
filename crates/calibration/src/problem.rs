//! The joint least-squares problem of several runs: their trajectories and the unknowns that they
//! share.
//!
//! In every run each parameter of the model is a sum of unknowns ([`RunProblem::parameter_unknowns`]):
//! a constant drift is that of the mean turn-on plus the offset of the run's own.

use gyrocal::estimation::Manifold;
use gyrocal::trajectory::Orientation;
use gyrocal::{Chart, Integration};
use gyrocal_inference::{
    Column, ExtraColumns, FurtherNoise, Pass, Series, Trajectory, Walk, Walks,
};

use crate::error::CalibrationError;
use crate::run::{Conditions, WeightedRows};
use crate::work;

/// One unknown of the joint problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknown {
    /// Mean of its prior.
    pub(crate) prior: f64,
    /// Standard deviation of its prior.
    pub(crate) sigma: f64,
    /// True if it is considered: it keeps its prior mean, and its variance enters the covariance of
    /// the others.
    pub(crate) considered: bool,
}

impl Unknown {
    /// An estimated unknown of prior mean zero.
    pub(crate) fn estimated(sigma: f64) -> Self {
        Self {
            prior: 0.0,
            sigma,
            considered: false,
        }
    }

    /// A considered unknown of value zero; without a sigma it counts as known.
    pub(crate) fn considered(sigma: Option<f64>) -> Self {
        Self {
            prior: 0.0,
            sigma: sigma.unwrap_or(0.0),
            considered: true,
        }
    }
}

/// One run within the joint problem.
#[derive(Clone)]
pub(crate) struct RunProblem<'a, I> {
    /// The samples with the covariance of their noise.
    pub(crate) rows: WeightedRows<'a>,
    /// Inputs of the model at the site.
    pub(crate) chart: Chart<f64, I>,
    /// Spectral density of each gyro's white noise, (deg/h)² s.
    pub(crate) noise_density: [f64; 3],
    /// Prior mean of the attitude at the first row.
    pub(crate) prior: Orientation,
    /// Covariance of the prior's error, a rotation vector in platform axes, rad².
    pub(crate) prior_covariance: [[f64; 3]; 3],
    /// Present attitude at each row.
    pub(crate) points: Vec<Orientation>,
    /// For each parameter of the model the unknowns whose sum it is; a parameter without unknowns is
    /// zero.
    pub(crate) parameter_unknowns: Vec<Vec<usize>>,
    /// Columns that are no parameters of the model.
    pub(crate) further: ExtraColumns,
    /// The unknown that is the amplitude of each of them.
    pub(crate) amplitudes: Vec<usize>,
    /// Parameters that walk at random about their values.
    pub(crate) walks: Vec<Walk>,
    /// Present change of each walk at each row, by rows; empty if none has changed yet.
    pub(crate) walk_changes: Vec<f64>,
}

impl<I> RunProblem<'_, I> {
    /// Replaces the walks; those of the same parameters go on from where they are.
    pub(crate) fn set_walks(&mut self, walks: Vec<Walk>) {
        let before: Vec<Option<usize>> = walks
            .iter()
            .map(|walk| {
                let mut old = self.walks.iter();
                old.position(|old| old.parameter == walk.parameter)
            })
            .collect();
        let stride = self.walks.len();
        let rows = self.walk_changes.len() / stride.max(1);
        self.walk_changes = (0..rows)
            .flat_map(|row| {
                let of_row = &self.walk_changes[row * stride..(row + 1) * stride];
                before
                    .iter()
                    .map(|place| place.map_or(0.0, |place| of_row[place]))
            })
            .collect();
        self.walks = walks;
    }

    /// For each column of a pass the unknowns whose sum its amplitude is: active parameters first,
    /// then further columns.
    pub(crate) fn column_unknowns(&self) -> Vec<&[usize]> {
        let parameters = self
            .parameter_unknowns
            .iter()
            .filter(|unknowns| !unknowns.is_empty());
        parameters
            .map(Vec::as_slice)
            .chain(self.amplitudes.iter().map(core::slice::from_ref))
            .collect()
    }
}

/// The joint problem of all runs.
#[derive(Clone)]
pub(crate) struct Problem<'a, D, I> {
    pub(crate) model: &'a D,
    pub(crate) integration: Integration,
    pub(crate) longest_step_s: f64,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) runs: Vec<RunProblem<'a, I>>,
    /// Present value of every unknown.
    pub(crate) values: Vec<f64>,
}

impl<'a, D, I> Problem<'a, D, I>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    /// The parameters of the model in one run.
    pub(crate) fn parameters(&self, run: usize) -> Vec<f64> {
        self.runs[run]
            .parameter_unknowns
            .iter()
            .map(|unknowns| unknowns.iter().map(|index| self.values[*index]).sum())
            .collect()
    }

    /// Specific force of the model at each row of a run for the attitudes `points`, g.
    pub(crate) fn outputs(
        &self,
        run: usize,
        points: &[Orientation],
        parameters: &[f64],
    ) -> Vec<[f64; 3]> {
        let run = &self.runs[run];
        let (mut chart, mut moving) = (run.chart, [0.0; 3]);
        points
            .iter()
            .enumerate()
            .map(|(row, point)| {
                self.model.place(point, &mut moving, &mut chart);
                Series::<Chart<f64, I>, 3>::at(&run.rows, row, &mut chart);
                let mut outputs_g = self.model.output(&moving, parameters, &chart);
                for (output, reading_g) in outputs_g.iter_mut().enumerate() {
                    *reading_g += run.further.output_change(row, output);
                }
                outputs_g
            })
            .collect()
    }

    /// A run with its trajectory, with derivatives by the `wanted` parameters.
    pub(crate) fn trajectory<'s>(
        &'s self,
        index: usize,
        parameters: &'s [f64],
        wanted: &'s [usize],
        further: &'s ExtraColumns,
    ) -> Trajectory<'s, D, WeightedRows<'a>, 3, 3> {
        let run = &self.runs[index];
        Trajectory {
            model: self.model,
            inputs: run.chart,
            series: &run.rows,
            integration: self.integration,
            longest_step_s: self.longest_step_s,
            noise_density: run.noise_density,
            prior: run.prior,
            prior_covariance: run.prior_covariance,
            points: &run.points,
            parameters,
            wanted,
            further,
            walks: Walks {
                walks: &run.walks,
                changes: &run.walk_changes,
            },
        }
    }

    /// Open-loop simulation of a run from its first attitude.
    pub(crate) fn free_run(
        &self,
        index: usize,
        parameters: &[f64],
    ) -> Result<Vec<Orientation>, CalibrationError> {
        self.trajectory(index, parameters, &[], &self.runs[index].further)
            .free_run()
            .map_err(|error| CalibrationError::pass(index, error))
    }

    /// Makes a pass over a run with its own columns.
    pub(crate) fn with_run<R>(
        &self,
        index: usize,
        parameters: &[f64],
        pass: impl FnOnce(&Pass<'_>) -> R,
    ) -> R {
        let further = &self.runs[index].further;
        self.with_active(index, parameters, &self.active(index), further, pass)
    }

    /// The same over its first `rows` rows.
    pub(crate) fn with_first_rows<R>(
        &self,
        index: usize,
        parameters: &[f64],
        rows: usize,
        pass: impl FnOnce(&Pass<'_>) -> R,
    ) -> R {
        let (active, further) = (self.active(index), &self.runs[index].further);
        self.with_pass((index, rows), parameters, &active, further, pass)
    }

    /// Makes a pass over a run with the columns of the `active` parameters and `further` ones.
    pub(crate) fn with_active<R>(
        &self,
        index: usize,
        parameters: &[f64],
        active: &[usize],
        further: &ExtraColumns,
        pass: impl FnOnce(&Pass<'_>) -> R,
    ) -> R {
        self.with_pass((index, usize::MAX), parameters, active, further, pass)
    }

    fn with_pass<R>(
        &self,
        (index, rows): (usize, usize),
        parameters: &[f64],
        active: &[usize],
        further: &ExtraColumns,
        pass: impl FnOnce(&Pass<'_>) -> R,
    ) -> R {
        let own = active.iter().map(|parameter| Column::Parameter {
            parameter: *parameter,
        });
        let columns: Vec<Column> = own.chain(further.columns().iter().cloned()).collect();
        let mut wanted: Vec<usize> = columns.iter().filter_map(Column::parameter).collect();
        wanted.sort_unstable();
        wanted.dedup();
        work::carry(columns.len());
        let trajectory = self.trajectory(index, parameters, &wanted, further);
        let result = pass(&Pass {
            further: FurtherNoise {
                walks: trajectory.walks,
                ..FurtherNoise::default()
            },
            rows,
            ..Pass::new(&trajectory, &columns)
        });
        work::count_rows(rows.min(trajectory.points.len()));
        result
    }

    /// Indices of the parameters of the model that have an unknown in a run.
    pub(crate) fn active(&self, index: usize) -> Vec<usize> {
        let unknowns = &self.runs[index].parameter_unknowns;
        (0..unknowns.len())
            .filter(|parameter| !unknowns[*parameter].is_empty())
            .collect()
    }

    /// Indices of the unknowns that are estimated.
    pub(crate) fn estimated(&self) -> Vec<usize> {
        (0..self.unknowns.len())
            .filter(|index| !self.unknowns[*index].considered)
            .collect()
    }

    /// The priors' part of twice the cost: squared distances of the estimated unknowns from their
    /// prior means over their variances.
    pub(crate) fn prior_cost(&self) -> f64 {
        self.unknowns
            .iter()
            .zip(&self.values)
            .filter(|(unknown, _)| !unknown.considered)
            .map(|(unknown, value)| ((value - unknown.prior) / unknown.sigma).powi(2))
            .sum()
    }
}
