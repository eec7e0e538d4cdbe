"""A quadrotor's attitude from gyros with biases, accelerometers in hover and a magnetometer."""

import casadi as ca
from casadi_program import Element, Group, vector
from plant import Plant

DIP = 1.1  # inclination of the magnetic field, rad below the horizon

attitude = Group("attitude", "Roll, pitch and yaw, axes north, east, down.", [
    Element("phi", "rad", "roll"), Element("theta", "rad", "pitch"), Element("psi", "rad", "yaw"),
])
bias = vector("bias", "Biases of the gyros, to be found.", "rad/s")
omega = vector("omega", "Readings of the gyros.", "rad/s")
noise = vector("noise", "Noise of the gyros.", "rad/s")


def derive(output):
    phi, theta, psi = (attitude[name] for name in ("phi", "theta", "psi"))
    # Rates of the angles from those of the body: reading less bias and noise.
    body = omega.sx - bias.sx - noise.sx
    angles = ca.vertcat(
        ca.horzcat(1, ca.sin(phi) * ca.tan(theta), ca.cos(phi) * ca.tan(theta)),
        ca.horzcat(0, ca.cos(phi), -ca.sin(phi)),
        ca.horzcat(0, ca.sin(phi) / ca.cos(theta), ca.cos(phi) / ca.cos(theta)),
    )

    def turn(axis, angle):
        """Axes turned by the angle: components in the new ones."""
        c, s = ca.cos(angle), ca.sin(angle)
        return [ca.vertcat(ca.horzcat(1, 0, 0), ca.horzcat(0, c, s), ca.horzcat(0, -s, c)),
                ca.vertcat(ca.horzcat(c, 0, -s), ca.horzcat(0, 1, 0), ca.horzcat(s, 0, c)),
                ca.vertcat(ca.horzcat(c, s, 0), ca.horzcat(-s, c, 0), ca.horzcat(0, 0, 1))][axis]

    body_c_ned = turn(0, phi) @ turn(1, theta) @ turn(2, psi)
    force = body_c_ned @ ca.SX([0, 0, -1])
    field = body_c_ned @ ca.SX([ca.cos(DIP), 0, ca.sin(DIP)])
    Plant(
        "Quadrotor", "Attitude of a quadrotor in hover.", attitude,
        rates=angles @ body, output=ca.vertcat(force, field),
        output_names=[f"{kind}_{axis}" for kind in ("force", "field") for axis in "xyz"],
        output_unit="g, field strength", parameters=bias, inputs=[omega], noise=noise,
        domain="pitch away from +-90 deg",
    ).program().write(output / "quadrotor.json")
