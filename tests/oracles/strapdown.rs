//! The analytic platform against its equation, written out, and against the functions it is made of.

use gyrocal::Catalogue;
use gyrocal::generated::strapdown::{self, Strapdown, StrapdownInputs};
use gyrocal::generated::surveyed;
use gyrocal::generated::{catalogue, strapdown_catalogue};
use gyrocal_oracle::points::{Purpose, states};
use gyrocal_scalar::Model;

use crate::equations::{
    Matrix, RAD_PER_S_IN_DEG_PER_H, Vector, apply, platform_c_chart, rate_matrix,
};

const STATES: usize = 1000;

#[test]
fn the_platform_turns_by_minus_the_errors_of_gyros_at_body_specific_force() {
    for (point, state) in states(Purpose::Equations, STATES).iter().enumerate() {
        let mut parameters = [0.0; Strapdown::PARAMETERS];
        parameters[..9].copy_from_slice(&state.drift);
        let r = &state.platform_c_gyros;
        let platform_c_gyros: Matrix =
            core::array::from_fn(|i| [r[3 * i], r[3 * i + 1], r[3 * i + 2]]);
        let gyros_c_platform: Matrix =
            core::array::from_fn(|i| core::array::from_fn(|j| platform_c_gyros[j][i]));
        let c = platform_c_chart(&state.theta);
        let force = apply(&gyros_c_platform, &apply(&c, &state.f_0));
        let error: Vector = core::array::from_fn(|i| {
            let [bias, along, square] = core::array::from_fn(|term| state.drift[3 * i + term]);
            bias + along * force[i] + square * force[i] * force[i]
        });
        let turned = apply(&platform_c_gyros, &error);
        let sidereal = apply(&c, &state.omega_0);
        let theta_dot = strapdown::dynamics(
            &state.theta,
            &parameters,
            &state.omega_0,
            &state.f_0,
            &state.east_0,
            r,
        );
        // Equation (5): no matrix is inverted here.
        let relative = apply(&rate_matrix(&state.theta), &theta_dot);
        for i in 0..3 {
            let expected = -turned[i] - RAD_PER_S_IN_DEG_PER_H * sidereal[i];
            let found = RAD_PER_S_IN_DEG_PER_H * relative[i];
            // Sums of some ten terms of up to 15 deg/h, by a matrix with elements up to 6 (80 deg)
            // and back: a hundred roundings of 1e-16 of them.
            assert!(
                (found - expected).abs() < 2e-12,
                "state {point}, axis {i}: {found} {expected}"
            );
        }
    }
}

/// Effects of inputs and of time, which are the same for both platforms.
const OF_THE_SITE: [&str; 4] = [
    "site.latitude",
    "site.earth_rate",
    "site.gravity",
    "clock.rate",
];

#[test]
fn its_catalogue_is_that_of_the_platform_in_the_axes_of_the_instruments() {
    let names = catalogue::SHAPES.map(|shape| shape.name.to_owned());
    for (point, state) in states(Purpose::Equations, STATES).iter().enumerate() {
        let mut p: [f64; Catalogue::PARAMETERS] =
            state.parameters(Catalogue::PARAMETERS).try_into().unwrap();
        for (value, parameter) in p.iter_mut().zip(&catalogue::PARAMETERS) {
            if OF_THE_SITE.contains(&parameter.id) {
                *value = 0.0;
            }
        }
        let shapes = state.shapes(&names).try_into().unwrap();
        let r = &state.platform_c_gyros;
        let rotation: Matrix = core::array::from_fn(|i| [r[3 * i], r[3 * i + 1], r[3 * i + 2]]);
        let back: Matrix = core::array::from_fn(|i| [r[i], r[3 + i], r[6 + i]]);
        let c = platform_c_chart(&state.theta);
        let along = |vector: &Vector| apply(&back, &apply(&c, vector));
        let (force, field) = (along(&state.f_0), along(&state.field_0));
        let (zero, conditions) = ([0.0; 3], &state.conditions);
        // Without Earth rate, and at zero angles, the rates are the drift.
        let drift = catalogue::dynamics(
            &zero,
            &p,
            &zero,
            &force,
            &state.east_0,
            &field,
            conditions,
            &shapes,
        );
        let read = catalogue::accelerometers(&zero, &p, &force, conditions);
        let errors = core::array::from_fn(|i| read[i] - force[i]);
        let (turned, off) = (apply(&rotation, &drift), apply(&rotation, &errors));
        let (sidereal, ideal) = (apply(&c, &state.omega_0), apply(&c, &state.f_0));
        let theta_dot = strapdown_catalogue::dynamics(
            &state.theta,
            &p,
            &state.omega_0,
            &state.f_0,
            &state.east_0,
            &state.field_0,
            r,
            conditions,
            &shapes,
        );
        let reading =
            strapdown_catalogue::accelerometers(&state.theta, &p, &state.f_0, r, conditions);
        let relative = apply(&rate_matrix(&state.theta), &theta_dot);
        for i in 0..3 {
            let expected = RAD_PER_S_IN_DEG_PER_H * (-turned[i] - sidereal[i]);
            let found = RAD_PER_S_IN_DEG_PER_H * relative[i];
            // Sums of some eighty terms of up to 15 deg/h, with products of drifts, by a matrix with elements
            // up to 6 and back: a thousand roundings of 1e-16 of them.
            assert!(
                (found - expected).abs() < 2e-11,
                "state {point}, axis {i}: {found} {expected}"
            );
            assert!(
                (reading[i] - ideal[i] - off[i]).abs() < 1e-13,
                "state {point}, axis {i}"
            );
        }
    }
}

#[test]
fn the_model_is_its_functions_and_its_parameters_are_those_of_the_surveyed_one() {
    assert_eq!(
        strapdown::PARAMETERS.map(|parameter| parameter.id),
        surveyed::PARAMETERS.map(|parameter| parameter.id)
    );
    let state = &states(Purpose::ScalarTypes, 1)[0];
    let inputs = StrapdownInputs {
        omega_0: state.omega_0,
        f_0: state.f_0,
        east_0: state.east_0,
        platform_c_gyros: state.platform_c_gyros,
    };
    let p: [f64; Strapdown::PARAMETERS] =
        state.parameters(Strapdown::PARAMETERS).try_into().unwrap();
    let StrapdownInputs {
        omega_0,
        f_0,
        east_0,
        platform_c_gyros,
    } = &inputs;
    assert_eq!(
        Strapdown.rates(&state.theta, &p, &inputs),
        strapdown::dynamics(&state.theta, &p, omega_0, f_0, east_0, platform_c_gyros)
    );
    assert_eq!(
        Strapdown.output(&state.theta, &p, &inputs),
        strapdown::accelerometers(&state.theta, &p, f_0)
    );
    // Noise turns the platform as a bias does, in the gyros' axes too.
    assert_eq!(
        Model::<f64, 3, 3>::noise_parameters(&Strapdown),
        Some([0, 3, 6])
    );
}
