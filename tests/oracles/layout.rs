//! Layout of arrays in generated code, against the programs.

use gyrocal::generated::{catalogue, oracle, platform, strapdown, strapdown_catalogue, surveyed};
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_oracle::program::Output;
use gyrocal_scalar::Element;

use crate::functions::function;
use crate::programs;

/// Positions and dense forms of a sparse output.
struct Sparse {
    function: &'static str,
    output: &'static str,
    positions: Vec<(usize, usize)>,
    /// The dense form, row by row, at the state that the test uses.
    dense: Vec<f64>,
}

/// Parameters of an extended model.
fn parameters<const N: usize>(state: &State) -> [f64; N] {
    state.parameters(N).try_into().unwrap()
}

#[expect(clippy::too_many_lines, reason = "a table of functions")]
fn sparse_outputs() -> Vec<Sparse> {
    let state = &states(Purpose::ScalarTypes, 1)[0];
    let (theta, drift) = (&state.theta, &state.drift);
    let (omega_0, f_0, step) = (&state.omega_0, &state.f_0, &state.step);
    let (east_0, gyros) = (&state.east_0, &state.platform_c_gyros);
    let (field_0, conditions) = (&state.field_0, &state.conditions);
    let (surveyed, catalogue) = (parameters(state), parameters(state));
    let names = catalogue::SHAPES.map(|shape| shape.name.to_owned());
    let shapes = state.shapes(&names).try_into().unwrap();
    macro_rules! sparse {
        ($($module:ident::$function:ident $inputs:tt -> $type:ident:
           $($output:ident, $positions:ident, $dense:ident);*.)*) => {
            vec![$($(Sparse {
                function: concat!(stringify!($module), "::", stringify!($function)),
                output: stringify!($output),
                positions: $module::$type::<f64>::$positions.to_vec(),
                dense: $module::$function $inputs.$dense().as_flattened().to_vec(),
            }),*),*]
        };
    }
    sparse! {
        platform::reanchor(theta) -> Reanchor: rotation_d_theta, ROTATION_D_THETA, rotation_d_theta_dense.
        platform::drift_rate_jacobian(theta, drift, f_0) -> DriftRateJacobian:
            omega_d_d_theta, OMEGA_D_D_THETA, omega_d_d_theta_dense;
            omega_d_d_drift, OMEGA_D_D_DRIFT, omega_d_d_drift_dense.
        platform::dynamics_jacobian(theta, drift, omega_0, f_0) -> DynamicsJacobian:
            theta_dot_d_drift, THETA_DOT_D_DRIFT, theta_dot_d_drift_dense;
            theta_dot_d_drift_noise, THETA_DOT_D_DRIFT_NOISE, theta_dot_d_drift_noise_dense.
        platform::specific_force_jacobian(theta, f_0) -> SpecificForceJacobian:
            specific_force_d_theta, SPECIFIC_FORCE_D_THETA, specific_force_d_theta_dense.
        platform::euler_step_jacobian(theta, drift, omega_0, f_0, step) -> EulerStepJacobian:
            theta_next_d_drift, THETA_NEXT_D_DRIFT, theta_next_d_drift_dense;
            theta_next_d_drift_noise, THETA_NEXT_D_DRIFT_NOISE, theta_next_d_drift_noise_dense.
        platform::dynamics_at_origin_jacobian(drift, omega_0, f_0) -> DynamicsAtOriginJacobian:
            theta_dot_d_theta, THETA_DOT_D_THETA, theta_dot_d_theta_dense;
            theta_dot_d_drift, THETA_DOT_D_DRIFT, theta_dot_d_drift_dense;
            theta_dot_d_drift_noise, THETA_DOT_D_DRIFT_NOISE, theta_dot_d_drift_noise_dense.
        platform::specific_force_at_origin_jacobian(f_0) -> SpecificForceAtOriginJacobian:
            specific_force_d_theta, SPECIFIC_FORCE_D_THETA, specific_force_d_theta_dense.
        surveyed::dynamics_jacobian(theta, &surveyed, omega_0, f_0, east_0) -> DynamicsJacobian:
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense;
            theta_dot_d_drift_noise, THETA_DOT_D_DRIFT_NOISE, theta_dot_d_drift_noise_dense.
        surveyed::accelerometers_jacobian(theta, &surveyed, f_0) -> AccelerometersJacobian:
            reading_d_theta, READING_D_THETA, reading_d_theta_dense;
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        surveyed::dynamics_at_origin_jacobian(&surveyed, omega_0, f_0, east_0)
            -> DynamicsAtOriginJacobian:
            theta_dot_d_theta, THETA_DOT_D_THETA, theta_dot_d_theta_dense;
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense;
            theta_dot_d_drift_noise, THETA_DOT_D_DRIFT_NOISE, theta_dot_d_drift_noise_dense.
        surveyed::accelerometers_at_origin_jacobian(&surveyed, f_0)
            -> AccelerometersAtOriginJacobian:
            reading_d_theta, READING_D_THETA, reading_d_theta_dense;
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        strapdown::accelerometers_jacobian(theta, &surveyed, f_0) -> AccelerometersJacobian:
            reading_d_theta, READING_D_THETA, reading_d_theta_dense;
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        strapdown::accelerometers_at_origin_jacobian(&surveyed, f_0)
            -> AccelerometersAtOriginJacobian:
            reading_d_theta, READING_D_THETA, reading_d_theta_dense;
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        catalogue::dynamics_jacobian(
            theta, &catalogue, omega_0, f_0, east_0, field_0, conditions, &shapes)
            -> DynamicsJacobian:
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense.
        catalogue::accelerometers_jacobian(theta, &catalogue, f_0, conditions)
            -> AccelerometersJacobian:
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        catalogue::dynamics_at_origin_jacobian(
            &catalogue, omega_0, f_0, east_0, field_0, conditions, &shapes)
            -> DynamicsAtOriginJacobian:
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense.
        catalogue::accelerometers_at_origin_jacobian(&catalogue, f_0, conditions)
            -> AccelerometersAtOriginJacobian:
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        strapdown_catalogue::dynamics_jacobian(
            theta, &catalogue, omega_0, f_0, east_0, field_0, gyros, conditions, &shapes)
            -> DynamicsJacobian:
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense.
        strapdown_catalogue::accelerometers_jacobian(theta, &catalogue, f_0, gyros, conditions)
            -> AccelerometersJacobian:
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
        strapdown_catalogue::dynamics_at_origin_jacobian(
            &catalogue, omega_0, f_0, east_0, field_0, gyros, conditions, &shapes)
            -> DynamicsAtOriginJacobian:
            theta_dot_d_parameters, THETA_DOT_D_PARAMETERS, theta_dot_d_parameters_dense.
        strapdown_catalogue::accelerometers_at_origin_jacobian(
            &catalogue, f_0, gyros, conditions)
            -> AccelerometersAtOriginJacobian:
            reading_d_parameters, READING_D_PARAMETERS, reading_d_parameters_dense.
    }
}

