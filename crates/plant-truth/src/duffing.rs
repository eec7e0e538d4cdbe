//! A mass on a spring, driven by a known force.

use crate::random::Stream;
use crate::run::{Multisine, Run, step};

/// Time between rows, s.
pub const STEP_S: f64 = 0.05;

/// Standard deviation of the noise of the displacement, m.
pub const NOISE_M: f64 = 0.01;

/// What the simulation has that a linear spring lacks. Sizes are those of the named terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hidden {
    /// Nothing.
    Nothing,
    /// `v_rate.x^3`.
    CubicSpring(f64),
    /// `v_rate.x^2`.
    UnevenSpring(f64),
    /// `v_rate.v|v|`.
    QuadraticDrag(f64),
    /// `v_rate.bias`.
    Force(f64),
    /// `y.y^2`.
    BentSensor(f64),
    /// `y.lag`, s.
    LateSensor(f64),
    /// `k.step` at a share of the record.
    StiffnessStep(f64, f64),
    /// `v_rate.x u`.
    DriveByPlace(f64),
}

/// Oscillator and record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario {
    /// Stiffness over mass, 1/s².
    pub stiffness: f64,
    /// Damping over mass, 1/s.
    pub damping: f64,
    /// Gain of the drive over mass, 1/kg.
    pub gain: f64,
    /// Initial displacement, m, and velocity, m/s.
    pub initial: [f64; 2],
    /// Root mean square of the drive, N.
    pub drive: f64,
    /// Noise over the usual one.
    pub noise: f64,
    /// Rows.
    pub rows: usize,
    /// Seed of drive and noise.
    pub seed: u64,
    /// The hidden effect.
    pub hidden: Hidden,
}

impl Scenario {
    /// An oscillator of a population.
    #[must_use]
    pub fn random(seed: u64) -> Self {
        let mut random = Stream::new(seed, 0);
        Self {
            stiffness: random.log_between(2.5, 6.0),
            damping: random.log_between(0.15, 0.6),
            gain: random.log_between(0.7, 1.4),
            initial: [0.5 * random.normal(), random.normal()],
            drive: random.log_between(1.0, 2.5),
            noise: 1.0,
            rows: 800,
            seed,
            hidden: Hidden::Nothing,
        }
    }
}

/// The record of a scenario.
#[must_use]
pub fn simulate(scenario: &Scenario) -> Run {
    let mut drive = Stream::new(scenario.seed, 1);
    let mut noise = Stream::new(scenario.seed, 2);
    let drive = Multisine::new(&mut drive, scenario.drive, [0.05, 0.8]);
    let mut state = scenario.initial;
    let mut run = Run::default();
    for row in 0..scenario.rows {
        let time_s = row as f64 * STEP_S;
        let (here, next) = (drive.at(time_s), drive.at(time_s + STEP_S));
        let reading = reading(scenario, time_s, state, here);
        run.time_s.push(time_s);
        run.inputs.push(vec![here]);
        run.outputs
            .push(vec![reading + scenario.noise * NOISE_M * noise.normal()]);
        state = step(state, (time_s, STEP_S), |time_s, share, state| {
            rates(scenario, time_s, *state, here + share * (next - here))
        });
    }
    run
}

fn rates(scenario: &Scenario, time_s: f64, [x, v]: [f64; 2], force: f64) -> [f64; 2] {
    let mut stiffness = scenario.stiffness;
    let duration_s = (scenario.rows - 1) as f64 * STEP_S;
    let extra = match scenario.hidden {
        Hidden::CubicSpring(size) => size * x * x * x,
        Hidden::UnevenSpring(size) => size * x * x,
        Hidden::QuadraticDrag(size) => size * v * v.abs(),
        Hidden::Force(size) => size,
        Hidden::DriveByPlace(size) => size * x * force,
        Hidden::StiffnessStep(size, share) => {
            if time_s >= share * duration_s {
                stiffness += size;
            }
            0.0
        }
        Hidden::Nothing | Hidden::BentSensor(_) | Hidden::LateSensor(_) => 0.0,
    };
    [v, scenario.gain * force - stiffness * x - scenario.damping * v + extra]
}

fn reading(scenario: &Scenario, time_s: f64, state: [f64; 2], force: f64) -> f64 {
    let x = state[0];
    match scenario.hidden {
        Hidden::BentSensor(size) => x + size * x * x,
        Hidden::LateSensor(lag_s) => {
            // A late sensor reads the past.
            let past = |state: [f64; 2]| {
                let rates = rates(scenario, time_s, state, force);
                state[0] - lag_s * rates[0] + 0.5 * lag_s * lag_s * rates[1]
            };
            past(state)
        }
        _ => x,
    }
}
