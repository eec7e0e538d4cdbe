//! The drift equals the definition of the effect, and the platform rotates at that rate.

use gyrocal_truth::{Coefficients, simulate};

use crate::{DAY_S, FIELD_GAUSS, HOUR_S, inertial_turns_rad, quiet, with};

/// Quantities that the definition of an effect depends on, at one row.
struct Row {
    time_s: f64,
    accel_g: [f64; 3],
    temperature_k: f64,
    hysteresis_k: f64,
    field_gauss: [f64; 3],
    /// The whole rate of the platform.
    rate_deg_per_h: [f64; 3],
}

type Case<'a> = (&'a str, &'a [(&'a str, f64)], usize, fn(&Row) -> f64);

/// Effect, parameters, gyro, and the addition to its drift \[deg/h\].
const CASES: [Case<'_>; 20] = [
    ("gyro_x.bias", &[("size", 0.05)], 0, |_| 0.05),
    ("gyro_y.g_y", &[("size", 0.05)], 1, |r| 0.05 * r.accel_g[1]),
    ("gyro_x.g_y", &[("size", 0.05)], 0, |r| 0.05 * r.accel_g[1]),
    ("gyro_y.g_z", &[("size", -0.05)], 1, |r| {
        -0.05 * r.accel_g[2]
    }),
    ("gyro_z.g_xy", &[("size", 0.05)], 2, |r| {
        0.05 * r.accel_g[0] * r.accel_g[1]
    }),
    ("gyro_x.g_yz", &[("size", 0.05)], 0, |r| {
        0.05 * r.accel_g[1] * r.accel_g[2]
    }),
    ("gyro_x.g_yy", &[("size", 0.05)], 0, |r| {
        0.05 * r.accel_g[1].powi(2)
    }),
    ("gyro_z.g_zzz", &[("size", 0.05)], 2, |r| {
        0.05 * r.accel_g[2].powi(3)
    }),
    ("gyro_y.g_xyz", &[("size", 0.05)], 1, |r| {
        0.05 * r.accel_g.iter().product::<f64>()
    }),
    ("gyro_y.ramp", &[("size", 0.05)], 1, |r| {
        0.05 * r.time_s / DAY_S
    }),
    (
        "gyro_z.warmup",
        &[("size", 0.05), ("time_constant_h", 3.0)],
        2,
        |r| 0.05 * (-r.time_s / (3.0 * HOUR_S)).exp(),
    ),
    (
        "gyro_x.diurnal",
        &[("sine", 0.03), ("cosine", -0.04)],
        0,
        |r| {
            let angle = core::f64::consts::TAU * r.time_s / DAY_S;
            0.03 * angle.sin() - 0.04 * angle.cos()
        },
    ),
    (
        "gyro_y.tone",
        &[("size", 0.05), ("period_h", 5.3), ("phase_deg", 30.0)],
        1,
        |r| {
            let angle = core::f64::consts::TAU * r.time_s / (5.3 * HOUR_S);
            0.05 * (angle + 30_f64.to_radians()).sin()
        },
    ),
    ("gyro_x.temperature", &[("size", 0.05)], 0, |r| {
        0.05 * r.temperature_k
    }),
    ("gyro_y.temperature_square", &[("size", 0.05)], 1, |r| {
        0.05 * r.temperature_k * r.temperature_k
    }),
    ("gyro_z.temperature_hysteresis", &[("size", 0.5)], 2, |r| {
        0.5 * r.hysteresis_k
    }),
    ("gyro_z.magnetic", &[("size", 0.05)], 2, |r| {
        0.05 * r.field_gauss[2]
    }),
    ("gyro_xy.axis_misalignment", &[("size", 0.05)], 0, |r| {
        -0.05 * r.rate_deg_per_h[1]
    }),
    ("gyro_zx.axis_misalignment", &[("size", -0.05)], 2, |r| {
        0.05 * r.rate_deg_per_h[0]
    }),
    ("gyro_y.sign_x", &[("size", 0.05)], 1, |r| {
        0.05 * r.accel_g[0].signum()
    }),
];

