"""The functions of a filter of the platform, and its model."""

import casadi as ca

import layout
from casadi_program import Function, Output, Program
from drift import drift_rate
from euler_step import euler_step
from frames import platform_c_chart
from functions import AWAY_FROM_GIMBAL_LOCK, at_origin, with_jacobian
from kinematics import angle_rates, rate_matrix
from layout import AXES, drift, drift_noise, f_0, omega_0, step, theta
from nodal import angle_rates_with_jacobians
from specific_force import specific_force


def program() -> Program:
    angles, chart = theta.sx, (omega_0.sx, f_0.sx)
    rates = Output(
        "theta_dot", angle_rates(angles, drift.sx, drift_noise.sx, *chart), "rad/s",
        "rates of the platform angles", [f"theta_dot_{i}" for i in AXES],
    )
    force = Output(
        "specific_force", specific_force(angles, f_0.sx), "g",
        "specific force along the platform axes, up positive", [f"a_{i}" for i in AXES],
    )
    drift_of_gyros = Output(
        "omega_d", drift_rate(angles, drift.sx, drift_noise.sx, f_0.sx), "deg/h",
        "drift of the gyros about their input axes", [f"omega_d_{i}" for i in AXES],
    )
    euler = Output(
        "theta_next", euler_step(angles, drift.sx, drift_noise.sx, *chart, step["dt"]), "rad",
        "platform angles at the end of the step", [f"theta_{i}" for i in AXES],
    )
    rotation = Output(
        "platform_c_chart", platform_c_chart(angles), "1",
        "direction cosine matrix: platform components from chart components",
        [f"platform_{i}" for i in AXES], [f"chart_{i}" for i in AXES],
    )
    rate_map = Output(
        "rotation_d_theta", ca.sparsify(rate_matrix(angles)), "1",
        "W: small rotation in platform axes from small changes of the angles",
        [f"rotation_{i}" for i in AXES], theta.names,
    )
    functions = [
        Function(
            "reanchor", "Direction cosine matrix and rate matrix W, for moving the chart onto "
            "the platform.", "equations (4) and (6)", [theta], [rotation, rate_map],
        ),
        *with_jacobian(
            "drift_rate", "Drift of the three gyros, D_F + D_I a + D_II a^2.",
            "equations (1) and (2)", [theta, drift, f_0], drift_of_gyros,
            [(theta, "deg/h/rad"), (drift, "deg/h per unit of the coefficient")],
            "all finite inputs",
        ),
        *with_jacobian(
            "dynamics", "Rates of the platform angles under Earth rate and gyro drift: f1-f3.",
            "equations (7) and (9)", [theta, drift, omega_0, f_0], rates,
            [(theta, "1/s"), (drift, "rad/s per unit of the coefficient"),
             (drift_noise, "rad/s per deg/h")],
            AWAY_FROM_GIMBAL_LOCK,
            shorter=angle_rates_with_jacobians(angles, drift.sx, drift_noise.sx, *chart),
        ),
        *with_jacobian(
            "specific_force", "Outputs of ideal accelerometers: h1-h3.",
            "equations (8) and (12)", [theta, f_0], force, [(theta, "g/rad")],
            "all finite inputs",
        ),
        *with_jacobian(
            "euler_step", "One explicit Euler step of the platform angles.",
            "equations (14) and (15)", [theta, drift, omega_0, f_0, step], euler,
            [(theta, "1"), (drift, "rad per unit of the coefficient"),
             (drift_noise, "rad per deg/h")],
            AWAY_FROM_GIMBAL_LOCK,
        ),
    ]
    by_name = {function.name: function for function in functions}
    functions += [
        at_origin(
            "dynamics_at_origin_jacobian",
            "Rates of the platform angles, with their exact Jacobians, at zero angles.",
            by_name["dynamics_jacobian"],
        ),
        at_origin(
            "specific_force_at_origin_jacobian",
            "Outputs of ideal accelerometers, with the exact Jacobian, at zero angles.",
            by_name["specific_force_jacobian"],
        ),
    ]
    return Program(
        "platform",
        "Inertially stabilised platform on a static base, held to three drifting gyros.",
        functions,
        {
            "name": "Platform",
            "doc": "The nominal platform: three angles move, nine drift coefficients are constant.",
            "moving": layout.theta.name,
            "flat": False,  # Anchored moves the chart of the angles
            "parameters": layout.drift.name,
            "noise": layout.drift_noise.name,
            "inputs": [layout.omega_0.name, layout.f_0.name],
            "rates": {
                "value": "dynamics",
                "jacobian": "dynamics_jacobian",
                "jacobian_at_origin": "dynamics_at_origin_jacobian",
            },
            "output": {
                "value": "specific_force",
                "jacobian": "specific_force_jacobian",
                "jacobian_at_origin": "specific_force_at_origin_jacobian",
            },
        },
    )
