//! The model of a strapdown unit that a model file gives: exact Jacobians, the step of the filter against
//! that on the whole catalogue, and the drift that is compensated.

#![cfg(test)]

use gyrocal::generated::catalogue::PARAMETERS as CATALOGUE_PARAMETERS;
use gyrocal::generated::strapdown_catalogue::StrapdownCatalogueInputs;
use gyrocal::scalar::{Model, RatesJacobian, Scalar};
use gyrocal::{Drift, ExtensionFilter, Platform, StrapdownCatalogue};
use gyrocal_extended::unit::{PARAMETERS, START, Unit, UnitInputs};
use gyrocal_extended::{UnitFilter, unit_filter};
use gyrocal_oracle::difference;
use gyrocal_oracle::dual::{self, Dual};
use gyrocal_oracle::points::{Purpose, State, states};
use gyrocal_testkit::extended_comparison::{attitude, settings};

const POINTS: usize = 50;
const DRIFT: [f64; 9] = [0.41, -0.13, 0.04, -0.29, 0.21, -0.07, 0.15, 0.09, 0.02];
/// So small that a parameter of an effect stays what it is.
const NOTHING: f64 = 1e-14;
const STEP_S: f64 = 60.0;
/// Angles and parameters of the model.
const VARIABLES: usize = 3 + Unit::PARAMETERS;

type Matrix = [[f64; 3]; 3];

fn matrix(elements: &[f64; 9]) -> Matrix {
    [0, 3, 6].map(|start| core::array::from_fn(|column| elements[start + column]))
}

fn inputs<T: Scalar>(state: &State) -> UnitInputs<T> {
    UnitInputs {
        omega_0: state.omega_0.map(T::from_f64),
        f_0: state.f_0.map(T::from_f64),
        platform_c_gyros: state.platform_c_gyros.map(T::from_f64),
        conditions: state.conditions.map(T::from_f64),
    }
}

/// Angles, then parameters.
fn variables(state: &State) -> Vec<f64> {
    let parameters = state.parameters(Unit::PARAMETERS);
    state.theta.iter().copied().chain(parameters).collect()
}

/// Rates and outputs, where `x` are angles and parameters.
fn values<T: Scalar>(x: &[T], inputs: &UnitInputs<T>) -> [[T; 3]; 2] {
    let theta = [x[0], x[1], x[2]];
    [
        Unit.rates(&theta, &x[3..], inputs),
        Unit.output(&theta, &x[3..], inputs),
    ]
}

/// The Jacobians of rates and outputs, row by row.
fn jacobians(x: &[f64], inputs: &UnitInputs<f64>) -> [Vec<[f64; VARIABLES]>; 2] {
    let (theta, parameters) = ([x[0], x[1], x[2]], &x[3..]);
    let mut by_parameters = [0.0; 3 * Unit::PARAMETERS];
    let mut jacobian = RatesJacobian {
        moving: [[0.0; 3]; 3],
        noise: [[0.0; 3]; 3],
        parameters: &mut by_parameters,
    };
    Unit.rates_jacobian(&theta, parameters, inputs, &mut jacobian);
    let by_theta = jacobian.moving;
    let of_output = Model::<f64, 3, 3>::output_parameters(&Unit);
    let mut of_readings = vec![0.0; 3 * of_output];
    let mut reading_by_theta = [[0.0; 3]; 3];
    Unit.output_jacobian(
        &theta,
        parameters,
        inputs,
        &mut reading_by_theta,
        &mut of_readings,
    );
    let rows = |by_theta: &Matrix, by: &[f64], columns: usize| {
        let row = |i: usize| {
            let own = &by[columns * i..][..columns];
            let mut all = by_theta[i].iter().chain(own).copied();
            core::array::from_fn(|_| all.next().unwrap_or(0.0))
        };
        (0..3).map(row).collect()
    };
    [
        rows(&by_theta, &by_parameters, Unit::PARAMETERS),
        rows(&reading_by_theta, &of_readings, of_output),
    ]
}

