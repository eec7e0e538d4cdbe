"""The classical fourth-order Runge-Kutta step, written out: an oracle for tests.

The filter integrates the variational equation of the state sensitivity with the four
stages instead; both are the exact derivative of the same discrete map.
"""

import casadi as ca

from kinematics import angle_rates


def rk4_step(theta, drift, noise, omega_0, f_0, dt) -> ca.SX:
    """theta(k+1) by RK4 with drift, noise and chart vectors held over the step."""

    def rates(at: ca.SX) -> ca.SX:
        return angle_rates(at, drift, noise, omega_0, f_0)

    k1 = rates(theta)
    k2 = rates(theta + dt / 2 * k1)
    k3 = rates(theta + dt / 2 * k2)
    k4 = rates(theta + dt * k3)
    return theta + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
