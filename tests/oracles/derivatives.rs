//! What each Jacobian is the derivative of, and the proof that none is left out.

use gyrocal_oracle::points::State;

use crate::callable::Callable;
use crate::functions::{function, generated};
use crate::hand_written::hand_written;
use crate::programs;

/// An output that is a derivative.
pub(crate) struct Derivative {
    /// The generated function that returns it.
    pub(crate) function: Callable,
    /// Name of the output.
    pub(crate) output: &'static str,
    /// The function that it is the derivative of.
    pub(crate) of: Callable,
    /// With respect to what.
    pub(crate) by: By,
}

/// What a derivative is taken with respect to.
#[derive(Clone, Copy)]
pub(crate) enum By {
    /// All scalars of a group of inputs.
    Group(&'static str),
    /// The drift noise of a function that does not take it (noise is zero there): it enters
    /// exactly as the drift at zero specific force does, equation (1).
    Bias,
}

/// function, output, what it is the derivative of, with respect to what.
#[rustfmt::skip] // a table
const DERIVATIVES: [(&str, &str, &str, By); 18] = [
    // C f_0 is linear in f_0, and the rate matrix turns angle rates into a rotation rate.
    ("reanchor", "platform_c_chart", "specific_force", By::Group("f_0")),
    ("reanchor", "rotation_d_theta", "rotation_from", By::Group("theta")),
    ("drift_rate_jacobian", "omega_d_d_theta", "drift_rate", By::Group("theta")),
    ("drift_rate_jacobian", "omega_d_d_drift", "drift_rate", By::Group("drift")),
    ("dynamics_jacobian", "theta_dot_d_theta", "dynamics", By::Group("theta")),
    ("dynamics_jacobian", "theta_dot_d_drift", "dynamics", By::Group("drift")),
    ("dynamics_jacobian", "theta_dot_d_drift_noise", "dynamics", By::Bias),
    ("dynamics_at_origin_jacobian", "theta_dot_d_theta", "dynamics_from_origin", By::Group("origin")),
    ("dynamics_at_origin_jacobian", "theta_dot_d_drift", "dynamics_from_origin", By::Group("drift")),
    ("dynamics_at_origin_jacobian", "theta_dot_d_drift_noise", "dynamics_from_origin", By::Bias),
    ("specific_force_jacobian", "specific_force_d_theta", "specific_force", By::Group("theta")),
    ("specific_force_at_origin_jacobian", "specific_force_d_theta", "specific_force_from_origin", By::Group("origin")),
    ("euler_step_jacobian", "theta_next_d_theta", "euler_step", By::Group("theta")),
    ("euler_step_jacobian", "theta_next_d_drift", "euler_step", By::Group("drift")),
    ("euler_step_jacobian", "theta_next_d_drift_noise", "euler_step", By::Bias),
    ("rk4_step_jacobian", "theta_next_d_theta", "rk4_step", By::Group("theta")),
    ("rk4_step_jacobian", "theta_next_d_drift", "rk4_step", By::Group("drift")),
    ("rk4_step_jacobian", "theta_next_d_drift_noise", "rk4_step", By::Group("drift_noise")),
];

/// function, output, and the function whose value it repeats.
#[rustfmt::skip] // a table
pub(crate) const VALUES: [(&str, &str, &str); 7] = [
    ("drift_rate_jacobian", "omega_d", "drift_rate"),
    ("dynamics_jacobian", "theta_dot", "dynamics"),
    ("dynamics_at_origin_jacobian", "theta_dot", "dynamics_from_origin"),
    ("specific_force_jacobian", "specific_force", "specific_force"),
    ("specific_force_at_origin_jacobian", "specific_force", "specific_force_from_origin"),
    ("euler_step_jacobian", "theta_next", "euler_step"),
    ("rk4_step_jacobian", "theta_next", "rk4_step"),
];

/// All derivatives.
pub(crate) fn derivatives() -> Vec<Derivative> {
    DERIVATIVES
        .iter()
        .map(|&(name, output, of, by)| Derivative {
            function: function(name),
            output,
            of: value_function(of),
            by,
        })
        .collect()
}

/// The generated or hand-written function called `name`.
pub(crate) fn value_function(name: &str) -> Callable {
    let mut all = generated().into_iter().chain(hand_written());
    all.find(|function| function.name == name).expect(name)
}

impl Derivative {
    /// Places of the variables in the inputs of the function that is differentiated.
    pub(crate) fn places(&self, state: &State) -> Vec<usize> {
        match self.by {
            By::Group(group) => self.of.places(group, state),
            By::Bias => self
                .of
                .places("drift", state)
                .into_iter()
                .step_by(3)
                .collect(),
        }
    }
}

#[test]
fn every_jacobian_of_every_program_is_compared() {
    let of_programs = programs().into_iter().flat_map(|program| program.functions);
    let outputs: Vec<(String, String)> = of_programs
        .flat_map(|f| {
            f.outputs
                .into_iter()
                .map(move |output| (f.name.clone(), output))
        })
        // A function that returns nothing but a vector is a value; it has oracles of its own.
        .filter(|(name, output)| output.columns > 1 || name.ends_with("_jacobian"))
        .map(|(name, output)| (name, output.name))
        .collect();
    let listed = DERIVATIVES
        .iter()
        .map(|&(function, output, ..)| (function, output));
    let mut listed: Vec<(String, String)> = listed
        .chain(
            VALUES
                .iter()
                .map(|&(function, output, _)| (function, output)),
        )
        .map(|(function, output)| (function.to_owned(), output.to_owned()))
        .collect();
    listed.sort();
    let mut outputs = outputs;
    outputs.sort();
    assert_eq!(
        listed, outputs,
        "add what is missing to the tables of this file"
    );
}
