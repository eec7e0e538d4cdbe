//! Generated values against the equations of the paper, written out with full matrices.
//!
//! The other oracles start from the derivation; this one detects a derivation that differs from the
//! paper. Equation numbers are those of Li Zhong, 2015.

use core::f64::consts::PI;

use gyrocal::generated::platform;
use gyrocal_oracle::points::{Purpose, states};

use crate::STATES;

pub(crate) type Vector = [f64; 3];
pub(crate) type Matrix = [Vector; 3];

pub(crate) const RAD_PER_S_IN_DEG_PER_H: f64 = 180.0 * 3600.0 / PI;

fn times(a: &Matrix, b: &Matrix) -> Matrix {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..3).map(|inner| a[i][inner] * b[inner][j]).sum())
    })
}

pub(crate) fn apply(a: &Matrix, v: &Vector) -> Vector {
    a.map(|row| (0..3).map(|j| row[j] * v[j]).sum())
}

/// Equation (4): Rz Ry Rx of passive elementary rotations.
pub(crate) fn platform_c_chart(&[x, y, z]: &Vector) -> Matrix {
    let rx = [
        [1.0, 0.0, 0.0],
        [0.0, x.cos(), x.sin()],
        [0.0, -x.sin(), x.cos()],
    ];
    let ry = [
        [y.cos(), 0.0, -y.sin()],
        [0.0, 1.0, 0.0],
        [y.sin(), 0.0, y.cos()],
    ];
    let rz = [
        [z.cos(), z.sin(), 0.0],
        [-z.sin(), z.cos(), 0.0],
        [0.0, 0.0, 1.0],
    ];
    times(&rz, &times(&ry, &rx))
}

/// Equation (6).
pub(crate) fn rate_matrix(&[_, y, z]: &Vector) -> Matrix {
    [
        [y.cos() * z.cos(), z.sin(), 0.0],
        [-y.cos() * z.sin(), z.cos(), 0.0],
        [y.sin(), 0.0, 1.0],
    ]
}

#[test]
fn generated_values_satisfy_the_equations_of_the_paper() {
    // Numbers of size 1 after some ten to twenty roundings of 1.1e-16 each on either side.
    let near = |value: f64, expected: f64, scale: f64, what: &str, point: usize| {
        let error = (value - expected).abs() / scale;
        assert!(
            error <= 5e-15,
            "{what} at point {point}: {value:e}, expected {expected:e}"
        );
    };
    for (point, state) in states(Purpose::Equations, STATES).iter().enumerate() {
        let (c, w) = (platform_c_chart(&state.theta), rate_matrix(&state.theta));
        let anchor = platform::reanchor(&state.theta);
        let anchor_w = anchor.rotation_d_theta_dense();
        // (8): up positive.
        let a = apply(&c, &state.f_0);
        let force = platform::specific_force(&state.theta, &state.f_0);
        // (1), (2)
        let drift: Vector = core::array::from_fn(|i| {
            let [fixed, along, square] = core::array::from_fn(|term| state.drift[3 * i + term]);
            fixed + along * a[i] + square * a[i] * a[i]
        });
        let omega_d = platform::drift_rate(&state.theta, &state.drift, &state.f_0);
        // (5), in deg/h: the solution must satisfy it; no matrix is inverted here.
        let theta_dot = platform::dynamics(&state.theta, &state.drift, &state.omega_0, &state.f_0);
        let earth_rate = apply(&c, &state.omega_0);
        let relative_rate = apply(&w, &theta_dot);
        // Terms of (5): the largest of Earth rate, drift, and what cancels in W θ̇.
        let largest = theta_dot
            .iter()
            .fold(1e-4, |largest: f64, rate| largest.max(rate.abs()));
        // (14), (15)
        let [dt] = state.step;
        let next = platform::euler_step(
            &state.theta,
            &state.drift,
            &state.omega_0,
            &state.f_0,
            &state.step,
        );
        for i in 0..3 {
            for j in 0..3 {
                near(anchor.platform_c_chart[i][j], c[i][j], 1.0, "C", point);
                near(anchor_w[i][j], w[i][j], 1.0, "W", point);
            }
            near(force[i], a[i], 1.0, "specific force", point);
            near(omega_d[i], drift[i], 15.0, "drift", point);
            let rate = RAD_PER_S_IN_DEG_PER_H * (relative_rate[i] + earth_rate[i]);
            let scale = RAD_PER_S_IN_DEG_PER_H * largest;
            near(rate, drift[i], scale, "rates", point);
            near(
                next[i],
                state.theta[i] + dt * theta_dot[i],
                1.4,
                "Euler step",
                point,
            );
        }
    }
}
