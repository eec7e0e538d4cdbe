//! A pass over a linearised record: one row after the other, with the columns carried along.

mod running;

use core::ops::Range;

use gyrocal_estimation::EstimationError;
use gyrocal_scalar::Scalar;
use nalgebra::DMatrix;

use crate::augmented::{Augmented, FurtherNoise};
use crate::column::Column;
use crate::error::PassError;
use crate::filter::Filter;
use crate::gram::Gram;
use crate::record::{KeptRecord, LinearisedRecord};
use crate::small::squared;
use running::Running;

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
    /// Noise beyond that of the record.
    pub further: FurtherNoise<'a>,
    /// Factors of the declared variances: of the outputs, of the noises, of the further noises. All are one if
    /// there are none.
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
            .field("further", &self.further)
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
    /// Deviation of the last point and then of the further states there, each with its derivatives by columns:
    /// rows of 1 + columns.
    pub last: Vec<f64>,
    /// Covariance of the last point and of the further states there given the parameters, by rows.
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
    /// Before the first row: the variance of a state that goes with a noise, at the present size of that.
    fn begin(&mut self, _state: usize, _noise: usize, _variance: f64) {}

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
            further: FurtherNoise::default(),
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
    /// those of the model; [`PassError::Stopped`].
    pub fn reduce(&self, mut watch: impl FnMut(&Whitened<'_>)) -> Result<Reduced, PassError> {
        self.reduced(&mut watch, false)
    }

    /// The same with the cost of the trajectory.
    ///
    /// # Errors
    /// As [`Self::reduce`], and [`EstimationError::InvalidArgument`] if the noise does not drive every state.
    pub fn reduce_with_cost(
        &self,
        mut watch: impl FnMut(&Whitened<'_>),
    ) -> Result<Reduced, PassError> {
        self.reduced(&mut watch, true)
    }

    fn reduced(
        &self,
        watch: &mut dyn FnMut(&Whitened<'_>),
        with_cost: bool,
    ) -> Result<Reduced, PassError> {
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

    /// Numbers of states and of noises, further ones with them.
    pub(crate) fn sizes(&self) -> (usize, usize) {
        let (own, (states, noises)) = (self.record.layout(), self.further.sizes());
        (own.states + states, own.noises + noises)
    }

    /// Makes the pass; with a `change` of the columns all are folded into the mean.
    pub(crate) fn run(
        &self,
        change: Option<&[f64]>,
        watch: &mut dyn Watch,
    ) -> Result<Filter, PassError> {
        let augmented;
        let record: &dyn LinearisedRecord = if self.further.sizes() == (0, 0) {
            self.record
        } else {
            augmented = Augmented::new(self.record, self.further)?;
            &augmented
        };
        let rows = self.count();
        let mut running = Running::new(self, record, change, watch)?;
        record.visit(rows, &mut |block| running.block(block, rows, watch))?;
        Ok(running.filter)
    }
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
