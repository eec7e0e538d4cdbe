from gyrocal_plant import Plant
plant = Plant("Buck", "A DC-DC converter, second order.")
x = plant.state("x", "V", initial=15.0, typical=5.0, doc="output voltage")
v = plant.state("v", "V/s", initial=0.0, typical=5000.0, doc="its rate")
k = plant.parameter("k", "s^-2", 4.0e7, positive=True, doc="stiffness")
c = plant.parameter("c", "s^-1", 5.0e3, positive=True, doc="damping")
g = plant.parameter("g", "s^-2", -6.0e8, doc="gain")
b = plant.parameter("b", "V s^-2", 2.0e9, doc="offset")
u = plant.input("u", "V", typical=2.3, doc="control")
plant.rate("x", v)
plant.rate("v", b + g * u - k * x - c * v)
plant.output("y", "V", x, sigma=0.05, doc="voltage")
if __name__ == "__main__":
    plant.write()
