"""The paper's discretisation, equations (14) and (15): one explicit Euler step."""

import casadi as ca

from kinematics import angle_rates


def euler_step(theta, drift, noise, omega_0, f_0, dt) -> ca.SX:
    """theta(k+1) = theta(k) + f dt."""
    return theta + dt * angle_rates(theta, drift, noise, omega_0, f_0)