#[test]
fn sparse_outputs_stand_where_the_program_has_them() {
    let state = &states(Purpose::ScalarTypes, 1)[0];
    let programs = programs();
    let listed = sparse_outputs();
    let is_sparse = |output: &&Output| output.nonzeros.len() < output.rows * output.columns;
    let functions = programs.iter().flat_map(|program| &program.functions);
    let programmed = functions.flat_map(|f| {
        f.outputs
            .iter()
            .filter(is_sparse)
            .map(|o| (f.name.as_str(), &*o.name))
    });
    let names: Vec<(&str, &str)> = listed.iter().map(|s| (s.function, s.output)).collect();
    assert_eq!(
        names,
        programmed.collect::<Vec<_>>(),
        "add what is missing to `sparse!`"
    );
    for sparse in listed {
        let program = programs
            .iter()
            .find_map(|p| p.function(sparse.function).ok())
            .unwrap();
        let index = program
            .outputs
            .iter()
            .position(|o| o.name == sparse.output)
            .unwrap();
        let name = (sparse.function, sparse.output);
        assert_eq!(
            sparse.positions, program.outputs[index].nonzeros,
            "{name:?}"
        );
        let function = function(sparse.function);
        let flat = (function.double)(&function.inputs(state));
        assert_eq!(
            sparse.dense,
            program.dense_outputs(&flat, 0.0)[index],
            "{name:?}"
        );
    }
}

