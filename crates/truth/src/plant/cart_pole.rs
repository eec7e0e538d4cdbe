//! A cart on a rail with a hanging pole; a force under feedback of the place of the cart.

use super::run::{Moment, Multisine, run};
use super::{Facts, Run, Setting, Stream};

/// Facts: friction of the cart over its mass, of the pole over its inertia, gain of the drive.
pub(super) const FACTS: Facts = Facts {
    name: "cart_pole_diagnosed",
    parameters: &[1.0, 0.15, 1.0],
    spread: 1.25,
    initial: &[0.1, 0.1, 0.1, 0.2],
    mean: &[0.0; 4],
    sigmas: &[0.001, 0.002],
    effects: &[
        ("speed_rate.sign(speed)", -0.05),
        ("spin_rate.spin|spin|", -0.02),
        ("speed_rate.bias", 0.02),
        ("spin_rate.bias", 0.05),
        ("speed_rate.place", -0.05),
        ("theta.bias", 0.01),
        ("b.step", 0.1),
        ("g.step", -0.05),
    ],
    step_s: 0.02,
    interpolate: false,
    simulate,
};

/// Masses, kg.
const CART: f64 = 1.0;
const POLE: f64 = 0.2;

/// Length of the pole, m.
const LENGTH: f64 = 0.5;

/// Gravity, m/s².
const GRAVITY: f64 = 9.81;

fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    let [friction, pole, gain] = core::array::from_fn(|index| setting.parameters[index]);
    let reference = Multisine::new(&mut Stream::new(setting.seed, 1), 2.0, [0.2, 2.0]);
    let size = |effect| setting.size(effect);
    let rates = |at: &Moment<'_, 4>| {
        let [place, angle, speed, spin] = *at.state;
        let force = (gain + setting.step("g.step", at.share)) * at.input[0]
            - (friction + setting.step("b.step", at.share)) * speed;
        let torque = -pole * POLE * LENGTH * LENGTH * spin;
        let (sine, cosine) = libm::sincos(angle);
        // Lagrange: the pole's mass is at its end and moves with the cart.
        let coupling = POLE * LENGTH * cosine;
        let inertia = POLE * LENGTH * LENGTH;
        let push = force + POLE * LENGTH * spin * spin * sine;
        let pull = torque - POLE * GRAVITY * LENGTH * sine;
        let determinant = (CART + POLE) * inertia - coupling * coupling;
        let cart = (inertia * push - coupling * pull) / determinant;
        let turn = ((CART + POLE) * pull - coupling * push) / determinant;
        [
            speed,
            spin,
            cart + size("speed_rate.sign(speed)") * libm::tanh(speed / 0.006)
                + size("speed_rate.bias")
                + size("speed_rate.place") * place,
            turn + size("spin_rate.spin|spin|") * spin * spin.abs() + size("spin_rate.bias"),
        ]
    };
    let outputs = |at: &Moment<'_, 4>| vec![at.state[0], at.state[1] + size("theta.bias")];
    let feedback = |time_s: f64, readings: &[f64]| vec![reference.at(time_s) - 4.0 * readings[0]];
    run(setting, rates, outputs, feedback, replayed)
}
