//! An axis with a motor and an encoder that follows a reference under feedback.

use super::run::{Moment, Multisine, run};
use super::{Facts, Run, Setting, Stream};

/// Facts: gain of the motor and viscous friction over inertia.
pub(super) const FACTS: Facts = Facts {
    name: "servo",
    parameters: &[30.0, 4.0],
    spread: 1.25,
    initial: &[0.2, 0.5],
    mean: &[0.0, 0.0],
    sigmas: &[0.002],
    effects: &[
        ("rate_rate.sign(rate)", -0.3),
        ("rate_rate.rate|rate|", -0.05),
        ("rate_rate.bias", 0.1),
        ("rate_rate.angle", -0.2),
        ("rate_rate.drive^3", -0.1),
        ("y.lag", 0.001),
        ("a.step", -1.0),
        ("b.step", 0.5),
        ("drive.play", 0.02),
    ],
    step_s: 0.02,
    interpolate: false,
    simulate,
};

/// Width of the change of sign of dry friction, rad/s.
const STICTION: f64 = 0.02;

fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    let [gain, viscous] = [0, 1].map(|index| setting.parameters[index]);
    let reference = Multisine::new(&mut Stream::new(setting.seed, 1), 0.8, [0.1, 1.5]);
    let size = |effect| setting.size(effect);
    // What no catalogue has: a gain that fades, or has waves; a reference that is held.
    let gain_at = |share: f64| {
        let wave = libm::sin(9.0 * core::f64::consts::TAU * share);
        gain * (1.0 - size("a.fade") * share + size("a.wave") * wave)
    };
    let held_s = size("feedback.same_row");
    let reference_at = |time_s: f64| match held_s > 0.0 {
        true => reference.at(libm::floor(time_s / held_s) * held_s),
        false => reference.at(time_s),
    };
    let rates = |at: &Moment<'_, 2>| {
        let ([angle, rate], drive) = (*at.state, at.input[0]);
        let motor = (gain_at(at.share) + setting.step("a.step", at.share)) * drive;
        let friction = (viscous + setting.step("b.step", at.share)) * rate;
        let extra = size("rate_rate.sign(rate)") * libm::tanh(rate / STICTION)
            + size("rate_rate.rate|rate|") * rate * rate.abs()
            + size("rate_rate.bias")
            + size("rate_rate.angle") * angle
            + size("rate_rate.drive^3") * drive * drive * drive;
        [rate, motor - friction + extra]
    };
    let outputs = |at: &Moment<'_, 2>| {
        let [angle, rate] = *at.state;
        let lag_s = size("y.lag");
        vec![angle - lag_s * rate + 0.5 * lag_s * lag_s * rates(at)[1]]
    };
    let feedback = |time_s: f64, readings: &[f64]| vec![2.0 * (reference_at(time_s) - readings[0])];
    run(setting, rates, outputs, feedback, replayed)
}
