//! Seeded random states of the platform for comparisons of functions.

use core::f64::consts::PI;

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

/// Earth rate in rad/s (WGS 84).
pub const EARTH_RATE_RAD_PER_S: f64 = 7.292_115e-5;

const SEED: u64 = 20_150_101;

/// Purpose of the states. Each purpose has its own stream of random numbers, so that the states of a
/// test do not depend on those of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Comparison with the interpreter.
    Interpreter = 1,
    /// Comparison with dual numbers.
    Dual = 2,
    /// Comparison with differences.
    Difference = 3,
    /// Comparison of scalar types with each other.
    ScalarTypes = 4,
    /// Proof that a comparison fails when it should.
    Mutation = 5,
    /// Comparison with the equations, written out.
    Equations = 6,
}

/// A state with all inputs of generated functions, group by group.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Platform angles, rad: to ±80°.
    pub theta: [f64; 3],
    /// Drift coefficients in deg/h, deg/h/g, deg/h/g², gyro by gyro: to ±5.
    pub drift: [f64; 9],
    /// Drift noise, deg/h: to ±0.1.
    pub drift_noise: [f64; 3],
    /// Earth rate in chart axes, rad/s: latitudes to ±85°.
    pub omega_0: [f64; 3],
    /// Specific force in chart axes, g.
    pub f_0: [f64; 3],
    /// Length of a step, s: 1 to 120.
    pub step: [f64; 1],
    /// Unit vector East in chart axes.
    pub east_0: [f64; 3],
    /// Magnetic field in chart axes, gauss: to ±0.6 along East, North and Up.
    pub field_0: [f64; 3],
    /// Platform axes from axes of gyros that are fixed to a body, by rows: any rotation.
    pub platform_c_gyros: [f64; 9],
    /// Time since the first row in s, to three days; length of the step in s; temperature
    /// above its mean in K, its rate in K/h and its hysteresis in K, to ±5.
    pub conditions: [f64; 5],
    /// Numbers within ±1 from which parameters and shapes of extended models are computed.
    pub free: [f64; 128],
}

impl State {
    /// The scalars of the group called `name`, or `None` if states have no such group.
    #[must_use]
    pub fn group(&self, name: &str) -> Option<&[f64]> {
        Some(match name {
            "theta" => &self.theta,
            "drift" => &self.drift,
            "drift_noise" => &self.drift_noise,
            "omega_0" => &self.omega_0,
            // At zero angles the axes of the gyros are those of the chart.
            "f_0" | "force" => &self.f_0,
            "step" => &self.step,
            "east_0" => &self.east_0,
            "field_0" => &self.field_0,
            "platform_c_gyros" => &self.platform_c_gyros,
            "conditions" => &self.conditions,
            _ => return None,
        })
    }

    /// Parameters of an extended model: the drift coefficients, then those of effects, to ±0.5 of
    /// their unit: as large as drifts, so that an error is visible.
    ///
    /// # Panics
    /// If there are fewer than nine.
    #[must_use]
    pub fn parameters(&self, count: usize) -> Vec<f64> {
        assert!(count >= 9, "{count} parameters, of which nine are drift");
        let effects = self.free.iter().cycle().map(|free| 0.5 * free);
        self.drift.into_iter().chain(effects).take(count).collect()
    }

    /// Shapes of an extended model by their names: onsets in s near the step, most of them
    /// within it, and time constants in h, from 12 to 36.
    ///
    /// # Panics
    /// If a name has not the ending of a shape.
    #[must_use]
    pub fn shapes(&self, names: &[String]) -> Vec<f64> {
        let [time_s, interval_s, ..] = self.conditions;
        let numbers = self.free.iter().rev().cycle();
        names
            .iter()
            .zip(numbers)
            .map(|(name, free)| {
                if name.ends_with("_onset_s") {
                    time_s + 0.7 * free * interval_s
                } else if name.ends_with("_time_constant_h") {
                    24.0 + 12.0 * free
                } else {
                    panic!("no range for the shape `{name}`")
                }
            })
            .collect()
    }
}

/// The first `count` states of a purpose.
///
/// In every other state the chart is East-North-Up; in the rest it is turned at random, as
/// it is after the filter has moved it.
#[must_use]
pub fn states(purpose: Purpose, count: usize) -> Vec<State> {
    // ChaCha8: see `gyrocal_statistics::deviates`.
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    rng.set_stream(purpose as u64);
    (0..count)
        .map(|number| state(&mut rng, number % 2 == 1))
        .collect()
}

