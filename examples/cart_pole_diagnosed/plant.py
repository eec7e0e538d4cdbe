"""A cart on a rail with a hanging pole, driven by a force under feedback."""

import casadi as ca
from gyrocal_plant import Plant

CART, POLE, LENGTH, GRAVITY = 1.0, 0.2, 0.5, 9.81  # kg, kg, m to the pole's mass, m/s^2

plant = Plant("CartPole", "A cart with a hanging pole.")
place = plant.state("place", sigma=0.5, typical=0.3, doc="place of the cart, m")
angle = plant.state("angle", sigma=0.5, typical=0.3, doc="angle of the pole from hanging, rad")
speed = plant.state("speed", sigma=1.0, typical=0.5, doc="speed of the cart, m/s")
spin = plant.state("spin", sigma=2.0, typical=2.0, doc="rate of the pole, rad/s")
b = plant.parameter("b", value=1.0, positive=True, doc="friction of the cart, N s/m")
c = plant.parameter("c", value=0.15, positive=True, doc="friction of the pole over its inertia, 1/s")
g = plant.parameter("g", value=1.0, positive=True, doc="gain of the drive")
force = plant.input("force", typical=2.0, doc="force on the cart, N")
# Newton for cart and pole: a mass matrix times both accelerations.
inertia = POLE * LENGTH**2
coupling = POLE * LENGTH * ca.cos(angle)
mass = ca.vertcat(ca.horzcat(CART + POLE, coupling), ca.horzcat(coupling, inertia))
right = ca.vertcat(g * force - b * speed + POLE * LENGTH * spin**2 * ca.sin(angle),
                   -c * inertia * spin - POLE * GRAVITY * LENGTH * ca.sin(angle))
acceleration = ca.solve(mass, right)
plant.rate("place", speed)
plant.rate("angle", spin)
plant.rate("speed", acceleration[0])
plant.rate("spin", acceleration[1])
plant.output("x", "", place, sigma=0.001, doc="place of the cart, m")
plant.output("theta", "", angle, sigma=0.002, doc="angle of the pole, rad")

if __name__ == "__main__":
    plant.write()
