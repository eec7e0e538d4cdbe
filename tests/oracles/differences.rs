//! Generated Jacobians against sixth-order central differences of the value functions.

use gyrocal_oracle::compare::{Comparison, Tolerance};
use gyrocal_oracle::difference;
use gyrocal_oracle::points::{Purpose, State, states};

use crate::derivatives::{By, Derivative, derivatives};
use crate::{STATES, hold, named, programs};

/// Truncation at the corner of the range, θy = ±80°, where the pole of 1/cos θy is 0.17 rad
/// away, is 36 (2^-10 / 0.17)⁶ = 1e-12 of an entry, and some tens of that through the stages
/// of RK4, which come nearer to the pole. Rounding of angles near 1 rad is more than 1e-9 of
/// a column of drift only where that column nearly vanishes, with the specific force in it.
pub(crate) const NUMERIC: Tolerance = Tolerance {
    relative: 1e-9,
    ill_conditioned_share: 0.01,
};

/// Step of each variable, in its unit.
pub(crate) fn steps(derivative: &Derivative, state: &State) -> Vec<f64> {
    let mut steps = vec![step(derivative, state); derivative.places(state).len()];
    if matches!(derivative.by, By::Group(name) if name.ends_with("::parameters")) {
        // Effects: polynomials of their parameters, and for latitude in degrees sine and cosine,
        // 1e-12 beyond the sixth order.
        steps[9..].fill(0.5);
    }
    steps
}

fn step(derivative: &Derivative, state: &State) -> f64 {
    let drift = || {
        if derivative.of.groups.contains(&"step") {
            // Values are angles near 1 rad and derivatives grow with the length of the step:
            // the change of the angle, at most 40 deg/h · s · 5.8 = 1.1e-3 rad, is what counts.
            40.0 / state.step[0]
        } else {
            // Rates are linear in the drift: no truncation, the size of the drifts will do.
            4.0
        }
    };
    match derivative.by {
        By::Group("theta" | "origin") => 1.0 / 1024.0,
        By::Group("f_0") => 0.25,
        By::Group("drift" | "drift_noise") | By::Bias => drift(),
        By::Group(name) if name.ends_with("::parameters") => drift(),
        By::Group(other) => panic!("no step for {other}"),
    }
}

#[test]
fn generated_jacobians_agree_with_differences() {
    let states = states(Purpose::Difference, STATES);
    let programs = programs();
    let comparisons = derivatives().into_iter().map(|derivative| {
        let name = derivative.function.name;
        let program = named(&programs, name);
        let index = derivative.place(program);
        let mut comparison = Comparison::new(name, &program.outputs[index], NUMERIC);
        for (point, state) in states.iter().enumerate() {
            let value = (derivative.function.double)(&derivative.function.inputs(state));
            let (inputs, places) = (derivative.of.inputs(state), derivative.places(state));
            let steps = steps(&derivative, state);
            let expected = difference::jacobian(derivative.of.double, &inputs, &places, &steps);
            let rounding = difference::rounding(&derivative.of.rounding(&inputs), &steps);
            let value = program.dense_outputs(&value, 0.0).swap_remove(index);
            comparison.add(point, &value, &expected, &rounding);
        }
        comparison
    });
    hold(comparisons);
}
