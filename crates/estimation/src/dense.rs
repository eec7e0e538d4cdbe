//! The textbook filter on dense matrices: a reference for tests and benches.
//!
//! Extended Kalman filter with P = Φ P Φᵀ + Γ Q Γᵀ, S by Cholesky, and the update in Joseph
//! form, (I - K H) P (I - K H)ᵀ + K R Kᵀ (Bar-Shalom, Li, Kirubarajan, *Estimation with
//! Applications to Tracking and Navigation*, 2001, 5.2.3). Φ comes from the dense variational
//! equation. Written from the equations, it shares nothing with the structured filter but the
//! model; measured as it stands by the bench `filter_step`, so it is not to be tuned.

use gyrocal_scalar::{RatesJacobian, Recentre};
use nalgebra::{Cholesky, SMatrix, SVector};

use crate::error::EstimationError;
use crate::recentring::Recentring;
use crate::transition::Integration;

/// Dense extended Kalman filter with `N` states, `M` of them moving, and `Y` outputs.
#[derive(Clone, Debug)]
pub struct DenseFilter<D, I, const M: usize, const Y: usize, const N: usize> {
    model: D,
    /// Inputs of the model besides its state; they carry the chart.
    pub inputs: I,
    /// The state: moving states, then parameters.
    pub state: SVector<f64, N>,
    /// Its error covariance.
    pub covariance: SMatrix<f64, N, N>,
    integration: Integration,
    recentring: Recentring<f64>,
}

/// Residual, its covariance and its normalised square.
#[derive(Clone, Copy, Debug)]
pub struct DenseInnovation<const Y: usize> {
    /// Measured minus predicted output.
    pub residual: SVector<f64, Y>,
    /// S = H P Hᵀ + R.
    pub covariance: SMatrix<f64, Y, Y>,
    /// Normalised innovation squared.
    pub nis: f64,
}

