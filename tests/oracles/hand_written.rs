//! Hand-written functions whose derivatives are generated, where the function itself is not.

use gyrocal::generated::{catalogue, platform, strapdown, strapdown_catalogue, surveyed};
use gyrocal_scalar::Scalar;

use crate::callable::{Callable, callable, take};

/// All of them.
pub(crate) fn hand_written() -> Vec<Callable> {
    macro_rules! list {
        ($($name:literal = $function:path, [$($group:literal),*];)*) => {
            vec![$(callable!($name, &[$($group),*], $function, lanes: None, dual: Some($function))),*]
        };
    }
    list! {
        "rk4_step" = rk4_step, ["theta", "drift", "drift_noise", "omega_0", "f_0", "step"];
        "rotation_from" = rotation_from, ["theta", "theta"];
        "dynamics_from_origin" = dynamics_from_origin, ["origin", "drift", "omega_0", "f_0"];
        "specific_force_from_origin" = specific_force_from_origin, ["origin", "f_0"];
        "surveyed::dynamics_from_origin" = surveyed_dynamics,
            ["origin", "surveyed::parameters", "omega_0", "f_0", "east_0"];
        "surveyed::accelerometers_from_origin" = surveyed_accelerometers,
            ["origin", "surveyed::parameters", "f_0"];
        "strapdown::dynamics_from_origin" = strapdown_dynamics,
            ["origin", "strapdown::parameters", "omega_0", "f_0", "east_0", "platform_c_gyros"];
        "strapdown::accelerometers_from_origin" = strapdown_accelerometers,
            ["origin", "strapdown::parameters", "f_0"];
        "catalogue::dynamics_from_origin" = catalogue_dynamics,
            ["origin", "catalogue::parameters", "omega_0", "f_0", "east_0", "field_0",
             "conditions", "catalogue::shapes"];
        "catalogue::accelerometers_from_origin" = catalogue_accelerometers,
            ["origin", "catalogue::parameters", "f_0", "conditions"];
        "strapdown_catalogue::dynamics_from_origin" = strapdown_catalogue_dynamics,
            ["origin", "strapdown_catalogue::parameters", "omega_0", "f_0", "east_0", "field_0",
             "platform_c_gyros", "conditions", "strapdown_catalogue::shapes"];
        "strapdown_catalogue::accelerometers_from_origin" = strapdown_catalogue_accelerometers,
            ["origin", "strapdown_catalogue::parameters", "f_0", "platform_c_gyros", "conditions"];
    }
}

/// One classical Runge–Kutta step over the generated rates. Noise is drift at any specific
/// force, so it is added to the biases.
fn rk4_step<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let theta: &[T; 3] = take(&mut rest);
    let mut drift: [T; 9] = *take(&mut rest);
    let noise: &[T; 3] = take(&mut rest);
    let (omega_0, f_0): (&[T; 3], &[T; 3]) = (take(&mut rest), take(&mut rest));
    let [dt]: [T; 1] = *take(&mut rest);
    for (gyro, &epsilon) in noise.iter().enumerate() {
        drift[3 * gyro] = drift[3 * gyro] + epsilon;
    }
    let rates = |theta: &[T; 3]| platform::dynamics(theta, &drift, omega_0, f_0);
    let moved = |rates: &[T; 3], share: f64| {
        core::array::from_fn(|i| theta[i] + T::from_f64(share) * dt * rates[i])
    };
    let k1 = rates(theta);
    let k2 = rates(&moved(&k1, 0.5));
    let k3 = rates(&moved(&k2, 0.5));
    let k4 = rates(&moved(&k3, 1.0));
    let two = T::from_f64(2.0);
    let mean = core::array::from_fn(|i| k1[i] + two * k2[i] + two * k3[i] + k4[i]);
    moved(&mean, 1.0 / 6.0).to_vec()
}

/// The small rotation, in platform axes, from the second attitude to the first: the vector
/// of the antisymmetric part of C(second) C(first)ᵀ, where C = exp(−[φ]×) C(second).
fn rotation_from<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let to = platform::reanchor::<T>(take(&mut rest)).platform_c_chart;
    let from = platform::reanchor::<T>(take(&mut rest)).platform_c_chart;
    let product =
        |i: usize, j: usize| from[i][0] * to[j][0] + from[i][1] * to[j][1] + from[i][2] * to[j][2];
    let half = T::from_f64(0.5);
    [(2, 1), (0, 2), (1, 0)]
        .map(|(i, j)| half * (product(i, j) - product(j, i)))
        .to_vec()
}

/// The rates at angles near zero, to be differentiated there.
fn dynamics_from_origin<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, drift) = (take(&mut rest), take(&mut rest));
    platform::dynamics(theta, drift, take(&mut rest), take(&mut rest)).to_vec()
}

/// The specific force at angles near zero, to be differentiated there.
fn specific_force_from_origin<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    platform::specific_force(take(&mut rest), take(&mut rest)).to_vec()
}

/// Rates of the surveyed platform at angles near zero.
fn surveyed_dynamics<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    let (omega_0, f_0, east_0) = (take(&mut rest), take(&mut rest), take(&mut rest));
    surveyed::dynamics(theta, parameters, omega_0, f_0, east_0).to_vec()
}

/// Outputs of the accelerometers of the surveyed platform at angles near zero.
fn surveyed_accelerometers<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    surveyed::accelerometers(take(&mut rest), take(&mut rest), take(&mut rest)).to_vec()
}

/// Rates of the analytic platform at angles near zero.
fn strapdown_dynamics<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    let (omega_0, f_0, east_0) = (take(&mut rest), take(&mut rest), take(&mut rest));
    let gyros = take(&mut rest);
    strapdown::dynamics(theta, parameters, omega_0, f_0, east_0, gyros).to_vec()
}

/// Outputs of the accelerometers of the analytic platform at angles near zero.
fn strapdown_accelerometers<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    strapdown::accelerometers(take(&mut rest), take(&mut rest), take(&mut rest)).to_vec()
}

/// Rates of the platform with all effects at angles near zero.
fn catalogue_dynamics<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    let (omega_0, f_0, east_0) = (take(&mut rest), take(&mut rest), take(&mut rest));
    let (field_0, conditions, shapes) = (take(&mut rest), take(&mut rest), take(&mut rest));
    catalogue::dynamics(
        theta, parameters, omega_0, f_0, east_0, field_0, conditions, shapes,
    )
    .to_vec()
}

/// Outputs of the accelerometers of the platform with all effects at angles near zero.
fn catalogue_accelerometers<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    catalogue::accelerometers(theta, parameters, take(&mut rest), take(&mut rest)).to_vec()
}

/// Rates of the analytic platform with all effects at angles near zero.
fn strapdown_catalogue_dynamics<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    let (omega_0, f_0, east_0) = (take(&mut rest), take(&mut rest), take(&mut rest));
    let (field_0, gyros) = (take(&mut rest), take(&mut rest));
    let (conditions, shapes) = (take(&mut rest), take(&mut rest));
    strapdown_catalogue::dynamics(
        theta, parameters, omega_0, f_0, east_0, field_0, gyros, conditions, shapes,
    )
    .to_vec()
}

/// Outputs of the accelerometers of the analytic platform with all effects at angles near zero.
fn strapdown_catalogue_accelerometers<T: Scalar>(inputs: &[T]) -> Vec<T> {
    let mut rest = inputs;
    let (theta, parameters) = (take(&mut rest), take(&mut rest));
    let (f_0, gyros) = (take(&mut rest), take(&mut rest));
    strapdown_catalogue::accelerometers(theta, parameters, f_0, gyros, take(&mut rest)).to_vec()
}
