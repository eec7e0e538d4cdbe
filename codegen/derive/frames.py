"""Rotations between chart and platform, equation (4)."""

import casadi as ca


def rotation_x(angle: ca.SX) -> ca.SX:
    """Passive rotation about x: components of a fixed vector in the turned axes."""
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(1, 0, 0), ca.horzcat(0, c, s), ca.horzcat(0, -s, c))


def rotation_y(angle: ca.SX) -> ca.SX:
    """Passive rotation about y."""
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(c, 0, -s), ca.horzcat(0, 1, 0), ca.horzcat(s, 0, c))


def rotation_z(angle: ca.SX) -> ca.SX:
    """Passive rotation about z."""
    c, s = ca.cos(angle), ca.sin(angle)
    return ca.vertcat(ca.horzcat(c, s, 0), ca.horzcat(-s, c, 0), ca.horzcat(0, 0, 1))


def platform_c_chart(theta: ca.SX) -> ca.SX:
    """Direction cosine matrix p_C_0: platform components from chart components, (4)."""
    return rotation_z(theta[2]) @ rotation_y(theta[1]) @ rotation_x(theta[0])
