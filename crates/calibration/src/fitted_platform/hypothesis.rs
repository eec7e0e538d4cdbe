//! Score tests of the catalogue's effects in a fitted platform.

use gyrocal_hypothesis::{
    Column, Covariate, FittedModel, ModelExtension, Plant, RateNoise, RateNoiseFit, Singular,
    StateJump,
};
use nalgebra::{DMatrix, DVector};

use super::FittedPlatform;
use crate::error::CalibrationError;
use crate::gyro_axes::GyroAxes;
use crate::platform::{PLATFORM, covariates};
use crate::work::work;

impl From<Singular> for CalibrationError {
    fn from(_: Singular) -> Self {
        Self::NotPositiveDefinite
    }
}

impl FittedModel for FittedPlatform<'_> {
    type Error = CalibrationError;

    fn plant(&self) -> &'static Plant {
        &PLATFORM
    }

    fn extension(&self) -> &ModelExtension {
        FittedPlatform::extension(self)
    }

    fn covariates(&self) -> Vec<Covariate> {
        covariates(&self.along_instruments(self.predicted_g()))
    }

    fn values(&self) -> &[f64] {
        FittedPlatform::values(self)
    }

    fn covariance(&self) -> &DMatrix<f64> {
        FittedPlatform::covariance(self)
    }

    fn degrees_of_freedom(&self) -> Result<Vec<f64>, CalibrationError> {
        FittedPlatform::degrees_of_freedom(self)
    }

    fn prior_sigma(&self) -> Vec<f64> {
        FittedPlatform::prior_sigma(self)
    }

    fn cost(&self) -> f64 {
        FittedPlatform::cost(self)
    }

    fn refitted(&self, extension: &ModelExtension) -> Result<Self, CalibrationError> {
        FittedPlatform::refitted(self, extension)
    }

    fn rate_noise(&self) -> RateNoise {
        FittedPlatform::rate_noise(self)
    }

    fn walk_intervals(&self) -> Result<Vec<Option<[f64; 2]>>, CalibrationError> {
        Self::walk_intervals(self)
    }

    fn fit_rate_noise(
        &self,
        walking: &[usize],
        absent: &[usize],
    ) -> Result<RateNoiseFit, CalibrationError> {
        FittedPlatform::fit_rate_noise(self, walking, absent)
    }

    fn restricted_noise(&self) -> Result<Option<RateNoise>, CalibrationError> {
        FittedPlatform::restricted_noise(self).map(Some)
    }

    fn with_rate_noise(&self, noise: &RateNoise) -> Result<Self, CalibrationError> {
        FittedPlatform::with_rate_noise(self, noise)
    }

    fn signatures_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, CalibrationError> {
        self.gram_of_signatures(further)
    }

    fn conditional_gram(&self, further: &[Column]) -> Result<DMatrix<f64>, CalibrationError> {
        Ok(self.conditional(further)?.gram)
    }

    fn work(&self) -> u64 {
        work()
    }

    fn state_jumps(&self) -> Result<Vec<Option<StateJump>>, CalibrationError> {
        let mut jumps = self.jumps()?;
        for (run, rows) in self.record_rows().into_iter().enumerate() {
            let Some(axes) = &self.problem.runs[run].rows.gyro_axes else {
                continue;
            };
            for (row, jump) in jumps[rows].iter_mut().enumerate() {
                if let Some(jump) = jump {
                    turn(jump, axes, row);
                }
            }
        }
        Ok(jumps)
    }
}

/// A jump about the axes of the instruments, from one about those of the platform.
fn turn(jump: &mut StateJump, axes: &GyroAxes, row: usize) {
    let along = |vector: &DVector<f64>| {
        let turned = axes.along_gyros(row, &[vector[0], vector[1], vector[2]]);
        DVector::from_row_slice(&turned)
    };
    jump.score = along(&jump.score);
    jump.outputs = along(&jump.outputs);
    let half = DMatrix::from_columns(&core::array::from_fn::<_, 3, _>(|i| {
        let column = jump.information.column(i).into_owned();
        along(&column)
    }));
    let whole = half.transpose();
    jump.information = DMatrix::from_columns(&core::array::from_fn::<_, 3, _>(|i| {
        along(&whole.column(i).into_owned())
    }));
}
