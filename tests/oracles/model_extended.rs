//! The extended models against the generated functions that they are made of, to the last bit.

use gyrocal::generated::catalogue::{self, Catalogue, CatalogueInputs};
use gyrocal::generated::surveyed::{self, Surveyed, SurveyedInputs};
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_scalar::{Model, RatesJacobian};

/// A model has no arithmetic of its own: it puts elements into place, the same at any state.
const FEW: usize = 100;

fn surveyed_inputs(state: &State) -> SurveyedInputs<f64> {
    SurveyedInputs {
        omega_0: state.omega_0,
        f_0: state.f_0,
        east_0: state.east_0,
    }
}

fn catalogue_inputs(state: &State) -> CatalogueInputs<f64> {
    let names = catalogue::SHAPES.map(|shape| shape.name.to_owned());
    CatalogueInputs {
        omega_0: state.omega_0,
        f_0: state.f_0,
        east_0: state.east_0,
        field_0: state.field_0,
        conditions: state.conditions,
        shapes: state.shapes(&names).try_into().unwrap(),
    }
}

/// Results of a model: value, derivatives by moving states, by noise, by parameters.
type Written = ([f64; 3], [[f64; 3]; 3], [[f64; 3]; 3], Vec<f64>);

/// Rates and output of a model at a state, in the full form or in that at the origin.
fn written<D: Model<f64, 3, 3>>(
    model: &D,
    moving: Option<&[f64; 3]>,
    parameters: &[f64],
    inputs: &D::Inputs,
) -> [Written; 2] {
    let mut columns = vec![0.0; 3 * model.parameters()];
    let mut jacobian = RatesJacobian {
        moving: [[0.0; 3]; 3],
        noise: [[0.0; 3]; 3],
        parameters: &mut columns,
    };
    let value = match moving {
        Some(moving) => model.rates_jacobian(moving, parameters, inputs, &mut jacobian),
        None => model.rates_jacobian_at_origin(parameters, inputs, &mut jacobian),
    };
    let (d_moving, d_noise) = (jacobian.moving, jacobian.noise);
    let rates = (value, d_moving, d_noise, columns);
    let (mut d_moving, mut columns) = ([[0.0; 3]; 3], vec![0.0; 3 * model.output_parameters()]);
    let value = match moving {
        Some(moving) => {
            model.output_jacobian(moving, parameters, inputs, &mut d_moving, &mut columns)
        }
        None => model.output_jacobian_at_origin(parameters, inputs, &mut d_moving, &mut columns),
    };
    [rates, (value, d_moving, [[0.0; 3]; 3], columns)]
}

/// The leading columns of a matrix, row by row.
fn leading<const P: usize>(matrix: [[f64; P]; 3], columns: usize) -> Vec<f64> {
    matrix
        .iter()
        .flat_map(|row| row[..columns].to_vec())
        .collect()
}

#[test]
fn parameters_that_enter_the_output_come_first() {
    let output = |model: &dyn Fn() -> [usize; 2]| model();
    let surveyed = output(&|| {
        let model: &dyn Model<f64, 3, 3, Inputs = _> = &Surveyed;
        [model.parameters(), model.output_parameters()]
    });
    // Nine, then gravity.
    assert_eq!(surveyed, [12, 10]);
    let leading = Model::<f64, 3, 3>::output_parameters(&Catalogue);
    let enters = |id: &str| id.starts_with("accel") || id == "site.gravity";
    let ids = catalogue::PARAMETERS.map(|parameter| parameter.id);
    assert!(ids[9..leading].iter().all(|id| enters(id)));
    assert!(!ids[leading..].iter().any(|id| enters(id)));
    for noise in [
        Model::<f64, 3, 3>::noise_parameters(&Surveyed),
        Model::<f64, 3, 3>::noise_parameters(&Catalogue),
    ] {
        assert_eq!(noise, Some([0, 3, 6]), "noise enters as a bias does");
    }
}

