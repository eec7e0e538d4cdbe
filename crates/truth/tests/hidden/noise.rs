//! Effects on the noise, and the independence of random numbers.

use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, simulate};

use crate::{DAY_S, example, inertial_turns_rad, quiet, rms, with};

/// Three days with accelerometer noise only.
fn noisy() -> Scenario {
    Scenario {
        accel_noise_g: 1e-5,
        duration_s: 3.0 * DAY_S,
        ..quiet(Coefficients::PAPER_LIKE)
    }
}

/// Samples minus what ideal accelerometers read, in declared sigmas.
fn noise(simulation: &Simulation) -> Vec<[f64; 3]> {
    let attitudes = &simulation.truth.platform_c_enu;
    let samples = simulation.record.accel_g.iter();
    samples
        .zip(attitudes)
        .map(|(sample, platform_c_enu)| {
            let ideal = platform_c_enu.resolve([0.0, 0.0, 1.0]);
            core::array::from_fn(|axis| (sample[axis] - ideal[axis]) / 1e-5)
        })
        .collect()
}

/// A few roundings of 1 g, in sigmas of 1e-5 g.
const ROUNDING: f64 = 5e-10;

#[test]
fn a_noise_ratio_scales_one_accelerometer() {
    let clean = noise(&simulate(&noisy()).unwrap());
    let ratio = [("ratio", 1.2)];
    let loud = noise(&simulate(&with(&noisy(), "accel_y.noise", &ratio)).unwrap());
    for (loud, clean) in loud.iter().zip(&clean) {
        for (axis, ratio) in [1.0, 1.2, 1.0].into_iter().enumerate() {
            assert!((loud[axis] - ratio * clean[axis]).abs() < ROUNDING);
        }
    }
}

#[test]
fn quantised_samples_are_multiples_of_the_least_bit() {
    let lsb = [("lsb", 3e-5)];
    let scenario = with(&noisy(), "accel_z.quantisation", &lsb);
    let coarse = simulate(&scenario).unwrap().record;
    for (coarse, fine) in coarse
        .accel_g
        .iter()
        .zip(simulate(&noisy()).unwrap().record.accel_g)
    {
        assert_eq!(coarse[..2], fine[..2]);
        assert!((coarse[2] - fine[2]).abs() <= 1.5e-5 + 1e-15);
        let bits = coarse[2] / 3e-5;
        assert!((bits - bits.round()).abs() < 1e-10);
    }
}

#[test]
fn outliers_are_where_the_truth_says() {
    let parameters = [("fraction", 0.005), ("size", 8.0)];
    let seen = simulate(&with(&noisy(), "accel.outliers", &parameters)).unwrap();
    let clean = noise(&simulate(&noisy()).unwrap());
    let (mut count, mut sum) = (0_u32, 0.0);
    for ((seen, clean), is_outlier) in noise(&seen).iter().zip(&clean).zip(&seen.truth.outliers) {
        for axis in 0..3 {
            let added = seen[axis] - clean[axis];
            let expected = if is_outlier[axis] { 8.0 } else { 0.0 };
            assert!((added.abs() - expected).abs() < ROUNDING);
            count += u32::from(is_outlier[axis]);
            sum += added.signum() * f64::from(u8::from(is_outlier[axis]));
        }
    }
    // Of 12 963 components 65 are expected, with a sigma of 8; their signs have one of 8 too.
    assert!((33..97).contains(&count), "{count}");
    assert!(sum.abs() < 33.0, "{sum}");
}

#[test]
fn coloured_noise_has_its_correlation_and_the_same_variance() {
    let correlation = [("correlation", 0.3)];
    let scenario = with(&noisy(), "accel.coloured_noise", &correlation);
    let noise = noise(&simulate(&scenario).unwrap());
    let power = rms(noise.iter().flatten().copied()).powi(2);
    // 12 963 numbers: 1.2% is one sigma, a tenth more for the correlation.
    assert!((power - 1.0).abs() < 0.06, "{power}");
    for lag in 1..=2_u8 {
        let products = noise.iter().zip(&noise[usize::from(lag)..]);
        let sum: f64 = products
            .flat_map(|(a, b)| (0..3).map(move |axis| a[axis] * b[axis]))
            .sum();
        let measured = sum / power / 12_960.0;
        // One sigma is 0.0088.
        assert!(
            (measured - 0.3_f64.powi(lag.into())).abs() < 0.04,
            "{lag}: {measured}"
        );
    }
}

#[test]
fn a_noise_ratio_scales_one_gyro() {
    let scenario = Scenario {
        gyro_noise_deg_per_h: 0.5,
        ..quiet(Coefficients::NONE)
    };
    let turns = |scenario: &Scenario| {
        let truth = simulate(scenario).unwrap().truth;
        inertial_turns_rad(scenario, &truth.platform_c_enu)
    };
    let loud = turns(&with(&scenario, "gyro_y.noise", &[("ratio", 3.0)]));
    for (loud, clean) in loud.iter().zip(turns(&scenario)) {
        for (axis, ratio) in [1.0, 3.0, 1.0].into_iter().enumerate() {
            // Rounding of an Earth angle of 6 rad.
            assert!((loud[axis] - ratio * clean[axis]).abs() < 1e-14);
        }
    }
}