#[test]
fn an_effect_adds_to_the_drift_what_its_definition_says() {
    for (id, parameters, gyro, formula) in CASES {
        let coefficients = Coefficients::PAPER_LIKE;
        let simulation = simulate(&with(&quiet(coefficients), id, parameters)).unwrap();
        let truth = &simulation.truth;
        let temperature_c = simulation.record.temperature_c.as_ref().unwrap();
        let mean_c = temperature_c.iter().sum::<f64>() / temperature_c.len() as f64;
        let hysteresis_k = hysteresis_k(temperature_c);
        let mut largest: f64 = 0.0;
        for (index, platform_c_enu) in truth.platform_c_enu.iter().enumerate() {
            let row = Row {
                time_s: simulation.record.time_s[index],
                accel_g: platform_c_enu.resolve([0.0, 0.0, 1.0]),
                temperature_k: temperature_c[index] - mean_c,
                hysteresis_k: hysteresis_k[index],
                field_gauss: platform_c_enu.resolve(FIELD_GAUSS),
                rate_deg_per_h: truth.drift_deg_per_h[index],
            };
            let nominal = coefficients.drift_deg_per_h(row.accel_g);
            for (other, nominal) in nominal.into_iter().enumerate() {
                let added = row.rate_deg_per_h[other] - nominal;
                let expected = if other == gyro { formula(&row) } else { 0.0 };
                // Rounding of 1 deg/h, of the attitude, and of a mean over a day.
                assert!(
                    (added - expected).abs() < 1e-13,
                    "{id}, row {index}, gyro {other}: {added} instead of {expected}"
                );
                largest = largest.max(expected.abs());
            }
        }
        assert!(largest > 0.005, "{id} is never seen: {largest}");
    }
}

/// Distance of the temperature from a float that it drags along where it is an eighth of its range away,
/// about its mean.
fn hysteresis_k(temperature_c: &[f64]) -> Vec<f64> {
    let most = temperature_c.iter().copied().fold(f64::MIN, f64::max);
    let least = temperature_c.iter().copied().fold(f64::MAX, f64::min);
    let half_k = (most - least) / 8.0;
    let mut float_c = temperature_c[0];
    let distance_k = temperature_c.iter().map(|temperature_c| {
        float_c = float_c
            .max(temperature_c - half_k)
            .min(temperature_c + half_k);
        temperature_c - float_c
    });
    let distance_k: Vec<f64> = distance_k.collect();
    let mean_k = distance_k.iter().sum::<f64>() / distance_k.len() as f64;
    distance_k
        .iter()
        .map(|distance_k| distance_k - mean_k)
        .collect()
}

#[test]
fn the_rate_of_temperature_is_its_derivative() {
    let nominal = quiet(Coefficients::PAPER_LIKE);
    let size = [("size", 0.05)];
    let of_gyro = simulate(&with(&nominal, "gyro_x.temperature_rate", &size)).unwrap();
    let of_accel = simulate(&with(&nominal, "accel_y.temperature_rate", &size)).unwrap();
    let temperature_c = of_gyro.record.temperature_c.as_ref().unwrap();
    let mut largest: f64 = 0.0;
    for row in 2..temperature_c.len() - 2 {
        // Of fourth order: wrong by the fourth power of 60 s times the fastest wave's rate, 2.9e-4
        // rad/s, over 30: 3e-9 of 3 K/h.
        let near: [f64; 5] = core::array::from_fn(|place| temperature_c[row + place - 2]);
        let per_row = (8.0 * (near[3] - near[1]) - (near[4] - near[0])) / 12.0;
        let expected = 0.05 * 60.0 * per_row;
        let force_g = of_gyro.truth.platform_c_enu[row].resolve([0.0, 0.0, 1.0]);
        let nominal_drift = nominal.coefficients.drift_deg_per_h(force_g)[0];
        let added = of_gyro.truth.drift_deg_per_h[row][0] - nominal_drift;
        assert!((added - expected).abs() < 1e-9, "{row}: {added} {expected}");
        let force_g = of_accel.truth.platform_c_enu[row].resolve([0.0, 0.0, 1.0]);
        let added = of_accel.record.accel_g[row][1] - force_g[1];
        assert!((added - expected).abs() < 1e-9, "{row}: {added} {expected}");
        largest = largest.max(expected.abs());
    }
    assert!(largest > 0.005, "{largest}");
}

#[test]
fn the_platform_turns_at_the_rate_of_its_drift() {
    for (id, parameters, gyro, _) in CASES {
        let scenario = with(&quiet(Coefficients::PAPER_LIKE), id, parameters);
        let truth = simulate(&scenario).unwrap().truth;
        let turns_rad = inertial_turns_rad(&scenario, &truth.platform_c_enu);
        let rates = truth.drift_deg_per_h.windows(2);
        let jumps = if id.contains("sign") { 2 } else { 0 };
        let mut wrong = 0;
        for (turn_rad, rates) in turns_rad.iter().zip(rates) {
            for axis in 0..3 {
                let mean = 0.5 * (rates[0][axis] + rates[1][axis]);
                let expected_rad = mean.to_radians() * scenario.interval_s / HOUR_S;
                // The trapezium rule: Δt³/12 times the second derivative, 1 deg/h times the
                // square of the sweep (5e-10 rad), and a few times that for squares, products
                // and a period of 5.3 h. The effect itself makes 1.5e-5 rad.
                let right = (turn_rad[axis] - expected_rad).abs() < 3e-9;
                assert!(right || axis == gyro, "{id}, axis {axis}");
                wrong += usize::from(!right);
            }
        }
        // Where a sign changes the trapezium rule does not hold: the turn is then between.
        assert!(wrong <= jumps, "{id}: {wrong}");
    }
}