fn state(rng: &mut ChaCha8Rng, turned: bool) -> State {
    let within = |rng: &mut ChaCha8Rng, limit: f64| rng.random_range(-limit..=limit);
    let angle_limit = 80_f64.to_radians();
    let latitude = within(rng, 85_f64.to_radians());
    let (omega_y, omega_z) = (latitude.cos(), latitude.sin());
    let turn = if turned {
        quaternion(rng)
    } else {
        [1.0, 0.0, 0.0, 0.0]
    };
    State {
        theta: core::array::from_fn(|_| within(rng, angle_limit)),
        drift: core::array::from_fn(|_| within(rng, 5.0)),
        drift_noise: core::array::from_fn(|_| within(rng, 0.1)),
        omega_0: rotate(turn, [0.0, omega_y, omega_z]).map(|part| EARTH_RATE_RAD_PER_S * part),
        f_0: rotate(turn, [0.0, 0.0, 1.0]),
        step: [rng.random_range(1.0..=120.0)],
        east_0: rotate(turn, [1.0, 0.0, 0.0]),
        field_0: rotate(turn, core::array::from_fn(|_| within(rng, 0.6))),
        conditions: [
            rng.random_range(0.0..=3.0 * 86_400.0),
            rng.random_range(1.0..=120.0),
            within(rng, 5.0),
            within(rng, 5.0),
            within(rng, 5.0),
        ],
        free: core::array::from_fn(|_| within(rng, 1.0)),
        platform_c_gyros: {
            let turn = quaternion(rng);
            let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            let columns = columns.map(|axis| rotate(turn, axis));
            core::array::from_fn(|place| columns[place % 3][place / 3])
        },
    }
}

/// A uniformly random unit quaternion (w, x, y, z): Shoemake, Graphics Gems III, 1992.
fn quaternion(rng: &mut ChaCha8Rng) -> [f64; 4] {
    let share: f64 = rng.random_range(0.0..=1.0);
    let (first, second) = (rng.random_range(-PI..=PI), rng.random_range(-PI..=PI));
    let (a, b) = ((1.0 - share).sqrt(), share.sqrt());
    [
        b * second.cos(),
        a * first.sin(),
        a * first.cos(),
        b * second.sin(),
    ]
}

/// v + 2 q × (q × v + w v), with q the vector part.
fn rotate([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let q = [x, y, z];
    let inner = cross(q, v);
    let outer = cross(q, core::array::from_fn(|i| inner[i] + w * v[i]));
    core::array::from_fn(|i| v[i] + 2.0 * outer[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn a_purpose_has_its_own_states_and_they_do_not_change() {
        let states_of_dual = states(Purpose::Dual, 20);
        assert_eq!(states_of_dual, states(Purpose::Dual, 20));
        assert_eq!(states_of_dual[..5], states(Purpose::Dual, 5));
        assert_ne!(states_of_dual, states(Purpose::Difference, 20));
    }

    #[test]
    fn states_fill_their_ranges_and_charts_are_rigid() {
        let states = states(Purpose::Interpreter, 10_000);
        for (number, state) in states.iter().enumerate() {
            // Two unit vectors at the angle that a latitude within ±85° makes: sin 85°.
            assert!((dot(&state.f_0, &state.f_0) - 1.0).abs() < 1e-14);
            let earth_rate = dot(&state.omega_0, &state.omega_0).sqrt() / EARTH_RATE_RAD_PER_S;
            assert!((earth_rate - 1.0).abs() < 1e-14);
            let sine = dot(&state.omega_0, &state.f_0) / EARTH_RATE_RAD_PER_S;
            assert!(sine.abs() < 0.996_195);
            if number % 2 == 0 {
                assert_eq!((state.f_0, state.omega_0[0]), ([0.0, 0.0, 1.0], 0.0));
            }
        }
        let largest = |of: fn(&State) -> f64| states.iter().map(of).fold(f64::MIN, f64::max);
        // Of 10 000 uniform numbers the largest is within 0.1% of the limit (but for e^-10).
        let angle = largest(|state| state.theta[1].abs()).to_degrees();
        assert!(angle <= 80.0 && angle > 79.92, "{angle}");
        let drift = largest(|state| -state.drift[8]);
        assert!(drift <= 5.0 && drift > 4.99, "{drift}");
        let turned: Vec<&State> = states.iter().skip(1).step_by(2).collect();
        let mean = turned.iter().map(|state| state.f_0[0]).sum::<f64>() / turned.len() as f64;
        // Uniform on the sphere: mean 0 with standard deviation 1/sqrt(3 · 5000) = 0.0082.
        assert!(mean.abs() < 0.033, "{mean}");
    }
}
