//! The generated model against the generated functions that it is made of, to the last bit.

use gyrocal::generated::platform::{
    Platform, PlatformInputs, dynamics, dynamics_at_origin_jacobian, dynamics_jacobian,
    specific_force, specific_force_at_origin_jacobian, specific_force_jacobian,
};
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_scalar::{Model, RatesJacobian};

/// A model has no arithmetic of its own: it puts elements into place, the same at any state.
const FEW: usize = 100;

fn inputs(state: &State) -> PlatformInputs<f64> {
    PlatformInputs {
        omega_0: state.omega_0,
        f_0: state.f_0,
    }
}

#[test]
fn sizes_are_those_of_the_platform() {
    let sizes = |model: &dyn Fn(&Platform) -> usize| model(&Platform);
    assert_eq!(sizes(&|model| Model::<f64, 3, 3>::parameters(model)), 9);
    assert_eq!(
        sizes(&|model| Model::<f64, 3, 3>::output_parameters(model)),
        0
    );
    // Noise enters as the bias of its gyro does.
    assert_eq!(
        Model::<f64, 3, 3>::noise_parameters(&Platform),
        Some([0, 3, 6])
    );
    assert_eq!((Platform::MOVING, Platform::PARAMETERS), (3, 9));
    assert_eq!((Platform::STATES, Platform::OUTPUTS), (12, 3));
}

#[test]
fn rates_and_their_jacobian_are_those_of_the_dynamics() {
    for state in states(Purpose::ScalarTypes, FEW) {
        let State {
            theta,
            drift,
            omega_0,
            f_0,
            ..
        } = &state;
        let rates = Platform.rates(theta, drift, &inputs(&state));
        assert_eq!(rates, dynamics(theta, drift, omega_0, f_0));
        let mut parameters = [0.0; 27];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; 3]; 3],
            noise: [[0.0; 3]; 3],
            parameters: &mut parameters,
        };
        let value = Platform.rates_jacobian(theta, drift, &inputs(&state), &mut jacobian);
        let expected = dynamics_jacobian(theta, drift, omega_0, f_0);
        assert_eq!(value, expected.theta_dot);
        assert_eq!(jacobian.moving, expected.theta_dot_d_theta);
        assert_eq!(jacobian.noise, expected.theta_dot_d_drift_noise_dense());
        assert_eq!(
            parameters,
            expected.theta_dot_d_drift_dense().as_flattened()
        );
    }
}

#[test]
fn outputs_and_their_jacobian_are_those_of_the_specific_force() {
    for state in states(Purpose::ScalarTypes, FEW) {
        let State {
            theta, drift, f_0, ..
        } = &state;
        let output = Platform.output(theta, drift, &inputs(&state));
        assert_eq!(output, specific_force(theta, f_0));
        let mut d_moving = [[0.0; 3]; 3];
        let value = Platform.output_jacobian(theta, drift, &inputs(&state), &mut d_moving, &mut []);
        let expected = specific_force_jacobian(theta, f_0);
        assert_eq!(value, expected.specific_force);
        assert_eq!(d_moving, expected.specific_force_d_theta_dense());
    }
}

#[test]
fn jacobians_at_the_origin_are_those_of_the_functions_at_the_origin() {
    for state in states(Purpose::ScalarTypes, FEW) {
        let State {
            drift,
            omega_0,
            f_0,
            ..
        } = &state;
        let mut parameters = [0.0; 27];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; 3]; 3],
            noise: [[0.0; 3]; 3],
            parameters: &mut parameters,
        };
        let value = Platform.rates_jacobian_at_origin(drift, &inputs(&state), &mut jacobian);
        let expected = dynamics_at_origin_jacobian(drift, omega_0, f_0);
        assert_eq!(value, expected.theta_dot);
        assert_eq!(jacobian.moving, expected.theta_dot_d_theta_dense());
        assert_eq!(jacobian.noise, expected.theta_dot_d_drift_noise_dense());
        assert_eq!(
            parameters,
            expected.theta_dot_d_drift_dense().as_flattened()
        );
        let mut d_moving = [[0.0; 3]; 3];
        let value =
            Platform.output_jacobian_at_origin(drift, &inputs(&state), &mut d_moving, &mut []);
        let expected = specific_force_at_origin_jacobian(f_0);
        assert_eq!(value, expected.specific_force);
        assert_eq!(d_moving, expected.specific_force_d_theta_dense());
    }
}
