//! Predictive density of a record, open-loop drift, and estimates against record length.

use core::ops::Range;

use gyrocal::Catalogue;
use gyrocal::trajectory::Orientation;
use gyrocal_inference::{Trajectory, Walks};
use nalgebra::{Cholesky, DMatrix, DVector};

use super::{AXES, FittedPlatform};
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use gyrocal_hypothesis::ExtraColumns;

/// 1 deg/h in rad/s.
const RAD_PER_S: f64 = core::f64::consts::PI / (180.0 * 3600.0);

/// Mean and covariance of all parameters of [`Catalogue`] before a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    /// The mean.
    pub mean: Vec<f64>,
    /// A factor L of the covariance L Lᵀ, with a row for each parameter; those with nothing in
    /// their row are known.
    pub factor: DMatrix<f64>,
}

/// A constant drift that walks, at the end of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct WalkEnd {
    /// Index of the parameter of [`Catalogue`].
    pub parameter: usize,
    /// Its change since the first row.
    pub change: f64,
    /// Derivatives of the change by the values of the fit.
    pub by_values: Vec<f64>,
    /// Standard deviation of the change with the values known.
    pub sigma: f64,
    /// Variance that it gains in a second.
    pub density: f64,
}

/// Estimates from the first rows of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimates {
    /// The nine coefficients.
    pub coefficients: [f64; PARAMETERS],
    /// Their standard deviations.
    pub sigmas: [f64; PARAMETERS],
}

