"""Roll, pitch and yaw of a quadrotor with gyros, and a catalogue of its user's own."""

import casadi as ca
from gyrocal_plant import Plant

plant = Plant("Quadrotor", "Attitude of a quadrotor, driven by three torques.")
names, rates = ("roll", "pitch", "yaw"), ("p", "q", "r")
roll, pitch, yaw = (plant.state(name, "rad", sigma=0.5) for name in names)
p, q, r = (plant.state(name, "rad/s", sigma=1.0) for name in rates)
gains = [plant.parameter(name, "s^-2", value, positive=True)
         for name, value in (("l", 40.0), ("m", 40.0), ("n", 8.0))]
damping = [plant.parameter(f"d{name}", "s^-1", value, positive=True)
           for name, value in (("p", 0.6), ("q", 0.6), ("r", 0.3))]
coupling = plant.parameter("j", "1", 0.7, doc="differences of the inertias over them")
torque = [plant.input(f"u{name}", "1") for name in rates]
turn = (ca.sin(roll) * q + ca.cos(roll) * r) / ca.cos(pitch)
plant.rate("roll", p + turn * ca.sin(pitch))
plant.rate("pitch", ca.cos(roll) * q - ca.sin(roll) * r)
plant.rate("yaw", turn)
plant.rate("p", gains[0] * torque[0] - damping[0] * p + coupling * q * r)
plant.rate("q", gains[1] * torque[1] - damping[1] * q - coupling * p * r)
plant.rate("r", gains[2] * torque[2] - damping[2] * r)
for name, state, sigma in zip(names, (roll, pitch, yaw), (0.002, 0.002, 0.004)):
    plant.output(f"angle_{name}", "rad", state, sigma=sigma)
for name, state in zip(rates, (p, q, r)):
    plant.output(f"gyro_{name}", "rad/s", state, sigma=0.01)
for name, rate, state in zip(names, rates, (p, q, r)):
    plant.effect(f"{name}.drag", state * ca.fabs(state), rate=rate, name=f"quadratic drag in {name}")
    plant.effect(f"gyro_{rate}.gain", state, output=f"gyro_{rate}", name=f"gain of gyro {rate}")
for one, other, u in ((0, 1, 1), (1, 0, 0), (2, 0, 0), (2, 1, 1)):
    suffix = "mixing" if one < 2 else f"mixing_{rates[u]}"
    plant.effect(f"{names[one]}.{suffix}", torque[u], rate=rates[one],
                 name=f"torque of {names[other]} in {names[one]}")

if __name__ == "__main__":
    plant.write()