#[test]
fn the_surveyed_model_is_its_functions() {
    for state in states(Purpose::ScalarTypes, FEW) {
        let (theta, inputs) = (&state.theta, surveyed_inputs(&state));
        let p: [f64; Surveyed::PARAMETERS] =
            state.parameters(Surveyed::PARAMETERS).try_into().unwrap();
        let (omega_0, f_0, east_0) = (&state.omega_0, &state.f_0, &state.east_0);
        let of_output = Model::<f64, 3, 3>::output_parameters(&Surveyed);

        let rates = surveyed::dynamics_jacobian(theta, &p, omega_0, f_0, east_0);
        let read = surveyed::accelerometers_jacobian(theta, &p, f_0);
        let expected = [
            (
                rates.theta_dot,
                rates.theta_dot_d_theta,
                rates.theta_dot_d_drift_noise_dense(),
                rates.theta_dot_d_parameters_dense().as_flattened().to_vec(),
            ),
            (
                read.reading,
                read.reading_d_theta_dense(),
                [[0.0; 3]; 3],
                leading(read.reading_d_parameters_dense(), of_output),
            ),
        ];
        assert_eq!(written(&Surveyed, Some(theta), &p, &inputs), expected);
        assert_eq!(Surveyed.rates(theta, &p, &inputs), rates.theta_dot);
        assert_eq!(Surveyed.output(theta, &p, &inputs), read.reading);

        let rates = surveyed::dynamics_at_origin_jacobian(&p, omega_0, f_0, east_0);
        let read = surveyed::accelerometers_at_origin_jacobian(&p, f_0);
        let expected = [
            (
                rates.theta_dot,
                rates.theta_dot_d_theta_dense(),
                rates.theta_dot_d_drift_noise_dense(),
                rates.theta_dot_d_parameters_dense().as_flattened().to_vec(),
            ),
            (
                read.reading,
                read.reading_d_theta_dense(),
                [[0.0; 3]; 3],
                leading(read.reading_d_parameters_dense(), of_output),
            ),
        ];
        assert_eq!(written(&Surveyed, None, &p, &inputs), expected);
    }
}

#[test]
fn the_catalogue_model_is_its_functions() {
    for state in states(Purpose::ScalarTypes, FEW) {
        let (theta, inputs) = (&state.theta, catalogue_inputs(&state));
        let p: [f64; Catalogue::PARAMETERS] =
            state.parameters(Catalogue::PARAMETERS).try_into().unwrap();
        let CatalogueInputs {
            omega_0,
            f_0,
            east_0,
            field_0,
            conditions,
            shapes,
        } = &inputs;
        let of_output = Model::<f64, 3, 3>::output_parameters(&Catalogue);

        let rates = catalogue::dynamics_jacobian(
            theta, &p, omega_0, f_0, east_0, field_0, conditions, shapes,
        );
        let read = catalogue::accelerometers_jacobian(theta, &p, f_0, conditions);
        let expected = [
            (
                rates.theta_dot,
                rates.theta_dot_d_theta,
                rates.theta_dot_d_drift_noise,
                rates.theta_dot_d_parameters_dense().as_flattened().to_vec(),
            ),
            (
                read.reading,
                read.reading_d_theta,
                [[0.0; 3]; 3],
                leading(read.reading_d_parameters_dense(), of_output),
            ),
        ];
        assert_eq!(written(&Catalogue, Some(theta), &p, &inputs), expected);
        assert_eq!(Catalogue.rates(theta, &p, &inputs), rates.theta_dot);
        assert_eq!(Catalogue.output(theta, &p, &inputs), read.reading);

        let rates = catalogue::dynamics_at_origin_jacobian(
            &p, omega_0, f_0, east_0, field_0, conditions, shapes,
        );
        let read = catalogue::accelerometers_at_origin_jacobian(&p, f_0, conditions);
        let expected = [
            (
                rates.theta_dot,
                rates.theta_dot_d_theta,
                rates.theta_dot_d_drift_noise,
                rates.theta_dot_d_parameters_dense().as_flattened().to_vec(),
            ),
            (
                read.reading,
                read.reading_d_theta,
                [[0.0; 3]; 3],
                leading(read.reading_d_parameters_dense(), of_output),
            ),
        ];
        assert_eq!(written(&Catalogue, None, &p, &inputs), expected);
    }
}