#[test]
fn groups_have_the_elements_of_the_program() {
    let generated: [(&str, &[Element]); 40] = [
        ("theta", &platform::THETA),
        ("drift", &platform::DRIFT),
        ("omega_0", &platform::OMEGA_0),
        ("f_0", &platform::F_0),
        ("step", &platform::STEP),
        ("theta", &oracle::THETA),
        ("drift", &oracle::DRIFT),
        ("drift_noise", &oracle::DRIFT_NOISE),
        ("omega_0", &oracle::OMEGA_0),
        ("f_0", &oracle::F_0),
        ("step", &oracle::STEP),
        ("theta", &surveyed::THETA),
        ("surveyed::parameters", &surveyed::PARAMETERS),
        ("omega_0", &surveyed::OMEGA_0),
        ("f_0", &surveyed::F_0),
        ("east_0", &surveyed::EAST_0),
        ("theta", &strapdown::THETA),
        ("strapdown::parameters", &strapdown::PARAMETERS),
        ("omega_0", &strapdown::OMEGA_0),
        ("f_0", &strapdown::F_0),
        ("east_0", &strapdown::EAST_0),
        ("platform_c_gyros", &strapdown::PLATFORM_C_GYROS),
        ("theta", &catalogue::THETA),
        ("catalogue::parameters", &catalogue::PARAMETERS),
        ("omega_0", &catalogue::OMEGA_0),
        ("f_0", &catalogue::F_0),
        ("east_0", &catalogue::EAST_0),
        ("field_0", &catalogue::FIELD_0),
        ("conditions", &catalogue::CONDITIONS),
        ("force", &catalogue::FORCE),
        ("catalogue::shapes", &catalogue::SHAPES),
        ("theta", &strapdown_catalogue::THETA),
        (
            "strapdown_catalogue::parameters",
            &strapdown_catalogue::PARAMETERS,
        ),
        ("omega_0", &strapdown_catalogue::OMEGA_0),
        ("f_0", &strapdown_catalogue::F_0),
        ("east_0", &strapdown_catalogue::EAST_0),
        ("field_0", &strapdown_catalogue::FIELD_0),
        ("platform_c_gyros", &strapdown_catalogue::PLATFORM_C_GYROS),
        ("conditions", &strapdown_catalogue::CONDITIONS),
        ("strapdown_catalogue::shapes", &strapdown_catalogue::SHAPES),
    ];
    let programs = programs();
    let mut seen = Vec::new();
    for group in programs
        .iter()
        .flat_map(|p| &p.functions)
        .flat_map(|f| &f.inputs)
    {
        let mut same_name = generated
            .iter()
            .filter(|(name, _)| *name == group.name)
            .peekable();
        assert!(
            same_name.peek().is_some(),
            "group `{}` is not generated",
            group.name
        );
        for (name, elements) in same_name {
            assert!(
                elements
                    .iter()
                    .map(|element| element.name)
                    .eq(group.elements.iter())
            );
            seen.push(*name);
        }
    }
    assert!(
        generated.iter().all(|(name, _)| seen.contains(name)),
        "compared: {seen:?}"
    );
}

#[test]
fn fields_and_indices_name_the_same_places() {
    use platform::{drift_index, f_0_index, omega_0_index, platform_index, theta_index};

    let state = platform::PlatformState::from_array(core::array::from_fn(|place| place));
    assert_eq!(state.to_array(), core::array::from_fn(|place| place));
    assert_eq!(state.theta_z, platform_index::THETA_Z);
    assert_eq!(state.gyro_x_bias, platform_index::GYRO_X_BIAS);
    assert_eq!(state.gyro_y_g_yy, platform_index::GYRO_Y_G_YY);
    assert_eq!(state.gyro_z_g_z, platform_index::GYRO_Z_G_Z);
    // Parameters come after the moving states, in the order of their group.
    let drift = platform::Drift::from_array(core::array::from_fn(|place| place));
    assert_eq!(drift.to_array(), core::array::from_fn(|place| place));
    assert_eq!(drift.gyro_z_g_z, drift_index::GYRO_Z_G_Z);
    assert_eq!(
        drift.gyro_z_g_z + platform::Platform::MOVING,
        state.gyro_z_g_z
    );
    assert_eq!(
        platform::DRIFT[drift_index::GYRO_Y_BIAS].name,
        "gyro_y_bias"
    );
    assert_eq!(platform::DRIFT[drift_index::GYRO_Y_BIAS].id, "gyro_y.bias");
    let theta = platform::Theta::from_array([0, 1, 2]);
    assert_eq!(
        (theta.theta_y, theta.to_array()),
        (theta_index::THETA_Y, [0, 1, 2])
    );
    let f_0 = platform::F0::from_array([0, 1, 2]);
    assert_eq!((f_0.f_0_z, f_0.to_array()), (f_0_index::F_0_Z, [0, 1, 2]));
    let omega_0 = platform::Omega0::from_array([0, 1, 2]);
    assert_eq!(
        (omega_0.omega_0_x, omega_0.to_array()),
        (omega_0_index::OMEGA_0_X, [0, 1, 2])
    );
}
