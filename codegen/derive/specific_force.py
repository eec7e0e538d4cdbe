"""Specific force in platform axes, equations (8) and (12): h1-h3."""

import casadi as ca

from frames import in_platform_axes


def specific_force(theta: ca.SX, f_0: ca.SX) -> ca.SX:
    """a = p_C_0 f_0 in g, up positive: what ideal accelerometers on the platform read.

    Equation (8) of the paper speaks of gravity; the sign here is that of specific force.
    """
    return in_platform_axes(theta, f_0)
