"""Platform kinematics, equations (5) to (7) and (9): f1-f3."""

import math

import casadi as ca

from drift import drift_rate
from frames import platform_c_chart

DEG_PER_HOUR_IN_RAD_PER_S = math.pi / 180 / 3600


def rate_matrix(theta: ca.SX) -> ca.SX:
    """W of equation (6): rate relative to the chart, in platform axes, from angle rates."""
    cy, sy = ca.cos(theta[1]), ca.sin(theta[1])
    cz, sz = ca.cos(theta[2]), ca.sin(theta[2])
    return ca.vertcat(
        ca.horzcat(cy * cz, sz, 0),
        ca.horzcat(-cy * sz, cz, 0),
        ca.horzcat(sy, 0, 1),
    )


def rate_matrix_inverse(theta: ca.SX) -> ca.SX:
    """W^-1 in closed form; singular at theta_y = +-90 deg (gimbal lock of the chart)."""
    cy, sy = ca.cos(theta[1]), ca.sin(theta[1])
    cz, sz = ca.cos(theta[2]), ca.sin(theta[2])
    return ca.vertcat(
        ca.horzcat(cz / cy, -sz / cy, 0),
        ca.horzcat(sz, cz, 0),
        ca.horzcat(-sy * cz / cy, sy * sz / cy, 1),
    )


def angle_rates(theta: ca.SX, drift: ca.SX, noise: ca.SX, omega_0: ca.SX, f_0: ca.SX) -> ca.SX:
    """f1-f3: W^-1 (omega_d - p_C_0 omega_0), equations (7) and (9), in rad/s.

    The platform is held to its gyros, so its inertial rate is the gyro drift. Its rate relative to
    the chart is the drift less Earth rate.
    """
    return angle_rates_of(theta, drift_rate(theta, drift, noise, f_0), omega_0)


def angle_rates_of(theta: ca.SX, omega_d: ca.SX, omega_0: ca.SX) -> ca.SX:
    """W^-1 (omega_d - p_C_0 omega_0) in rad/s, for any drift omega_d in deg/h."""
    return rate_matrix_inverse(theta) @ relative_rate(omega_d, platform_c_chart(theta) @ omega_0)


def relative_rate(omega_d: ca.SX, omega: ca.SX) -> ca.SX:
    """Rate relative to the chart, of drift in deg/h and Earth rate in rad/s, in platform axes."""
    return DEG_PER_HOUR_IN_RAD_PER_S * omega_d - omega
