//! The size of a hidden effect in standard deviations: what it changes in the outputs that no change of
//! parameters and initial states takes up, over the noise. It is computed from differences of simulations,
//! by no code of a diagnosis.

use super::{Setting, simulate};

/// Relative change of a parameter for a difference.
const CHANGE: f64 = 1e-4;

/// Outputs over their noise, without noise, for given inputs.
fn outputs(setting: &Setting, inputs: &[Vec<f64>]) -> Vec<f64> {
    let quiet = Setting {
        noise: 0.0,
        ..setting.clone()
    };
    let run = simulate(&quiet, Some(inputs));
    let sigmas = setting.kind.facts().sigmas;
    let rows = run.outputs.iter();
    rows.flat_map(|row| row.iter().zip(sigmas).map(|(value, sigma)| value / sigma))
        .collect()
}

/// The size of the hidden effect of a setting in standard deviations of the noise.
#[must_use]
pub fn strength(setting: &Setting) -> f64 {
    let inputs = simulate(setting, None).inputs;
    let without = Setting {
        hidden: ("", 0.0),
        ..setting.clone()
    };
    let change = |by: f64, place: &dyn Fn(&mut Setting) -> &mut f64| -> Vec<f64> {
        let moved = [by, -by].map(|by| {
            let mut other = without.clone();
            *place(&mut other) += by;
            outputs(&other, &inputs)
        });
        let pairs = moved[0].iter().zip(&moved[1]);
        pairs.map(|(a, b)| (a - b) / (2.0 * by)).collect()
    };
    let parameters = setting.parameters.iter().enumerate();
    let parameters =
        parameters.map(|(i, size)| change(CHANGE * size, &|other| &mut other.parameters[i]));
    let initial = setting.kind.facts().initial.iter().enumerate();
    let initial = initial.map(|(i, size)| change(CHANGE * size, &|other| &mut other.initial[i]));
    // Gram and Schmidt, twice for rounding.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for mut column in parameters.chain(initial) {
        let whole = dot(&column, &column);
        for _ in 0..2 {
            project(&mut column, &basis);
        }
        let rest = dot(&column, &column);
        // Of a gauge only rounding is left.
        if rest > 1e-10 * whole && rest > 0.0 {
            let scale = 1.0 / libm::sqrt(rest);
            column.iter_mut().for_each(|value| *value *= scale);
            basis.push(column);
        }
    }
    let mut left = outputs(setting, &inputs);
    for (with, without) in left.iter_mut().zip(outputs(&without, &inputs)) {
        *with -= without;
    }
    project(&mut left, &basis);
    libm::sqrt(dot(&left, &left)) / setting.noise.max(f64::MIN_POSITIVE)
}

/// The setting with the hidden effect so large that it has this strength.
#[must_use]
pub fn with_strength(setting: &Setting, wanted: f64) -> Setting {
    let mut setting = setting.clone();
    for _ in 0..4 {
        let now = strength(&setting);
        // An effect with a threshold may not act at all at first.
        let factor = match now > 0.0 {
            true => (wanted / now).clamp(0.1, 10.0),
            false => 4.0,
        };
        setting.hidden.1 *= factor;
    }
    setting
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

/// Takes out of a vector its parts along unit vectors, one after the other.
fn project(vector: &mut [f64], units: &[Vec<f64>]) {
    for unit in units {
        let along = dot(vector, unit);
        for (value, unit) in vector.iter_mut().zip(unit) {
            *value -= along * unit;
        }
    }
}