impl<D, const M: usize, const Y: usize, const N: usize> DenseFilter<D, D::Inputs, M, Y, N>
where
    D: Recentre<f64, M, Y>,
{
    /// A filter with the given state and error covariance, in the coordinates of `inputs`.
    #[must_use]
    pub fn new(
        model: D,
        inputs: D::Inputs,
        integration: Integration,
        recentring: Recentring<f64>,
        state: SVector<f64, N>,
        covariance: SMatrix<f64, N, N>,
    ) -> Self {
        let mut filter = Self {
            model,
            inputs,
            state,
            covariance,
            integration,
            recentring,
        };
        let mut moving = filter.moving();
        if recentring.wanted(&moving)
            && let Some(map) = filter.model.recentre(&mut moving, &mut filter.inputs)
        {
            filter.set_moving(moving);
            let mut full = SMatrix::<f64, N, N>::identity();
            full.fixed_view_mut::<M, M>(0, 0)
                .copy_from(&to_matrix(&map));
            filter.covariance = full * filter.covariance * full.transpose();
        }
        filter
    }

    /// Predicts over `dt` seconds with held noise of the given spectral densities.
    pub fn predict(&mut self, dt: f64, noise_density: &[f64; M]) {
        let (moving, mut rows, mut noise) = self.transition(dt);
        self.set_moving(moving);
        let mut moving = moving;
        if self.recentring.wanted(&moving)
            && let Some(map) = self.model.recentre(&mut moving, &mut self.inputs)
        {
            let map = to_matrix(&map);
            rows = map * rows;
            noise = map * noise;
            self.set_moving(moving);
        }
        let mut phi = SMatrix::<f64, N, N>::identity();
        phi.fixed_view_mut::<M, N>(0, 0).copy_from(&rows);
        let q = SMatrix::<f64, M, M>::from_diagonal(&SVector::from(noise_density.map(|d| d / dt)));
        self.covariance = phi * self.covariance * phi.transpose();
        let mut corner = self.covariance.fixed_view_mut::<M, M>(0, 0);
        corner += noise * q * noise.transpose();
    }

    /// Updates with a complete measurement.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`] if S has no Cholesky factor.
    pub fn update(
        &mut self,
        measured: &[f64; Y],
        noise_variance: &[f64; Y],
    ) -> Result<DenseInnovation<Y>, EstimationError> {
        let q = self.model.output_parameters();
        let mut moving_columns = [[0.0; M]; Y];
        let mut parameter_columns = [[0.0; N]; Y];
        let predicted = self.model.output_jacobian(
            &self.moving(),
            &self.state.as_slice()[M..],
            &self.inputs,
            &mut moving_columns,
            &mut parameter_columns.as_flattened_mut()[..Y * q],
        );
        let mut h = SMatrix::<f64, Y, N>::zeros();
        for i in 0..Y {
            for j in 0..M {
                h[(i, j)] = moving_columns[i][j];
            }
            for j in 0..q {
                h[(i, M + j)] = parameter_columns.as_flattened()[i * q + j];
            }
        }
        let r = SMatrix::<f64, Y, Y>::from_diagonal(&SVector::from(*noise_variance));
        let residual = SVector::from(*measured) - SVector::from(predicted);
        let cross = self.covariance * h.transpose();
        let covariance = h * cross + r;
        let cholesky =
            Cholesky::new(covariance).ok_or(EstimationError::NotPositiveDefinite { state: 0 })?;
        let inverse = cholesky.inverse();
        let gain = cross * inverse;
        let nis = residual.dot(&(inverse * residual));
        let correction = gain * residual;
        let joseph = SMatrix::<f64, N, N>::identity() - gain * h;
        self.covariance =
            joseph * self.covariance * joseph.transpose() + gain * r * gain.transpose();
        self.apply(&correction);
        Ok(DenseInnovation {
            residual,
            covariance,
            nis,
        })
    }

    fn apply(&mut self, correction: &SVector<f64, N>) {
        if self.recentring == Recentring::EveryStep {
            let mut moving = self.moving();
            let mut change = [0.0; M];
            change.copy_from_slice(&correction.as_slice()[..M]);
            self.state += correction;
            self.model.correct(&mut moving, &mut self.inputs, &change);
            self.set_moving(moving);
        } else {
            self.state += correction;
        }
    }

    /// Moving states at the end of the step, the moving rows of Φ, and Γ.
    fn transition(&self, dt: f64) -> ([f64; M], SMatrix<f64, M, N>, SMatrix<f64, M, M>) {
        let (stages, nodes, weights): (usize, [f64; 4], [f64; 4]) = match self.integration {
            Integration::Euler { .. } => (1, [0.0; 4], [1.0, 0.0, 0.0, 0.0]),
            Integration::Rk4 { .. } => (
                4,
                [0.0, 0.5, 0.5, 1.0],
                [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0],
            ),
        };
        let substeps = self.integration.substeps();
        let h = dt / f64::from(substeps);
        let mut moving = SVector::<f64, M>::from(self.moving());
        let mut rows = SMatrix::<f64, M, N>::identity();
        let mut noise = SMatrix::<f64, M, M>::zeros();
        for substep in 0..substeps {
            let (start, start_rows, start_noise) = (moving, rows, noise);
            let mut rate = SVector::<f64, M>::zeros();
            let mut rate_rows = SMatrix::<f64, M, N>::zeros();
            let mut rate_noise = SMatrix::<f64, M, M>::zeros();
            for stage in 0..stages {
                let node = nodes[stage] * h;
                let (f, f_rows, f_noise);
                (rate, f, f_rows, f_noise) = self.rates(&(start + rate * node));
                if substep == 0 && stage == 0 {
                    // The sensitivities start from the identity and from zero.
                    rate_rows = f_rows;
                    let mut moving_columns = rate_rows.fixed_view_mut::<M, M>(0, 0);
                    moving_columns += f;
                    rate_noise = f_noise;
                } else {
                    rate_rows = f * (start_rows + rate_rows * node) + f_rows;
                    rate_noise = f * (start_noise + rate_noise * node) + f_noise;
                }
                moving += rate * (weights[stage] * h);
                rows += rate_rows * (weights[stage] * h);
                noise += rate_noise * (weights[stage] * h);
            }
        }
        (moving.into(), rows, noise)
    }

    /// Rates with their Jacobians by moving states, all states (parameters only), and noise.
    fn rates(
        &self,
        moving: &SVector<f64, M>,
    ) -> (
        SVector<f64, M>,
        SMatrix<f64, M, M>,
        SMatrix<f64, M, N>,
        SMatrix<f64, M, M>,
    ) {
        let p = N - M;
        let mut parameters = [[0.0; N]; M];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; M]; M],
            noise: [[0.0; M]; M],
            parameters: &mut parameters.as_flattened_mut()[..M * p],
        };
        let at: [f64; M] = (*moving).into();
        let rates = self.model.rates_jacobian(
            &at,
            &self.state.as_slice()[M..],
            &self.inputs,
            &mut jacobian,
        );
        let by_moving = to_matrix(&jacobian.moving);
        let by_noise = to_matrix(&jacobian.noise);
        let mut by_state = SMatrix::<f64, M, N>::zeros();
        for i in 0..M {
            for j in 0..p {
                by_state[(i, M + j)] = parameters.as_flattened()[i * p + j];
            }
        }
        (SVector::from(rates), by_moving, by_state, by_noise)
    }

    fn moving(&self) -> [f64; M] {
        let mut moving = [0.0; M];
        moving.copy_from_slice(&self.state.as_slice()[..M]);
        moving
    }

    fn set_moving(&mut self, moving: [f64; M]) {
        self.state.as_mut_slice()[..M].copy_from_slice(&moving);
    }
}

fn to_matrix<const M: usize>(rows: &[[f64; M]; M]) -> SMatrix<f64, M, M> {
    SMatrix::from_fn(|i, j| rows[i][j])
}
