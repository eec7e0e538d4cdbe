//! A mass on a spring, driven by a known force.

use super::run::{Moment, Multisine, run};
use super::{Facts, Run, Setting, Stream};

/// Facts: stiffness, damping and gain of the drive over mass.
pub(super) const FACTS: Facts = Facts {
    name: "duffing",
    parameters: &[4.2, 0.3, 1.1],
    spread: 1.25,
    initial: &[0.5, 1.0],
    mean: &[0.0, 0.0],
    sigmas: &[0.01],
    effects: &[
        ("v_rate.x^3", -0.02),
        ("v_rate.x^2", 0.02),
        ("v_rate.v|v|", -0.02),
        ("v_rate.bias", 0.02),
        ("v_rate.x u", 0.02),
        ("y.y^2", 0.01),
        ("y.lag", 0.01),
        ("k.step", 0.05),
    ],
    step_s: 0.05,
    interpolate: true,
    simulate,
};

/// A usual displacement, m.
const TYPICAL: f64 = 1.0;

fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    let [stiffness, damping, gain] = core::array::from_fn(|index| setting.parameters[index]);
    let drive = Multisine::new(&mut Stream::new(setting.seed, 1), 1.6, [0.05, 0.8]);
    let size = |effect| setting.size(effect);
    let rates = |at: &Moment<'_, 2>| {
        let ([x, v], u) = (*at.state, at.input[0]);
        let spring = (stiffness + setting.step("k.step", at.share)) * x;
        let extra = size("v_rate.x^3") * x * x * x
            + size("v_rate.x^2") * x * x
            + size("v_rate.v|v|") * v * v.abs()
            + size("v_rate.x u") * x * u
            + size("v_rate.above(x)") * (x - TYPICAL * setting.knee).max(0.0)
            + size("v_rate.beyond(x)") * (x.abs() - TYPICAL * setting.knee).max(0.0).copysign(x)
            + size("v_rate.bias");
        [v, gain * u - spring - damping * v + extra]
    };
    let outputs = |at: &Moment<'_, 2>| {
        let [x, v] = *at.state;
        // A late sensor reads the past.
        let lag_s = size("y.lag");
        let past = x - lag_s * v + 0.5 * lag_s * lag_s * rates(at)[1];
        vec![past + size("y.y^2") * x * x]
    };
    let input = |time_s: f64, _: &[f64]| vec![drive.at(time_s)];
    run(setting, rates, outputs, input, replayed)
}
