//! Roll, pitch and yaw of a quadrotor, held by feedback of its angles and the rates of its gyros.

use super::run::{Moment, Multisine, run};
use super::{Facts, Run, Setting, Stream};

/// Facts: gains of the three torques over inertia, damping of the three rates, coupling by the inertia.
pub(super) const FACTS: Facts = Facts {
    name: "quadrotor_diagnosed",
    parameters: &[40.0, 40.0, 8.0, 0.6, 0.6, 0.3, 0.7],
    spread: 1.25,
    initial: &[0.05, 0.05, 0.2, 0.1, 0.1, 0.1],
    mean: &[0.0; 6],
    sigmas: &[0.002, 0.002, 0.004, 0.01, 0.01, 0.01],
    effects: &[
        ("roll.drag", -0.1),
        ("pitch.drag", -0.1),
        ("p_rate.bias", 0.2),
        ("q_rate.bias", 0.2),
        ("roll.mixing", 1.0),
        ("gyro_p.bias", 0.02),
        ("gyro_r.bias", 0.02),
        ("l.step", -2.0),
    ],
    step_s: 0.02,
    interpolate: false,
    simulate,
};

fn simulate(setting: &Setting, replayed: Option<&[Vec<f64>]>) -> Run {
    let k: [f64; 7] = core::array::from_fn(|index| setting.parameters[index]);
    let mut random = Stream::new(setting.seed, 1);
    let wanted: [Multisine; 3] =
        core::array::from_fn(|_| Multisine::new(&mut random, 0.2, [0.1, 1.5]));
    let size = |effect| setting.size(effect);
    let rates = |at: &Moment<'_, 6>| {
        let [roll, pitch, _, p, q, r] = *at.state;
        let u = at.input;
        let ((sr, cr), (sp, cp)) = (libm::sincos(roll), libm::sincos(pitch));
        let turn = (sr * q + cr * r) / cp;
        [
            p + turn * sp,
            cr * q - sr * r,
            turn,
            (k[0] + setting.step("l.step", at.share)) * u[0] - k[3] * p
                + k[6] * q * r
                + size("roll.drag") * p * p.abs()
                + size("roll.mixing") * u[1]
                + size("p_rate.bias"),
            k[1] * u[1] - k[4] * q - k[6] * p * r
                + size("pitch.drag") * q * q.abs()
                + size("q_rate.bias"),
            k[2] * u[2] - k[5] * r,
        ]
    };
    let outputs = |at: &Moment<'_, 6>| {
        let mut readings = at.state.to_vec();
        readings[3] += size("gyro_p.bias");
        readings[5] += size("gyro_r.bias");
        readings
    };
    let feedback = |time_s: f64, readings: &[f64]| {
        let torque = |axis: usize| {
            let off = wanted[axis].at(time_s) - readings[axis];
            let gain = 40.0 / [40.0, 40.0, 8.0][axis];
            gain * (0.5 * off - 0.12 * readings[axis + 3])
        };
        (0..3).map(torque).collect()
    };
    run(setting, rates, outputs, feedback, replayed)
}
