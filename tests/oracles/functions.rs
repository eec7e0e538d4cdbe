//! The generated functions, and a check that the list is complete.

use gyrocal::generated::{catalogue, oracle, platform, strapdown, strapdown_catalogue, surveyed};
use gyrocal_oracle::nonzeros::Nonzeros;
use gyrocal_scalar::Scalar;

use crate::callable::{Callable, callable, take};
use crate::programs;

/// Lists generated functions as `module::function(group, …) -> [output, …]`; one that has
/// a single output returns it bare and needs no list.
macro_rules! generated {
    ($($module:ident::$function:ident($($group:ident),*) $(-> [$($output:ident),*])?;)*) => {
        /// All generated functions, in the order of their programs.
        pub(crate) fn generated() -> Vec<Callable> {
            vec![$({
                fn flat<T: Scalar>(inputs: &[T]) -> Vec<T> {
                    let mut rest = inputs;
                    let result = $module::$function($(generated!(@take rest $group)),*);
                    assert!(rest.is_empty(), "scalars left over");
                    let mut flat = Vec::new();
                    generated!(@append result flat $([$($output),*])?);
                    flat
                }
                callable!(
                    concat!(stringify!($module), "::", stringify!($function)),
                    &[$(generated!(@group $module $group)),*],
                    flat,
                    lanes: generated!(@lanes $module flat),
                    dual: generated!(@dual flat $([$($output),*])?)
                )
            }),*]
        }
    };
    (@take $rest:ident $group:ident) => { take(&mut $rest) };
    (@group $module:ident parameters) => { concat!(stringify!($module), "::parameters") };
    (@group $module:ident shapes) => { concat!(stringify!($module), "::shapes") };
    (@group $module:ident $group:ident) => { stringify!($group) };
    (@lanes oracle $flat:ident) => { None };
    (@lanes catalogue $flat:ident) => { None };
    (@lanes strapdown_catalogue $flat:ident) => { None };
    (@lanes $module:ident $flat:ident) => { Some($flat) };
    (@dual $flat:ident) => { Some($flat) };
    (@dual $flat:ident [$($output:ident),*]) => { None };
    (@append $result:ident $flat:ident) => { $result.append_to(&mut $flat) };
    (@append $result:ident $flat:ident [$($output:ident),*]) => {
        $($result.$output.append_to(&mut $flat);)*
    };
}

generated! {
    platform::reanchor(theta) -> [platform_c_chart, rotation_d_theta];
    platform::drift_rate(theta, drift, f_0);
    platform::drift_rate_jacobian(theta, drift, f_0)
        -> [omega_d, omega_d_d_theta, omega_d_d_drift];
    platform::dynamics(theta, drift, omega_0, f_0);
    platform::dynamics_jacobian(theta, drift, omega_0, f_0)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_drift, theta_dot_d_drift_noise];
    platform::specific_force(theta, f_0);
    platform::specific_force_jacobian(theta, f_0) -> [specific_force, specific_force_d_theta];
    platform::euler_step(theta, drift, omega_0, f_0, step);
    platform::euler_step_jacobian(theta, drift, omega_0, f_0, step)
        -> [theta_next, theta_next_d_theta, theta_next_d_drift, theta_next_d_drift_noise];
    platform::dynamics_at_origin_jacobian(drift, omega_0, f_0)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_drift, theta_dot_d_drift_noise];
    platform::specific_force_at_origin_jacobian(f_0) -> [specific_force, specific_force_d_theta];
    oracle::rk4_step_jacobian(theta, drift, drift_noise, omega_0, f_0, step)
        -> [theta_next, theta_next_d_theta, theta_next_d_drift, theta_next_d_drift_noise];
    surveyed::dynamics(theta, parameters, omega_0, f_0, east_0);
    surveyed::dynamics_jacobian(theta, parameters, omega_0, f_0, east_0)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    surveyed::accelerometers(theta, parameters, f_0);
    surveyed::accelerometers_jacobian(theta, parameters, f_0)
        -> [reading, reading_d_theta, reading_d_parameters];
    surveyed::dynamics_at_origin_jacobian(parameters, omega_0, f_0, east_0)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    surveyed::accelerometers_at_origin_jacobian(parameters, f_0)
        -> [reading, reading_d_theta, reading_d_parameters];
    strapdown::dynamics(theta, parameters, omega_0, f_0, east_0, platform_c_gyros);
    strapdown::dynamics_jacobian(theta, parameters, omega_0, f_0, east_0, platform_c_gyros)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    strapdown::accelerometers(theta, parameters, f_0);
    strapdown::accelerometers_jacobian(theta, parameters, f_0)
        -> [reading, reading_d_theta, reading_d_parameters];
    strapdown::dynamics_at_origin_jacobian(parameters, omega_0, f_0, east_0, platform_c_gyros)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    strapdown::accelerometers_at_origin_jacobian(parameters, f_0)
        -> [reading, reading_d_theta, reading_d_parameters];
    catalogue::dynamics(
        theta, parameters, omega_0, f_0, east_0, field_0, conditions, shapes);
    catalogue::dynamics_jacobian(
        theta, parameters, omega_0, f_0, east_0, field_0, conditions, shapes)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    catalogue::accelerometers(theta, parameters, f_0, conditions);
    catalogue::accelerometers_jacobian(theta, parameters, f_0, conditions)
        -> [reading, reading_d_theta, reading_d_parameters];
    catalogue::dynamics_at_origin_jacobian(
        parameters, omega_0, f_0, east_0, field_0, conditions, shapes)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    catalogue::accelerometers_at_origin_jacobian(parameters, f_0, conditions)
        -> [reading, reading_d_theta, reading_d_parameters];
    catalogue::weights(force, conditions, shapes);
    strapdown_catalogue::dynamics(
        theta, parameters, omega_0, f_0, east_0, field_0, platform_c_gyros, conditions, shapes);
    strapdown_catalogue::dynamics_jacobian(
        theta, parameters, omega_0, f_0, east_0, field_0, platform_c_gyros, conditions, shapes)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    strapdown_catalogue::accelerometers(theta, parameters, f_0, platform_c_gyros, conditions);
    strapdown_catalogue::accelerometers_jacobian(
        theta, parameters, f_0, platform_c_gyros, conditions)
        -> [reading, reading_d_theta, reading_d_parameters];
    strapdown_catalogue::dynamics_at_origin_jacobian(
        parameters, omega_0, f_0, east_0, field_0, platform_c_gyros, conditions, shapes)
        -> [theta_dot, theta_dot_d_theta, theta_dot_d_parameters, theta_dot_d_drift_noise];
    strapdown_catalogue::accelerometers_at_origin_jacobian(
        parameters, f_0, platform_c_gyros, conditions)
        -> [reading, reading_d_theta, reading_d_parameters];
}

/// The generated function called `name`.
pub(crate) fn function(name: &str) -> Callable {
    generated()
        .into_iter()
        .find(|function| function.name == name)
        .expect(name)
}

#[test]
fn every_function_of_every_program_is_compared() {
    let listed: Vec<(String, Vec<String>)> = generated()
        .iter()
        .map(|f| {
            (
                f.name.to_owned(),
                f.groups.iter().map(|&group| group.to_owned()).collect(),
            )
        })
        .collect();
    let programmed: Vec<(String, Vec<String>)> = programs()
        .into_iter()
        .flat_map(|program| program.functions)
        .map(|f| {
            (
                f.name,
                f.inputs.into_iter().map(|group| group.name).collect(),
            )
        })
        .collect();
    assert_eq!(
        listed, programmed,
        "add what is missing to `generated!` in this file"
    );
}
