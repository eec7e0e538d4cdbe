//! Errors of the accelerometers without noise.

use gyrocal_truth::{Coefficients, simulate};

use crate::{DAY_S, HOUR_S, quiet, with};

type Case<'a> = (
    &'a str,
    &'a [(&'a str, f64)],
    fn(f64, [f64; 3], f64) -> [f64; 3],
);

/// Effect, parameters, and the error of the output at a time, specific force and temperature.
const CASES: [Case<'_>; 12] = [
    ("accel_x.bias", &[("size", 1e-3)], |_, _, _| {
        [1e-3, 0.0, 0.0]
    }),
    ("accel_y.scale", &[("size", 1e-3)], |_, a, _| {
        [0.0, 1e-3 * a[1], 0.0]
    }),
    ("accel_z.quadratic", &[("size", 1e-3)], |_, a, _| {
        [0.0, 0.0, 1e-3 * a[2] * a[2]]
    }),
    ("accel_xy.nonorthogonality", &[("size", 1e-3)], |_, a, _| {
        [1e-3 * a[1], 1e-3 * a[0], 0.0]
    }),
    ("accel_xz.nonorthogonality", &[("size", 1e-3)], |_, a, _| {
        [1e-3 * a[2], 0.0, 1e-3 * a[0]]
    }),
    ("accel_yz.nonorthogonality", &[("size", 1e-3)], |_, a, _| {
        [0.0, 1e-3 * a[2], 1e-3 * a[1]]
    }),
    ("accel_z.temperature", &[("size", 1e-3)], |_, _, k| {
        [0.0, 0.0, 1e-3 * k]
    }),
    (
        "accel_x.temperature_square",
        &[("size", 1e-3)],
        |_, _, k| [1e-3 * k * k, 0.0, 0.0],
    ),
    ("accel_y.ramp", &[("size", 1e-3)], |t, _, _| {
        [0.0, 1e-3 * t / DAY_S, 0.0]
    }),
    (
        "accel_x.tone",
        &[("size", 1e-3), ("period_h", 5.3), ("phase_deg", -90.0)],
        |t, _, _| {
            let angle = core::f64::consts::TAU * t / (5.3 * HOUR_S);
            [-1e-3 * angle.cos(), 0.0, 0.0]
        },
    ),
    ("accel_z.sign", &[("size", 1e-3)], |_, a, _| {
        [0.0, 0.0, 1e-3 * a[2].signum()]
    }),
    ("accel_x.dead_zone", &[("size", 0.1)], |_, a, _| {
        [if a[0].abs() < 0.1 { -a[0] } else { 0.0 }, 0.0, 0.0]
    }),
];

#[test]
fn an_effect_adds_to_the_output_what_its_definition_says() {
    for (id, parameters, formula) in CASES {
        let scenario = quiet(Coefficients::PAPER_LIKE);
        let clean = simulate(&scenario).unwrap();
        let seen = simulate(&with(&scenario, id, parameters)).unwrap();
        // An accelerometer moves nothing.
        assert_eq!(
            seen.truth.platform_c_enu, clean.truth.platform_c_enu,
            "{id}"
        );
        let temperature_c = seen.record.temperature_c.as_ref().unwrap();
        let mean_c = temperature_c.iter().sum::<f64>() / temperature_c.len() as f64;
        let mut largest: f64 = 0.0;
        for (row, temperature_c) in temperature_c.iter().enumerate() {
            let accel_g = seen.truth.platform_c_enu[row].resolve([0.0, 0.0, 1.0]);
            let expected = formula(seen.record.time_s[row], accel_g, temperature_c - mean_c);
            for axis in 0..3 {
                let added = seen.record.accel_g[row][axis] - accel_g[axis];
                // Rounding of 1 g and of the attitude.
                assert!(
                    (added - expected[axis]).abs() < 2e-15,
                    "{id}, row {row}, axis {axis}: {added} instead of {}",
                    expected[axis]
                );
                largest = largest.max(expected[axis].abs());
            }
        }
        assert!(largest > 3e-4, "{id} is never seen: {largest}");
    }
}
