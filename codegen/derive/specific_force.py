"""Specific force in platform axes, equations (8) and (12): h1-h3."""

import casadi as ca

from frames import platform_c_chart


def specific_force(theta: ca.SX, f_0: ca.SX) -> ca.SX:
    """a = p_C_0 f_0 in g, up positive: outputs of ideal accelerometers on the platform.

    Equation (8) of the paper has gravity; the sign here is that of specific force.
    """
    return platform_c_chart(theta) @ f_0
