"""A gauge: only the product of two gains acts."""

from gyrocal_plant import Plant

plant = Plant("Product", "A first-order lag behind an amplifier and a valve.")
x = plant.state("x", "m", sigma=1.0, typical=1.0)
p = plant.parameter("p", "s^-1", 0.5, positive=True, doc="rate of decay")
a = plant.parameter("a", "1", 2.0, positive=True, doc="gain of the amplifier")
b = plant.parameter("b", "m s^-1 V^-1", 0.4, positive=True, doc="gain of the valve")
u = plant.input("u", "V", typical=1.0)
plant.rate("x", a * b * u - p * x)
plant.output("y", "m", x, sigma=0.01)
plant.write()
