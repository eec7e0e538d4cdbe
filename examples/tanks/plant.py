"""Two tanks, one above the other; only the level of the lower one is measured."""

import casadi as ca
from gyrocal_plant import Plant

plant = Plant("Tanks", "A pump fills the upper tank, its outflow the lower one.")
upper = plant.state("upper", "m", initial=5.0, sigma=1.0, typical=10.0, doc="level of the upper tank")
lower = plant.state("lower", "m", initial=5.0, sigma=1.0, typical=10.0, doc="level of the lower tank")
k1 = plant.parameter("k1", "m^0.5/s", 0.05, positive=True, doc="outflow of the upper tank")
k2 = plant.parameter("k2", "m^0.5/s", 0.05, positive=True, doc="inflow of the lower tank")
k3 = plant.parameter("k3", "m^0.5/s", 0.05, positive=True, doc="outflow of the lower tank")
k4 = plant.parameter("k4", "m s^-1 V^-1", 0.04, positive=True, doc="gain of the pump")
pump = plant.input("pump", "V", typical=3.0, doc="voltage of the pump")


def root(level):
    """Torricelli; a level just above the bottom keeps the slope finite."""
    return ca.sqrt(ca.fmax(level, 1e-3))


plant.rate("upper", k4 * pump - k1 * root(upper))
plant.rate("lower", k2 * root(upper) - k3 * root(lower))
plant.output("y", "m", lower, sigma=0.02, saturates=(-1.0, 9.8), doc="level of the lower tank")

if __name__ == "__main__":
    plant.write()
