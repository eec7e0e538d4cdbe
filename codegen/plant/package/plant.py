"""A driven oscillator with a linear spring: what its simulation lacks is to be found in a record."""

from gyrocal_plant import Plant

plant = Plant("Duffing", "A mass on a spring, driven by a known force.")
x = plant.state("x", "m", initial=0.0, sigma=1.0, typical=1.0, doc="displacement")
v = plant.state("v", "m/s", initial=0.0, sigma=3.0, typical=2.0, doc="velocity")
k = plant.parameter("k", "s^-2", 4.0, positive=True, doc="stiffness over mass")
c = plant.parameter("c", "s^-1", 0.3, positive=True, doc="damping over mass")
g = plant.parameter("g", "kg^-1", 1.0, positive=True, doc="gain of the drive over mass")
u = plant.input("u", "N", interpolate=True, typical=2.0, doc="force of the drive")
plant.rate("x", v)
plant.rate("v", g * u - k * x - c * v)
plant.output("y", "m", x, sigma=0.01, doc="displacement")

if __name__ == "__main__":
    plant.write()
