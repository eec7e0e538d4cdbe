//! Noise has the declared size, and each purpose has its own random numbers.

#![cfg(test)]

use gyrocal_truth::{Attitude, Coefficients, Scenario, Simulation, simulate};

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), value| {
        (sum + value * value, count + 1)
    });
    (sum / f64::from(count)).sqrt()
}

/// Samples minus what ideal accelerometers read.
fn accel_noise(simulation: &Simulation) -> Vec<[f64; 3]> {
    let attitudes = &simulation.truth.platform_c_enu;
    let samples = simulation.record.accel_g.iter();
    samples
        .zip(attitudes)
        .map(|(sample, platform_c_enu)| {
            let ideal = platform_c_enu.resolve([0.0, 0.0, 1.0]);
            core::array::from_fn(|axis| sample[axis] - ideal[axis])
        })
        .collect()
}

/// Turns of the platform in inertial space from row to row, in its own axes.
fn inertial_turns_rad(scenario: &Scenario, simulation: &Simulation) -> Vec<[f64; 3]> {
    let earth_rate = scenario.platform().earth_rate_enu_rad_per_s();
    let platform_c_inertial: Vec<Attitude> = simulation
        .record
        .time_s
        .iter()
        .zip(&simulation.truth.platform_c_enu)
        .map(|(time_s, platform_c_enu)| {
            platform_c_enu.after(Attitude::turned_by(earth_rate.map(|rate| rate * time_s)))
        })
        .collect();
    platform_c_inertial
        .windows(2)
        .map(|pair| pair[1].rotation_from_rad(pair[0]))
        .collect()
}

#[test]
fn accelerometer_noise_has_the_declared_size() {
    let scenario = Scenario::default();
    let noise = accel_noise(&simulate(&scenario).unwrap());
    let measured = rms(noise.into_iter().flatten()) / scenario.accel_noise_g;
    // 3 * 4321 numbers: the relative error of their rms has a sigma of 0.6%.
    assert!((measured - 1.0).abs() < 0.025, "{measured}");
}

#[test]
fn gyro_noise_adds_the_same_angle_whatever_the_interval() {
    for interval_s in [15.0, 60.0, 240.0] {
        let scenario = Scenario {
            gyro_noise_deg_per_h: 0.5,
            interval_s,
            duration_s: 4000.0 * interval_s,
            ..Scenario::default()
        };
        let turns = inertial_turns_rad(&scenario, &simulate(&scenario).unwrap());
        let measured = rms(turns.into_iter().flatten());
        // White noise: the angle grows with the root of time, and over one minute it is the
        // declared rate held for a minute.
        let expected = (0.5_f64 / 3600.0).to_radians() * 60.0 * (interval_s / 60.0).sqrt();
        let ratio = measured / expected;
        // 12 000 numbers: 0.65% is one sigma.
        assert!((ratio - 1.0).abs() < 0.026, "{interval_s} s: {ratio}");
    }
}

#[test]
fn the_declared_attitude_is_wrong_by_its_sigma() {
    let errors_deg = (0..600).flat_map(|seed| {
        let scenario = Scenario {
            seed,
            initial_angles_sigma_deg: [0.02; 3],
            ..Scenario::default()
        };
        let declared = scenario.declared_angles_deg();
        let truly = scenario.platform().initial_platform_c_enu.angles_deg();
        (0..3).map(move |axis| truly[axis] - declared[axis])
    });
    let ratio = rms(errors_deg) / 0.02;
    // 1800 numbers: 1.7% is one sigma.
    assert!((ratio - 1.0).abs() < 0.07, "{ratio}");
}

fn short() -> Scenario {
    Scenario {
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: 6.0 * 3600.0,
        ..Scenario::default()
    }
}

#[test]
fn changing_one_noise_leaves_the_others_as_they_are() {
    let before = simulate(&short()).unwrap();
    let louder = simulate(&Scenario {
        accel_noise_g: 1e-3,
        ..short()
    })
    .unwrap();
    assert_eq!(before.truth, louder.truth);
    assert_ne!(before.record, louder.record);

    let other_gyros = simulate(&Scenario {
        gyro_noise_deg_per_h: 0.2,
        ..short()
    })
    .unwrap();
    assert_ne!(before.truth, other_gyros.truth);
    let pairs = accel_noise(&before)
        .into_iter()
        .zip(accel_noise(&other_gyros));
    for (before, after) in pairs {
        for axis in 0..3 {
            // Rounding of the sum of 1 g and the noise.
            assert!((before[axis] - after[axis]).abs() < 1e-15);
        }
    }
}

#[test]
fn gaps_and_missing_components_leave_the_rest_as_it_is() {
    let whole = simulate(&short()).unwrap();
    let gappy = simulate(&Scenario {
        gaps_s: vec![[600.0, 1200.0], [7000.0, 7090.0]],
        missing_fraction: 0.1,
        ..short()
    })
    .unwrap();
    // 600, 660 … 1140 and 7020, 7080.
    assert_eq!(gappy.record.len(), whole.record.len() - 12);
    let mut missing = 0;
    for (row, time_s) in gappy.record.time_s.iter().enumerate() {
        let same = whole
            .record
            .time_s
            .iter()
            .position(|other| other == time_s)
            .unwrap();
        assert_eq!(
            gappy.truth.platform_c_enu[row],
            whole.truth.platform_c_enu[same]
        );
        for axis in 0..3 {
            let component = gappy.record.accel_g[row][axis];
            if component.is_nan() {
                missing += 1;
            } else {
                assert_eq!(component, whole.record.accel_g[same][axis]);
            }
        }
    }
    // 1047 components: 105 expected with a sigma of 10.
    assert!((65..145).contains(&missing), "{missing}");
}

#[test]
fn another_seed_is_another_record() {
    let one = simulate(&short()).unwrap();
    let two = simulate(&Scenario { seed: 2, ..short() }).unwrap();
    assert_ne!(one.record, two.record);
    assert_eq!(one, simulate(&short()).unwrap());
}
