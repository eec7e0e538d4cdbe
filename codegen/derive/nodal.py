"""f1-f3 with their Jacobians in few operations, in nodal axes, which are rotated about x and y but
not about z.

In these axes Earth rate is not rotated about z, W is sparse, and the sine and cosine of z enter
with the drift alone. Rates and Jacobians equal those of kinematics.py, with fewer operations than
its matrices and their differentiation.
"""

import casadi as ca

from drift import drift_law
from frames import rotation_x, rotation_y, rotation_z
from kinematics import DEG_PER_HOUR_IN_RAD_PER_S


def nodal(theta: ca.SX, vector: ca.SX) -> ca.SX:
    """Nodal components of a vector that is fixed in the chart: one rotation after the other."""
    return rotation_y(theta[1]) @ (rotation_x(theta[0]) @ vector)


def nodal_from_platform(theta: ca.SX, columns: ca.SX) -> ca.SX:
    """Nodal components from platform components."""
    return rotation_z(theta[2]).T @ columns


def nodal_from_platform_both_sides(theta: ca.SX, matrix: ca.SX) -> ca.SX:
    """Rz' J Rz: a Jacobian in platform axes as one in nodal axes."""
    c, s = ca.cos(theta[2]), ca.sin(theta[2])
    difference, sum_ = matrix[0, 0] - matrix[1, 1], matrix[0, 1] + matrix[1, 0]
    diagonal = s * s * difference + c * s * sum_
    skewed = c * s * difference - s * s * sum_
    return ca.vertcat(
        ca.horzcat(matrix[0, 0] - diagonal, matrix[0, 1] + skewed,
                   c * matrix[0, 2] - s * matrix[1, 2]),
        ca.horzcat(matrix[1, 0] + skewed, matrix[1, 1] + diagonal,
                   s * matrix[0, 2] + c * matrix[1, 2]),
        ca.horzcat(c * matrix[2, 0] - s * matrix[2, 1], s * matrix[2, 0] + c * matrix[2, 1],
                   matrix[2, 2]),
    )


def nodal_rate_matrix(theta: ca.SX) -> ca.SX:
    """W of equation (6) in nodal axes."""
    cy, sy = ca.cos(theta[1]), ca.sin(theta[1])
    return ca.vertcat(ca.horzcat(cy, 0, 0), ca.horzcat(0, 1, 0), ca.horzcat(sy, 0, 1))


def angle_rates_from_nodal(theta: ca.SX, rate: ca.SX) -> ca.SX:
    """Its inverse applied to columns."""
    x = rate[0, :] / ca.cos(theta[1])
    return ca.vertcat(x, rate[1, :], rate[2, :] - ca.sin(theta[1]) * x)


def angle_rates_with_jacobians(theta: ca.SX, drift: ca.SX, noise: ca.SX, omega_0: ca.SX,
                               f_0: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX, ca.SX]:
    """`kinematics.angle_rates`, and its Jacobians by angles, drift coefficients and noise.

    In axes that rotate by dphi = W dtheta, a fixed vector v changes by v x dphi; and
    W theta_dot = relative rate is differentiated directly.
    """
    force, omega, w = nodal(theta, f_0), nodal(theta, omega_0), nodal_rate_matrix(theta)
    a, theta_dot, relative = [ca.SX.sym(name, 3) for name in ("a", "theta_dot", "relative")]
    rate = DEG_PER_HOUR_IN_RAD_PER_S * drift_law(a, drift, noise)
    turned = (nodal_from_platform_both_sides(theta, ca.jacobian(rate, a)) @ ca.skew(force)
              - ca.skew(omega)) @ w
    # Nodal axes do not rotate about z: the components of the rate change instead.
    turned[:, 2] += ca.vertcat(-relative[1], relative[0], 0)
    by_theta = angle_rates_from_nodal(theta, turned - ca.jacobian(w @ theta_dot, theta))
    by_rate = angle_rates_from_nodal(
        theta, nodal_from_platform(theta, DEG_PER_HOUR_IN_RAD_PER_S * ca.SX.eye(3)))
    by_drift, by_noise = [by_rate @ ca.jacobian(drift_law(a, drift, noise), group)
                          for group in (drift, noise)]

    along_platform = rotation_z(theta[2]) @ force
    relative_rate = nodal_from_platform(theta, ca.substitute(rate, a, along_platform)) - omega
    angle_rates = angle_rates_from_nodal(theta, relative_rate)
    return angle_rates, *[ca.sparsify(jacobian) for jacobian in ca.substitute(
        [by_theta, by_drift, by_noise],
        [a, theta_dot, relative], [along_platform, angle_rates, relative_rate],
    )]
