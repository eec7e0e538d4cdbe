"""Functions for tests: slow, without shortcuts, exact."""

from casadi_program import Function, Output, Program, jacobian_output
from functions import AWAY_FROM_GIMBAL_LOCK
from layout import AXES, drift, drift_noise, f_0, omega_0, step, theta
from rk4_step import rk4_step


def program() -> Program:
    inputs = [theta, drift, drift_noise, omega_0, f_0, step]
    value = Output(
        "theta_next", rk4_step(*[group.sx for group in inputs[:-1]], step["dt"]), "rad",
        "platform angles at the end of the step", [f"theta_{i}" for i in AXES],
    )
    jacobians = [
        jacobian_output(value, group, f"theta_next_d_{group.name}",
                        f"exact Jacobian of the discrete map with respect to `{group.name}`", unit)
        for group, unit in (
            (theta, "1"),
            (drift, "rad per unit of the coefficient"),
            (drift_noise, "rad per deg/h"),
        )
    ]
    return Program(
        "oracle",
        "Oracles for tests: the RK4 step written out, with its exact discrete Jacobian.",
        [
            Function(
                "rk4_step_jacobian",
                "One RK4 step of the platform angles with its exact discrete Jacobian.",
                "classical Runge-Kutta on equations (7) and (9)",
                inputs, [value, *jacobians], AWAY_FROM_GIMBAL_LOCK,
            )
        ],
    )
