//! One simulated record, calibrated and compared with its truth.

use gyrocal_calibration::{Calibration, Options, calibrate};
use gyrocal_truth::Simulation;
use nalgebra::{SMatrix, SVector};

use super::Error;

/// A calibration and the truth.
pub(crate) struct Judged {
    pub(crate) calibration: Calibration,
    /// Estimate minus truth.
    pub(crate) error: [f64; 9],
    truth: [f64; 9],
}

pub(crate) fn judge(simulation: &Simulation, options: &Options) -> Result<Judged, Error> {
    let calibration = calibrate(&simulation.record, &simulation.bench, options, |_| ())?;
    let truth = simulation
        .truth
        .coefficients
        .named()
        .map(|(_, value, _)| value);
    let estimate = calibration.drift.to_array();
    Ok(Judged {
        error: core::array::from_fn(|i| estimate[i] - truth[i]),
        truth,
        calibration,
    })
}

impl Judged {
    /// Normalised estimation error squared of the nine coefficients; 9 is expected.
    pub(crate) fn nees(&self) -> Result<f64, Error> {
        let covariance = SMatrix::<f64, 9, 9>::from_fn(|i, j| self.calibration.covariance[i][j]);
        let error = SVector::from(self.error);
        let cholesky = covariance
            .cholesky()
            .ok_or("the covariance is not positive definite")?;
        Ok(error.dot(&cholesky.solve(&error)))
    }

    /// Errors in their sigmas.
    pub(crate) fn in_sigmas(&self) -> [f64; 9] {
        core::array::from_fn(|i| self.error[i] / self.calibration.covariance[i][i].sqrt())
    }

    /// Errors in percent of the coefficients.
    pub(crate) fn percent(&self) -> [f64; 9] {
        core::array::from_fn(|i| 100.0 * self.error[i] / self.truth[i])
    }
}
