"""The drift law of a single-degree-of-freedom gyro, equations (1) and (2)."""

import casadi as ca

from specific_force import specific_force


def drift_rate(theta: ca.SX, drift: ca.SX, noise: ca.SX, f_0: ca.SX) -> ca.SX:
    """omega_d of the three gyros in deg/h: D_F + D_I a + D_II a^2 + epsilon.

    `a` is the specific force along the gyro's own input axis, which is the platform
    axis of the same name.
    """
    return drift_law(specific_force(theta, f_0), drift, noise)


def drift_law(a: ca.SX, drift: ca.SX, noise: ca.SX) -> ca.SX:
    """The same for specific force `a` along the input axes of the gyros."""
    coefficients = ca.reshape(drift, 3, 3).T
    bias, along, square = coefficients[:, 0], coefficients[:, 1], coefficients[:, 2]
    return bias + along * a + square * a**2 + noise
