//! Sound records of all sorts, which no check of a set-up may refuse.

use gyrocal_record::{AXES, Prior};
use gyrocal_statistics::deviates::Draw;

use super::leave_angles_out;
use super::noise::quantised;
use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::hidden::Hidden;
use crate::population::Population;
use crate::scenario::Scenario;
use crate::simulation::{Simulation, simulate};

/// The scenario of a number: any attitude, latitudes of this range north or south, the same of all of a seed, two to
/// four days each minute.
#[must_use]
pub fn any_scenario(seed: u64, number: u64, [least_deg, most_deg]: [f64; 2]) -> Scenario {
    let population = Population {
        duration_days: [2.0, 4.0],
        ..Population::new(seed)
    };
    let mut random = Draw::new(seed, 0);
    let sign = random.sign();
    Scenario {
        latitude_deg: sign * (least_deg + (most_deg - least_deg) * random.uniform()),
        ..population.scenario(number)
    }
}

/// A scenario of any latitude, attitude, sampling and prior, with coefficients from the prior.
///
/// # Errors
/// None that a seed can have: those of [`Hidden::new`].
pub fn varied_scenario(seed: u64) -> Result<Scenario, Error> {
    let mut random = Draw::new(seed, 2);
    let population = Population {
        duration_days: [1.0, 5.0],
        ..Population::varied(seed)
    };
    let mut scenario = population.scenario(0);
    match (random.uniform() * 10.0) as u32 {
        0 => {
            scenario.interval_s = 1.0;
            scenario.duration_s = 21_600.0 + (64_800.0 * random.uniform()).floor();
            scenario.gaps_s.clear();
        }
        1 => {
            scenario.interval_s = 600.0;
            scenario.duration_s = 600.0 * (scenario.duration_s / 600.0).floor();
        }
        _ => {}
    }
    let prior = random.log_uniform([0.1, 10.0]);
    scenario.prior = Prior {
        bias_sigma_deg_per_h: [prior.max(0.3); 3],
        g_sigma_deg_per_h_per_g: [prior; 3],
        gg_sigma_deg_per_h_per_g2: [prior; 3],
        ..Prior::default()
    };
    let mut three = |sigma: f64| core::array::from_fn(|_| sigma * random.normal().clamp(-2.5, 2.5));
    scenario.coefficients = Coefficients {
        bias_deg_per_h: three(prior.max(0.3)),
        g_deg_per_h_per_g: three(prior),
        gg_deg_per_h_per_g2: three(0.5 * prior),
    };
    if random.uniform() < 0.3 {
        let lsb_g = scenario.accel_noise_g * random.log_uniform([1.0, 30.0]);
        scenario.hidden.extend(quantised(lsb_g)?);
    }
    Ok(scenario)
}

/// The record of a scenario, with noise declared right or in another unit, and with angles or
/// without.
///
/// # Errors
/// As [`simulate`].
pub fn varied_record(seed: u64, scenario: &Scenario) -> Result<Simulation, Error> {
    let mut random = Draw::new(seed, 3);
    let mut simulation = simulate(scenario)?;
    let unit = *random.one_of(&[1.0, 1.0, 1.0, 7.7, 1.0 / 7.7, 60.0, 1.0 / 60.0]);
    simulation.bench.accel_noise_g *= unit;
    simulation.bench.gyro_noise_deg_per_h *= unit;
    if random.uniform() < 0.5 {
        leave_angles_out(&mut simulation.bench);
    }
    Ok(simulation)
}

/// Large effects of all sorts, about a hundred of their own sigmas in three days of minutes.
pub fn large_effects(scenario: &Scenario, random: &mut Draw) -> Vec<Hidden> {
    let onset_s = scenario.duration_s * (0.2 + 0.6 * random.uniform());
    let gyro = |name: &str| format!("gyro_{}.{name}", AXES[(onset_s as usize) % 3]);
    let accel = |name: &str| format!("accel_{}.{name}", AXES[(onset_s as usize) % 3]);
    let size = random.sign() * random.log_uniform([0.1, 1.0]);
    #[rustfmt::skip] // a table
    let effects = [
        (gyro("step"), vec![("size", 0.3 * size), ("onset_s", onset_s)]),
        (gyro("warmup"), vec![("size", size), ("time_constant_h", 6.0)]),
        (gyro("ramp"), vec![("size", 0.3 * size)]),
        (gyro("diurnal"), vec![("sine", 0.2 * size), ("cosine", 0.1)]),
        (gyro("random_walk"), vec![("size", 2e-3)]),
        ("gyro_y.g_z".to_owned(), vec![("size", 0.1 * size)]),
        ("gyro_x.g_xy".to_owned(), vec![("size", 0.1 * size)]),
        (accel("bias"), vec![("size", 5e-5 * size)]),
        (accel("scale"), vec![("size", 1e-4 * size)]),
        (accel("ramp"), vec![("size", 3e-5 * size)]),
        (accel("noise"), vec![("ratio", 10.0)]),
        ("accel_xy.nonorthogonality".to_owned(), vec![("size", 1e-4 * size)]),
        ("accel.outliers".to_owned(), vec![("fraction", 0.02), ("size", 100.0)]),
        ("accel.coloured_noise".to_owned(), vec![("correlation", 0.5)]),
        ("site.latitude".to_owned(), vec![("size", 0.1 * size)]),
        ("clock.rate".to_owned(), vec![("size", 2.7e-3)]),
        ("platform.knock".to_owned(), vec![("x_deg", 0.2 * size), ("y_deg", 0.2), ("z_deg", 0.1), ("onset_s", onset_s)]),
    ];
    let drawn = random.one_of(&effects);
    Hidden::new(&drawn.0, &drawn.1).into_iter().collect()
}
