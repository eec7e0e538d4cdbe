//! The platform with its catalogue of effects, as a plant of the score tests.

use gyrocal::generated::catalogue::{self, EFFECTS, OUTPUTS, PARAMETERS, RATES, SHAPES};
use gyrocal_hypothesis::{Covariate, Plant, Rows, WeightInputs};
use gyrocal_record::Record;

use crate::coefficients;

/// Sidereal day, s: the Earth turns under the platform in it.
const SIDEREAL_DAY_S: f64 = core::f64::consts::TAU / gyrocal::EARTH_RATE_RAD_PER_S;

/// Names of the components of specific force.
const FORCES: [&str; 3] = [
    "specific force along x",
    "specific force along y",
    "specific force along z",
];

/// Range of a component of specific force below which it shows no curve, g.
const LEAST_RANGE_G: f64 = 0.02;

/// The platform: its moving states are a rotation of the attitude about the platform axes, rad, its
/// covariates the components of specific force along them, g, its regressor the temperature about
/// its mean, K.
pub static PLATFORM: Plant = Plant {
    effects: &EFFECTS,
    parameters: &PARAMETERS,
    nominal_parameters: coefficients::PARAMETERS,
    shapes: &SHAPES,
    rates: &RATES,
    rate_states: &[0, 1, 2],
    outputs: &OUTPUTS,
    moving_states: 3,
    weight_count: weight_count(catalogue::weights),
    weights,
    natural_periods_s: &[SIDEREAL_DAY_S],
};

/// The generated weights, of specific force, conditions and shapes.
type Weights<const N: usize> = fn(&[f64; 3], &[f64; 3], &[f64; SHAPES.len()]) -> [f64; N];

/// Number of outputs of the generated weights.
const fn weight_count<const N: usize>(_: Weights<N>) -> usize {
    N
}

fn weights(inputs: &WeightInputs<'_>, weights: &mut [f64]) {
    let force = core::array::from_fn(|axis| inputs.covariates.get(axis).copied().unwrap_or(0.0));
    let temperature_k = inputs.regressors.first().copied().unwrap_or(0.0);
    let conditions = [inputs.time_s, inputs.interval_s, temperature_k];
    let shapes = core::array::from_fn(|index| inputs.shapes[index]);
    weights.copy_from_slice(&catalogue::weights(&force, &conditions, &shapes));
}

/// Rows of a record of the platform, along a trajectory with these covariates.
#[must_use]
pub fn rows(record: &Record, covariates: Vec<Covariate>) -> Rows {
    let about_mean = |logged: &Vec<f64>| {
        let mean = logged.iter().sum::<f64>() / logged.len().max(1) as f64;
        logged.iter().map(|value| value - mean).collect()
    };
    Rows {
        time_s: record.time_s.clone(),
        starts: Vec::new(),
        regressors: record.temperature_c.iter().map(about_mean).collect(),
        covariates,
    }
}

/// The components of specific force at each row.
pub(crate) fn covariates(force_g: &[[f64; 3]]) -> Vec<Covariate> {
    (0..FORCES.len())
        .map(|axis| Covariate {
            name: FORCES[axis],
            least_range: LEAST_RANGE_G,
            values: force_g.iter().map(|force_g| force_g[axis]).collect(),
        })
        .collect()
}
