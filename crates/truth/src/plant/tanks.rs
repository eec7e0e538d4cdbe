//! Two tanks, one above the other: a pump fills the upper, its outflow the lower, whose level is measured by
//! a sensor that saturates. The upper tank overflows, in part into the lower one.

use super::run::{Moment, Multisine, run};
use super::{Facts, Run, Setting, Stream};

/// Facts: outflow of the upper tank, inflow and outflow of the lower, pump.
pub(super) const FACTS: Facts = Facts {
    name: "tanks",
    parameters: &[0.05, 0.05, 0.05, 0.04],
    spread: 1.08,
    initial: &[0.5, 0.5],
    mean: &[5.0, 5.0],
    sigmas: &[0.02],
    effects: &[
        ("upper_rate.above(upper)", -0.01),
        ("upper_rate.upper", -0.0005),
        ("lower_rate.bias", -0.002),
        ("lower_rate.lower", -0.0005),
        ("upper_rate.pump^2", 0.001),
        ("y.y^2", 0.005),
        ("y.bias", 0.2),
        ("k3.step", 0.002),
    ],
    step_s: 4.0,
    interpolate: false,
    simulate,
};

/// Height of the upper tank; its overflow is at a share of it.
const HEIGHT: f64 = 10.0;

/// The highest reading of the sensor.
const FULL: f64 = 10.0;

fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    let k: [f64; 4] = core::array::from_fn(|index| setting.parameters[index]);
    let pump = Multisine::new(&mut Stream::new(setting.seed, 1), 0.7, [3e-4, 1e-2]);
    let size = |effect| setting.size(effect);
    let root = |level: f64| libm::sqrt(level.max(0.0));
    let rates = |at: &Moment<'_, 2>| {
        let ([upper, lower], u) = (*at.state, at.input[0]);
        let out = k[2] + setting.step("k3.step", at.share);
        [
            k[3] * u - k[0] * root(upper)
                + size("upper_rate.above(upper)") * (upper - HEIGHT * setting.knee).max(0.0)
                + size("upper_rate.upper") * upper
                + size("upper_rate.pump^2") * u * u,
            k[1] * root(upper) - out * root(lower)
                + size("lower_rate.bias")
                + size("lower_rate.lower") * lower,
        ]
    };
    let outputs = |at: &Moment<'_, 2>| {
        let lower = at.state[1];
        vec![(lower + size("y.y^2") * lower * lower + size("y.bias")).min(FULL)]
    };
    let input = |time_s: f64, _: &[f64]| vec![(2.7 + pump.at(time_s)).max(0.3)];
    run(setting, rates, outputs, input, replayed)
}
