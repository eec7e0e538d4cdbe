//! The platform with its catalogue of effects, as a plant of the score tests.

use gyrocal::generated::catalogue::theta_index::{THETA_X, THETA_Y, THETA_Z};
use gyrocal::generated::catalogue::{self, EFFECTS, OUTPUTS, PARAMETERS, RATES, SHAPES};
use gyrocal_hypothesis::{Covariate, Plant, Rows, WeightInputs};
use gyrocal_record::Record;

use crate::coefficients;
use crate::temperature::{REGRESSORS, TemperatureCourse, TemperatureScale};

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
/// its mean, K, from which rate of change, K/h, and hysteresis, K, derive.
pub static PLATFORM: Plant = Plant {
    effects: &EFFECTS,
    parameters: &PARAMETERS,
    nominal_parameters: coefficients::PARAMETERS,
    shapes: &SHAPES,
    rates: &RATES,
    rate_states: &[THETA_X, THETA_Y, THETA_Z],
    outputs: &OUTPUTS,
    moving_states: 3,
    weight_count: weight_count(catalogue::weights),
    weights,
    natural_periods_s: &[SIDEREAL_DAY_S],
};

/// The generated weights, of specific force, conditions and shapes.
type Weights<const N: usize> = fn(&[f64; 3], &[f64; CONDITIONS], &[f64; SHAPES.len()]) -> [f64; N];

/// Number of conditions: time, interval and regressors.
const CONDITIONS: usize = 2 + REGRESSORS;

/// Number of outputs of the generated weights.
const fn weight_count<const N: usize>(_: Weights<N>) -> usize {
    N
}

fn weights(inputs: &WeightInputs<'_>, weights: &mut [f64]) {
    let force = core::array::from_fn(|axis| inputs.covariates.get(axis).copied().unwrap_or(0.0));
    let regressor = |place: usize| inputs.regressors.get(place).copied().unwrap_or(0.0);
    let conditions = core::array::from_fn(|place| match place {
        0 => inputs.time_s,
        1 => inputs.interval_s,
        _ => regressor(place - 2),
    });
    let shapes = core::array::from_fn(|index| inputs.shapes[index]);
    weights.copy_from_slice(&catalogue::weights(&force, &conditions, &shapes));
}

/// Rows of a record of the platform, along a trajectory with these covariates.
#[must_use]
pub fn rows(record: &Record, covariates: Vec<Covariate>) -> Rows {
    rows_of(record, Vec::new(), covariates)
}

/// The same of several records, with the first rows of the later ones.
pub(crate) fn rows_of(record: &Record, starts: Vec<usize>, covariates: Vec<Covariate>) -> Rows {
    let mut rows = Rows {
        time_s: record.time_s.clone(),
        starts,
        covariates,
        ..Rows::default()
    };
    let mut all = TemperatureCourse::default();
    let scale = TemperatureScale::of(record, &rows.starts);
    for one in rows.records() {
        let course = scale.and_then(|scale| TemperatureCourse::of_rows(record, one, scale));
        all.append(course.unwrap_or_default());
    }
    if scale.is_some() {
        rows.regressors = vec![all.temperature_k];
        rows.derived = vec![all.rate_k_per_h, all.hysteresis_k];
    }
    rows
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
