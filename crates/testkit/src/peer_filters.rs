//! Joseph-form Kalman filters of other packages, driven by the generated Euler step.

use adskalman::{
    KalmanFilterNoControl, ObservationModel, StateAndCovariance, TransitionModelLinearNoControl,
};
use gyrocal::Chart;
use gyrocal::generated::platform::{euler_step_jacobian, specific_force_jacobian};
use multicalc::estimation::{KalmanFilter, KalmanModel};
use multicalc::linear_algebra::{Matrix, Vector};
use nalgebra::{SMatrix, SVector};

type State = SVector<f64, 12>;
type Square = SMatrix<f64, 12, 12>;

/// The Euler transition at `state`: next state, Φ and Γ Q Γᵀ.
fn transition(
    chart: &Chart<f64>,
    state: &State,
    dt_s: f64,
    density: [f64; 3],
) -> (State, Square, Square) {
    let theta = [state[0], state[1], state[2]];
    let drift: [f64; 9] = core::array::from_fn(|i| state[3 + i]);
    let inputs = chart.inputs();
    let next = euler_step_jacobian(&theta, &drift, &inputs.omega_0, &inputs.f_0, &[dt_s]);
    let mut predicted = *state;
    let mut phi = Square::identity();
    let mut noise = Square::zeros();
    let by_theta = next.theta_next_d_theta;
    let by_drift = next.theta_next_d_drift_dense();
    let by_noise = next.theta_next_d_drift_noise_dense();
    for i in 0..3 {
        predicted[i] = next.theta_next[i];
        for j in 0..3 {
            phi[(i, j)] = by_theta[i][j];
            noise[(i, j)] = (0..3)
                .map(|l| by_noise[i][l] * by_noise[j][l] * density[l] / dt_s)
                .sum();
        }
        for j in 0..9 {
            phi[(i, 3 + j)] = by_drift[i][j];
        }
    }
    (predicted, phi, noise)
}

/// The measurement at `state`: predicted output and H.
fn measurement(chart: &Chart<f64>, state: &State) -> (SVector<f64, 3>, SMatrix<f64, 3, 12>) {
    let at = specific_force_jacobian(&[state[0], state[1], state[2]], &chart.inputs().f_0);
    let by_theta = at.specific_force_d_theta_dense();
    let mut h = SMatrix::<f64, 3, 12>::zeros();
    for i in 0..3 {
        for j in 0..3 {
            h[(i, j)] = by_theta[i][j];
        }
    }
    (SVector::from(at.specific_force), h)
}

/// The filter of the package `adskalman`.
#[derive(Clone)]
pub struct Adskalman {
    chart: Chart<f64>,
    estimate: StateAndCovariance<f64, nalgebra::Const<12>>,
    density: [f64; 3],
    variance: [f64; 3],
}

struct Linearised {
    predicted: State,
    phi: Square,
    phi_transposed: Square,
    noise: Square,
}

impl TransitionModelLinearNoControl<f64, nalgebra::Const<12>> for Linearised {
    fn F(&self) -> &Square {
        &self.phi
    }
    fn FT(&self) -> &Square {
        &self.phi_transposed
    }
    fn Q(&self) -> &Square {
        &self.noise
    }
    fn predict(
        &self,
        previous: &StateAndCovariance<f64, nalgebra::Const<12>>,
    ) -> StateAndCovariance<f64, nalgebra::Const<12>> {
        let covariance = self.phi * previous.covariance() * self.phi_transposed + self.noise;
        StateAndCovariance::new(self.predicted, covariance)
    }
}

struct Observed {
    predicted: SVector<f64, 3>,
    h: SMatrix<f64, 3, 12>,
    h_transposed: SMatrix<f64, 12, 3>,
    noise: SMatrix<f64, 3, 3>,
}

