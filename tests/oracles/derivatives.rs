//! The function of which each Jacobian is the derivative, and a check that the list is complete.

use gyrocal_oracle::points::State;
use gyrocal_oracle::program::Function;

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
    /// Variables of the derivative.
    pub(crate) by: By,
}

/// Variables of a derivative.
#[derive(Clone, Copy)]
pub(crate) enum By {
    /// All scalars of a group of inputs.
    Group(&'static str),
    /// The drift noise of a function that does not take it (noise is zero there): it enters
    /// exactly as the drift at zero specific force does, equation (1).
    Bias,
}

/// Function, output, differentiated function, variables.
#[rustfmt::skip] // a table
const NOMINAL: [(&str, &str, &str, By); 18] = [
    // C f_0 is linear in f_0, and the rate matrix turns angle rates into a rotation rate.
    ("platform::reanchor", "platform_c_chart", "platform::specific_force", By::Group("f_0")),
    ("platform::reanchor", "rotation_d_theta", "rotation_from", By::Group("theta")),
    ("platform::drift_rate_jacobian", "omega_d_d_theta", "platform::drift_rate", By::Group("theta")),
    ("platform::drift_rate_jacobian", "omega_d_d_drift", "platform::drift_rate", By::Group("drift")),
    ("platform::dynamics_jacobian", "theta_dot_d_theta", "platform::dynamics", By::Group("theta")),
    ("platform::dynamics_jacobian", "theta_dot_d_drift", "platform::dynamics", By::Group("drift")),
    ("platform::dynamics_jacobian", "theta_dot_d_drift_noise", "platform::dynamics", By::Bias),
    ("platform::dynamics_at_origin_jacobian", "theta_dot_d_theta", "dynamics_from_origin", By::Group("origin")),
    ("platform::dynamics_at_origin_jacobian", "theta_dot_d_drift", "dynamics_from_origin", By::Group("drift")),
    ("platform::dynamics_at_origin_jacobian", "theta_dot_d_drift_noise", "dynamics_from_origin", By::Bias),
    ("platform::specific_force_jacobian", "specific_force_d_theta", "platform::specific_force", By::Group("theta")),
    ("platform::specific_force_at_origin_jacobian", "specific_force_d_theta", "specific_force_from_origin", By::Group("origin")),
    ("platform::euler_step_jacobian", "theta_next_d_theta", "platform::euler_step", By::Group("theta")),
    ("platform::euler_step_jacobian", "theta_next_d_drift", "platform::euler_step", By::Group("drift")),
    ("platform::euler_step_jacobian", "theta_next_d_drift_noise", "platform::euler_step", By::Bias),
    ("oracle::rk4_step_jacobian", "theta_next_d_theta", "rk4_step", By::Group("theta")),
    ("oracle::rk4_step_jacobian", "theta_next_d_drift", "rk4_step", By::Group("drift")),
    ("oracle::rk4_step_jacobian", "theta_next_d_drift_noise", "rk4_step", By::Group("drift_noise")),
];

/// function, output, and the function whose value it repeats.
#[rustfmt::skip] // a table
const NOMINAL_VALUES: [(&str, &str, &str); 7] = [
    ("platform::drift_rate_jacobian", "omega_d", "platform::drift_rate"),
    ("platform::dynamics_jacobian", "theta_dot", "platform::dynamics"),
    ("platform::dynamics_at_origin_jacobian", "theta_dot", "dynamics_from_origin"),
    ("platform::specific_force_jacobian", "specific_force", "platform::specific_force"),
    ("platform::specific_force_at_origin_jacobian", "specific_force", "specific_force_from_origin"),
    ("platform::euler_step_jacobian", "theta_next", "platform::euler_step"),
    ("oracle::rk4_step_jacobian", "theta_next", "rk4_step"),
];

/// The same two tables for a module with an extended model.
macro_rules! extended {
    ($module:literal) => {{
        const DYNAMICS: &str = concat!($module, "::dynamics_jacobian");
        const AT_ORIGIN: &str = concat!($module, "::dynamics_at_origin_jacobian");
        const READING: &str = concat!($module, "::accelerometers_jacobian");
        const READING_AT_ORIGIN: &str = concat!($module, "::accelerometers_at_origin_jacobian");
        const OF: &str = concat!($module, "::dynamics");
        const OF_AT_ORIGIN: &str = concat!($module, "::dynamics_from_origin");
        const READ: &str = concat!($module, "::accelerometers");
        const READ_AT_ORIGIN: &str = concat!($module, "::accelerometers_from_origin");
        const PARAMETERS: By = By::Group(concat!($module, "::parameters"));
        (
            [
                (DYNAMICS, "theta_dot_d_theta", OF, By::Group("theta")),
                (DYNAMICS, "theta_dot_d_parameters", OF, PARAMETERS),
                (DYNAMICS, "theta_dot_d_drift_noise", OF, By::Bias),
                (
                    AT_ORIGIN,
                    "theta_dot_d_theta",
                    OF_AT_ORIGIN,
                    By::Group("origin"),
                ),
                (
                    AT_ORIGIN,
                    "theta_dot_d_parameters",
                    OF_AT_ORIGIN,
                    PARAMETERS,
                ),
                (AT_ORIGIN, "theta_dot_d_drift_noise", OF_AT_ORIGIN, By::Bias),
                (READING, "reading_d_theta", READ, By::Group("theta")),
                (READING, "reading_d_parameters", READ, PARAMETERS),
                (
                    READING_AT_ORIGIN,
                    "reading_d_theta",
                    READ_AT_ORIGIN,
                    By::Group("origin"),
                ),
                (
                    READING_AT_ORIGIN,
                    "reading_d_parameters",
                    READ_AT_ORIGIN,
                    PARAMETERS,
                ),
            ],
            [
                (DYNAMICS, "theta_dot", OF),
                (AT_ORIGIN, "theta_dot", OF_AT_ORIGIN),
                (READING, "reading", READ),
                (READING_AT_ORIGIN, "reading", READ_AT_ORIGIN),
            ],
        )
    }};
}

/// Function, output, differentiated function, variables.
fn table() -> Vec<(&'static str, &'static str, &'static str, By)> {
    let extended = [
        extended!("surveyed").0,
        extended!("strapdown").0,
        extended!("catalogue").0,
        extended!("strapdown_catalogue").0,
    ]
    .concat();
    [&NOMINAL[..], &extended].concat()
}

/// function, output, and the function whose value it repeats.
pub(crate) fn values() -> Vec<(&'static str, &'static str, &'static str)> {
    let extended = [
        extended!("surveyed").1,
        extended!("strapdown").1,
        extended!("catalogue").1,
        extended!("strapdown_catalogue").1,
    ]
    .concat();
    [&NOMINAL_VALUES[..], &extended].concat()
}

/// All derivatives.
pub(crate) fn derivatives() -> Vec<Derivative> {
    table()
        .into_iter()
        .map(|(name, output, of, by)| Derivative {
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
    /// Its place among the outputs of the function that returns it.
    pub(crate) fn place(&self, function: &Function) -> usize {
        let mut outputs = function.outputs.iter();
        outputs.position(|o| o.name == self.output).unwrap()
    }

    /// Places of the variables in the inputs of the function that is differentiated.
    pub(crate) fn places(&self, state: &State) -> Vec<usize> {
        match self.by {
            By::Group(group) => self.of.places(group, state),
            By::Bias => {
                let groups = self.of.groups.iter();
                let is_drift = |name: &&&str| **name == "drift" || name.ends_with("::parameters");
                let drift = groups.copied().find(|name| is_drift(&name)).expect("drift");
                let nine = self.of.places(drift, state).into_iter().take(9);
                nine.step_by(3).collect()
            }
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
        // A function that returns only a vector is a value; it has its own oracles.
        .filter(|(name, output)| output.columns > 1 || name.ends_with("_jacobian"))
        .map(|(name, output)| (name, output.name))
        .collect();
    let listed = table()
        .into_iter()
        .map(|(function, output, ..)| (function, output));
    let mut listed: Vec<(String, String)> = listed
        .chain(
            values()
                .into_iter()
                .map(|(function, output, _)| (function, output)),
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