impl FittedPlatform<'_> {
    /// Logarithm of the density of this fit's record by what is expected of the parameters,
    /// linearised about this fit: parameters and attitudes integrated out, further columns where
    /// the fit has them.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`] and [`CalibrationError::NotPositiveDefinite`].
    pub fn log_density_given(&self, expected: &Expectation) -> Result<f64, CalibrationError> {
        let here = self.parameters();
        let active: Vec<usize> = (0..Catalogue::PARAMETERS)
            .filter(|index| {
                let mut walks = self.problem.runs[0].walks.iter();
                expected.factor.row(*index).iter().any(|x| *x != 0.0)
                    || walks.any(|walk| walk.parameter == *index)
                    || expected.mean[*index] != here[*index]
            })
            .collect();
        let mut fixed = ExtraColumns::new(self.extension.columns.columns().to_vec());
        let amplitudes = self.problem.runs[0].amplitudes.iter();
        fixed.set_amplitudes(amplitudes.map(|unknown| self.problem.values[*unknown]));
        let reduced = self
            .problem
            .with_active(0, &here, &active, &fixed, |pass| pass.reduce(|_| ()))
            .map_err(|error| CalibrationError::pass(0, error))?;
        let count = active.len();
        let information = reduced.gram.view((1, 1), (count, count)).into_owned();
        let off = DVector::from_fn(count, |i, _| expected.mean[active[i]] - here[active[i]]);
        // Columns are derivatives of the innovations. Cost and gradient at the mean.
        let gradient = reduced.gram.view((1, 0), (count, 1)) + &information * &off;
        let cost = reduced.gram[(0, 0)]
            + 2.0
                * (0..count)
                    .map(|i| reduced.gram[(0, i + 1)] * off[i])
                    .sum::<f64>()
            + (&information * &off).dot(&off);
        let factor = DMatrix::from_fn(count, expected.factor.ncols(), |i, j| {
            expected.factor[(active[i], j)]
        });
        let mut inner = factor.transpose() * &information * &factor;
        for i in 0..inner.nrows() {
            inner[(i, i)] += 1.0;
        }
        let cholesky = Cholesky::new(inner).ok_or(CalibrationError::NotPositiveDefinite)?;
        let pull = factor.transpose() * gradient.column(0);
        let gained = cholesky.solve(&pull).dot(&pull);
        let determinant = 2.0 * cholesky.l().diagonal().iter().map(|x| x.ln()).sum::<f64>();
        Ok(-0.5
            * (cost - gained
                + determinant
                + reduced.log_variance
                + reduced.values as f64 * core::f64::consts::TAU.ln()))
    }

    /// The constant drifts that walk, at the end of the record.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn walk_ends(&self) -> Result<Vec<WalkEnd>, CalibrationError> {
        let leg = &self.problem.runs[0];
        let count = leg.walks.len();
        if count == 0 {
            return Ok(Vec::new());
        }
        let parameters = self.parameters();
        let reduced = self
            .problem
            .with_run(0, &parameters, |pass| pass.reduce(|_| ()))
            .map_err(|error| CalibrationError::pass(0, error))?;
        let columns = leg.column_unknowns();
        let stride = columns.len() + 1;
        let changes = leg.walk_changes.len().saturating_sub(count);
        let ends = leg.walks.iter().enumerate().map(|(index, walk)| {
            let row = &reduced.last[(AXES + index) * stride..][..stride];
            let mut by_values = vec![0.0; self.problem.unknowns.len()];
            for (unknowns, derivative) in columns.iter().zip(&row[1..]) {
                for unknown in *unknowns {
                    by_values[*unknown] += derivative;
                }
            }
            WalkEnd {
                parameter: walk.parameter,
                change: leg.walk_changes.get(changes + index).unwrap_or(&0.0) + row[0],
                by_values,
                sigma: reduced.last_covariance[(AXES + index) * (AXES + count + 1)]
                    .max(0.0)
                    .sqrt(),
                density: walk.density,
            }
        });
        Ok(ends.collect())
    }

    /// Attitudes at the rows of a range if the platform starts from the smoothed one at the first
    /// of them and drifts by these parameters of [`Catalogue`], without noise.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn drift_from(
        &self,
        parameters: &[f64],
        rows: Range<usize>,
    ) -> Result<Vec<Orientation>, CalibrationError> {
        let none = ExtraColumns::default();
        Trajectory {
            walks: Walks::default(),
            ..self.problem.trajectory(0, parameters, &[], &none)
        }
        .free_run_over(rows)
        .map_err(|error| CalibrationError::pass(0, error))
    }

    /// Variance that the gyros' white noise adds to the attitude about each axis, rad²/s.
    #[must_use]
    pub fn walk_rad2_per_s(&self) -> [f64; 3] {
        self.problem.runs[0]
            .noise_density
            .map(|density| density * RAD_PER_S * RAD_PER_S)
    }

    /// Estimates of the coefficients from the rows up to and including each of `rows`, in rising
    /// order, linearised about this fit. `None` where so few rows do not determine an unknown
    /// without a prior.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn convergence(&self, rows: &[usize]) -> Result<Vec<Option<Estimates>>, CalibrationError> {
        let count = self.problem.unknowns.len();
        let columns = self.problem.runs[0].column_unknowns();
        let mut gram = DMatrix::<f64>::zeros(count, count);
        let mut gradient = DVector::<f64>::zeros(count);
        let mut found = Vec::with_capacity(rows.len());
        let mut unknowns = vec![0.0; count];
        let parameters = self.parameters();
        self.problem
            .with_run(0, &parameters, |pass| {
                pass.reduce(|value| {
                    while rows.get(found.len()).is_some_and(|row| *row < value.row) {
                        found.push(self.estimates(&gram, &gradient));
                    }
                    unknowns.fill(0.0);
                    for (column, value) in columns.iter().zip(&value.columns[1..]) {
                        for unknown in *column {
                            unknowns[*unknown] += value;
                        }
                    }
                    for i in 0..count {
                        gradient[i] -= unknowns[i] * value.columns[0];
                        for j in 0..=i {
                            gram[(i, j)] += unknowns[i] * unknowns[j];
                        }
                    }
                })
            })
            .map_err(|error| CalibrationError::pass(0, error))?;
        while found.len() < rows.len() {
            found.push(self.estimates(&gram, &gradient));
        }
        Ok(found)
    }

    fn estimates(&self, gram: &DMatrix<f64>, gradient: &DVector<f64>) -> Option<Estimates> {
        let mut information = gram.clone();
        let mut gradient = gradient.clone();
        for (i, unknown) in self.problem.unknowns.iter().enumerate() {
            let weight = unknown.sigma.powi(-2);
            information[(i, i)] += weight;
            gradient[i] += weight * (unknown.prior - self.problem.values[i]);
        }
        // The lower triangle is all that it reads.
        let cholesky = Cholesky::new(information)?;
        let change = cholesky.solve(&gradient);
        let covariance = cholesky.inverse();
        Some(Estimates {
            coefficients: core::array::from_fn(|i| self.problem.values[i] + change[i]),
            sigmas: core::array::from_fn(|i| covariance[(i, i)].sqrt()),
        })
    }
}