impl ObservationModel<f64, nalgebra::Const<12>, nalgebra::Const<3>> for Observed {
    fn predict_observation(&self, _: &State) -> SVector<f64, 3> {
        self.predicted
    }
    fn H(&self) -> &SMatrix<f64, 3, 12> {
        &self.h
    }
    fn HT(&self) -> &SMatrix<f64, 12, 3> {
        &self.h_transposed
    }
    fn R(&self) -> &SMatrix<f64, 3, 3> {
        &self.noise
    }
}

impl Adskalman {
    /// The filter at its start; `prior` and `variance` are variances, `density` the spectral density of
    /// the drift noise.
    pub fn new(chart: Chart<f64>, prior: [f64; 12], density: [f64; 3], variance: [f64; 3]) -> Self {
        let covariance = Square::from_diagonal(&SVector::from(prior));
        let estimate = StateAndCovariance::new(State::zeros(), covariance);
        Self {
            chart,
            estimate,
            density,
            variance,
        }
    }

    /// Prediction over `dt_s` and update of one sample.
    pub fn step(&mut self, dt_s: f64, sample: &[f64; 3]) {
        let (predicted, phi, noise) =
            transition(&self.chart, self.estimate.state(), dt_s, self.density);
        let linearised = Linearised {
            predicted,
            phi,
            phi_transposed: phi.transpose(),
            noise,
        };
        let (output, h) = measurement(&self.chart, &predicted);
        let observed = Observed {
            predicted: output,
            h,
            h_transposed: h.transpose(),
            noise: SMatrix::from_diagonal(&SVector::from(self.variance)),
        };
        let filter = KalmanFilterNoControl::new(&linearised, &observed);
        let estimate = filter.step(&self.estimate, &SVector::from(*sample));
        self.estimate = estimate.unwrap();
    }
}

/// The filter of the package `multicalc`.
#[derive(Clone)]
pub struct Multicalc {
    chart: Chart<f64>,
    filter: KalmanFilter<12, 3>,
    density: [f64; 3],
}

fn matrix<const R: usize, const C: usize>(from: &SMatrix<f64, R, C>) -> Matrix<R, C> {
    let row = |i: usize| core::array::from_fn(|j| from[(i, j)]);
    Matrix::new(core::array::from_fn(row))
}

impl Multicalc {
    /// The filter at its start; `prior` and `variance` are variances, `density` the spectral density of
    /// the drift noise.
    pub fn new(chart: Chart<f64>, prior: [f64; 12], density: [f64; 3], variance: [f64; 3]) -> Self {
        let model = KalmanModel {
            state_transition: matrix(&Square::identity()),
            measurement_model: matrix(&SMatrix::<f64, 3, 12>::zeros()),
            process_noise: matrix(&Square::zeros()),
            measurement_noise: matrix(&SMatrix::from_diagonal(&SVector::from(variance))),
        };
        let covariance = matrix(&Square::from_diagonal(&SVector::from(prior)));
        Self {
            chart,
            filter: KalmanFilter::new(Vector::new([0.0; 12]), covariance, model),
            density,
        }
    }

    /// Prediction over `dt_s` and update of one sample.
    pub fn step(&mut self, dt_s: f64, sample: &[f64; 3]) {
        let now = self.filter.state();
        let state = State::from_fn(|i, _| now[i]);
        let (predicted, phi, noise) = transition(&self.chart, &state, dt_s, self.density);
        self.filter.set_state_transition(matrix(&phi));
        self.filter.set_process_noise(matrix(&noise));
        self.filter.predict();
        self.filter.set_state(Vector::new(predicted.into()));
        let (output, h) = measurement(&self.chart, &predicted);
        self.filter.set_measurement_model(matrix(&h));
        // The output of this filter is linear: it gets the measurement with the same innovation.
        let linear = h * predicted;
        let equivalent = core::array::from_fn(|i| sample[i] - output[i] + linear[i]);
        self.filter.update(Vector::new(equivalent)).unwrap();
    }
}