#[test]
fn its_jacobians_are_those_of_dual_numbers_and_of_differences() {
    let places: Vec<usize> = (0..VARIABLES).collect();
    for state in states(Purpose::ScalarTypes, POINTS) {
        let x = variables(&state);
        let found = jacobians(&x, &inputs(&state)).concat().concat();
        let all = |x: &[Dual<VARIABLES>]| values(x, &inputs(&state)).concat();
        let exact = dual::jacobian(all, &x, &places);
        let all = |x: &[f64]| values(x, &inputs(&state)).concat();
        let differences = difference::jacobian(all, &x, &places, &[1e-3; VARIABLES]);
        assert_eq!(found.len(), 6 * VARIABLES);
        for (element, found) in found.iter().enumerate() {
            // Rates of coefficients of up to 15 deg/h are 1e-4 rad/s, times 36 beside an angle of 80 deg;
            // readings are below 10 g. A hundred roundings of 1e-16.
            let scale = if element < 3 * VARIABLES { 4e-3 } else { 10.0 };
            let (exact, difference) = (exact[element], differences[element]);
            assert!(
                (found - exact).abs() < 1e-14 * scale,
                "{element}: {found} {exact}"
            );
            // The step amplifies roundings by 2000; its truncation is below that.
            let apart = (found - difference).abs();
            assert!(apart < 1e-10 * scale, "{element}: {found} {difference}");
        }
    }
}

type CatalogueFilter = ExtensionFilter<
    f64,
    StrapdownCatalogue,
    StrapdownCatalogueInputs<f64>,
    { StrapdownCatalogue::STATES },
>;

/// Index of a state of the filter in that on the catalogue.
fn place(state: usize) -> usize {
    let Some(parameter) = state.checked_sub(3) else {
        return state;
    };
    let id = PARAMETERS[parameter].id;
    3 + CATALOGUE_PARAMETERS
        .iter()
        .position(|other| other.id == id)
        .unwrap()
}

fn catalogue_filter() -> CatalogueFilter {
    let effects = CATALOGUE_PARAMETERS[Platform::PARAMETERS..].iter();
    let start = effects.map(|parameter| {
        let mut own = START.iter();
        let own = own.find(|own| own.id == parameter.id);
        own.map_or([0.0, NOTHING], |own| [own.value, own.sigma])
    });
    let settings = settings(Drift::from_array(DRIFT));
    CatalogueFilter::new(
        StrapdownCatalogue,
        start,
        &settings,
        &attitude([0.4, -0.6, 1.1]),
    )
    .unwrap()
}

fn own_filter() -> UnitFilter<f64> {
    let settings = settings(Drift::from_array(DRIFT));
    unit_filter(&settings, &attitude([0.4, -0.6, 1.1])).unwrap()
}

#[test]
fn its_filter_is_that_on_the_whole_catalogue() {
    let (mut own, mut catalogue) = (own_filter(), catalogue_filter());
    let turning = states(Purpose::ScalarTypes, 12);
    let axes = |row: usize| matrix(&turning[row].platform_c_gyros);
    for row in 0..6 {
        let interval_s = if row == 0 { 0.0 } else { STEP_S };
        let (middle, end) = (axes(2 * row), axes(2 * row + 1));
        let expected = own.expected_g();
        let sample = [expected[0] + 4e-3, expected[1] - 3e-3, expected[2] + 1e-3];
        let both = [&middle, &end];
        own.take_turning(interval_s, both, &sample).unwrap();
        catalogue.take_turning(interval_s, both, &sample).unwrap();
        for state in 0..Unit::STATES {
            let sigma = own.filter().sigma(state);
            let [one, other] = [
                own.filter().state()[state],
                catalogue.filter().state()[place(state)],
            ];
            // The same operations but for terms that are zero: roundings of 1e-16, which the form of the
            // covariance takes to 1e-12 in some steps.
            assert!((one - other).abs() < 1e-9 * sigma, "{row} {state}");
            let ratio = catalogue.filter().sigma(place(state)) / sigma;
            assert!((ratio - 1.0).abs() < 1e-9, "{row} {state}: {ratio}");
        }
    }
    // The axes matter: a filter that is not told them ends elsewhere.
    let mut untold = own_filter();
    for row in 0..6 {
        let interval_s = if row == 0 { 0.0 } else { STEP_S };
        untold.take(interval_s, &untold.expected_g()).unwrap();
    }
    assert_ne!(untold.filter().state(), own.filter().state());
}

#[test]
fn the_drift_that_is_compensated_is_that_of_the_equations_in_the_axes_of_the_gyros() {
    let mut filter = own_filter();
    let force = [0.3_f64, -0.5, 0.8];
    let expected: [f64; 3] = core::array::from_fn(|i| {
        let [bias, along, square] = core::array::from_fn(|term| DRIFT[3 * i + term]);
        bias + force[i] * (along + force[i] * square)
    });
    for state in states(Purpose::ScalarTypes, POINTS) {
        let axes = matrix(&state.platform_c_gyros);
        filter.set_gyro_axes(&axes);
        for (given, expected) in filter.drift_deg_per_h(&force).iter().zip(expected) {
            // Rates of 1e-6 rad/s, some roundings of 1e-16 of them.
            assert!((given - expected).abs() < 1e-13, "{given} {expected}");
        }
    }
}
