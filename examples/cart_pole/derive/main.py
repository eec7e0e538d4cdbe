"""A pole that hangs from a cart on a rail, with friction in both, driven by a force."""

import casadi as ca
from casadi_program import Element, Group
from plant import Plant

CART, POLE, LENGTH, GRAVITY = 1.0, 0.2, 0.5, 9.81  # kg, kg, m to the pole's mass, m/s^2

state = Group("state", "Cart and pole.", [
    Element("x", "m", "position of the cart"),
    Element("theta", "rad", "angle of the pole from hanging down"),
    Element("xDot", "m/s", "velocity of the cart"),
    Element("thetaDot", "rad/s", "rate of the pole"),
])
friction = Group("friction", "Friction, to be found.", [
    Element("b_cart", "N s/m", "force on the cart by its velocity"),
    Element("c_pole", "N m s", "torque on the pole by its rate"),
])
drive = Group("drive", "Drive.", [Element("force", "N", "force on the cart")])
gust = Group("gust", "Disturbances.", [
    Element("gust_force", "N", "force on the cart"), Element("gust_torque", "N m", "torque on the pole"),
])


def derive(output):
    theta, x_dot, rate = state["theta"], state["xDot"], state["thetaDot"]
    force = drive["force"] + gust["gust_force"] - friction["b_cart"] * x_dot
    torque = gust["gust_torque"] - friction["c_pole"] * rate
    # Newton for cart and pole: a mass matrix times both accelerations.
    coupling = POLE * LENGTH * ca.cos(theta)
    mass = ca.vertcat(ca.horzcat(CART + POLE, coupling), ca.horzcat(coupling, POLE * LENGTH**2))
    right = ca.vertcat(force + POLE * LENGTH * rate**2 * ca.sin(theta),
                       torque - POLE * GRAVITY * LENGTH * ca.sin(theta))
    Plant(
        "CartPole", "A cart with a hanging pole.", state,
        rates=ca.vertcat(x_dot, rate, ca.solve(mass, right)),
        output=ca.vertcat(state["x"], theta), output_names=["x_read", "theta_read"],
        output_unit="m, rad", parameters=friction, inputs=[drive], noise=gust,
        source="Newton's second law",
    ).program().write(output / "cart_pole.json")