#[test]
fn a_random_walk_is_a_brownian_motion_of_the_drift() {
    let scenario = Scenario {
        duration_s: 10.0 * DAY_S,
        ..quiet(Coefficients::NONE)
    };
    let scenario = with(&scenario, "gyro_x.random_walk", &[("size", 0.06)]);
    let truth = simulate(&scenario).unwrap().truth;
    let drift = &truth.drift_deg_per_h;
    assert_eq!(drift[0], [0.0; 3]);
    let turns = inertial_turns_rad(&scenario, &truth.platform_c_enu);
    let steps = drift.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    // deg/h/√h times the root of a minute; of 14 400 numbers 0.6% is one sigma.
    let expected = 0.06 * (1.0_f64 / 60.0).sqrt();
    assert!((rms(steps) / expected - 1.0).abs() < 0.025);
    // The mean over a minute differs from that of its ends by a Brownian bridge.
    let bridges = drift
        .windows(2)
        .zip(&turns)
        .map(|(pair, turn_rad)| turn_rad[0].to_degrees() * 60.0 - 0.5 * (pair[0][0] + pair[1][0]));
    assert!((rms(bridges) / (expected / 12_f64.sqrt()) - 1.0).abs() < 0.025);
    for gyro in [1, 2] {
        assert!(drift.iter().all(|drift| drift[gyro] == 0.0));
    }
}

#[test]
fn hiding_an_effect_leaves_all_other_random_numbers_as_they_are() {
    let scenario = Scenario {
        gyro_noise_deg_per_h: 0.002,
        missing_fraction: 0.05,
        initial_angles_sigma_deg: [0.01; 3],
        duration_s: DAY_S,
        ..noisy()
    };
    let clean = simulate(&scenario).unwrap();
    for id in Hidden::ids() {
        let hidden = example(&id);
        let seen = simulate(&Scenario {
            hidden: vec![hidden.clone()],
            ..scenario.clone()
        })
        .unwrap();
        // The clock makes time, and with it the motion, another.
        let same_attitude = !id.starts_with("gyro")
            && !["site.", "clock.", "platform."]
                .iter()
                .any(|of| id.starts_with(of));
        assert_eq!(
            seen.truth.platform_c_enu == clean.truth.platform_c_enu,
            same_attitude,
            "{id}"
        );
        let same_record = format!("{:?}", seen.record) == format!("{:?}", clean.record);
        assert!(!same_record, "{id} does nothing");
        assert_eq!(seen.bench, clean.bench, "{id}");
        assert_eq!(seen.record.time_s, clean.record.time_s, "{id}");
        assert_eq!(
            seen.record.temperature_c, clean.record.temperature_c,
            "{id}"
        );
        let unity = id == "site.gravity" || id.starts_with("accel");
        for (seen, clean) in noise(&seen).iter().zip(noise(&clean)) {
            for axis in 0..3 {
                assert_eq!(seen[axis].is_nan(), clean[axis].is_nan(), "{id}");
                let differs = (seen[axis] - clean[axis]).abs() > ROUNDING;
                assert!(unity || !differs, "{id}: {} {}", seen[axis], clean[axis]);
            }
        }
    }
}

#[test]
fn an_effect_of_no_size_is_none() {
    let scenario = Scenario {
        gyro_noise_deg_per_h: 0.002,
        ..noisy()
    };
    let scenario = Scenario {
        duration_s: DAY_S / 4.0,
        ..scenario
    };
    let clean = simulate(&scenario).unwrap();
    for id in Hidden::ids() {
        // A least bit of nothing is refused; a ratio is none at 1, not at 0.
        let neutral: &[(&str, f64)] = match id.rsplit('.').next().unwrap() {
            "quantisation" => {
                assert!(example(&id).scaled(0.0).is_err());
                continue;
            }
            "noise" => &[("ratio", 1.0)],
            "coloured_noise" => &[("correlation", 0.0)],
            _ => &[],
        };
        let hidden = if neutral.is_empty() {
            example(&id).scaled(0.0).unwrap()
        } else {
            Hidden::new(&id, neutral).unwrap()
        };
        let seen = simulate(&Scenario {
            hidden: vec![hidden],
            ..scenario.clone()
        })
        .unwrap();
        for (seen, clean) in seen.record.accel_g.iter().zip(&clean.record.accel_g) {
            for axis in 0..3 {
                // An interval in two steps is rounded otherwise.
                assert!((seen[axis] - clean[axis]).abs() < 1e-14, "{id}");
            }
        }
    }
}
