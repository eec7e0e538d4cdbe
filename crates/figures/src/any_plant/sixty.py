"""An oscillator with sixty candidate terms: what the grammar proposes, and powers and products beyond it."""

from gyrocal_plant import Plant

plant = Plant("Oscillator", "A mass on a spring, driven by a known force.")
x = plant.state("x", "m", initial=0.0, sigma=1.0, typical=1.0)
v = plant.state("v", "m/s", initial=0.0, sigma=3.0, typical=2.0)
k = plant.parameter("k", "s^-2", 4.0, positive=True)
c = plant.parameter("c", "s^-1", 0.3, positive=True)
g = plant.parameter("g", "kg^-1", 1.0, positive=True)
u = plant.input("u", "N", interpolate=True, typical=2.0)
plant.rate("x", v)
plant.rate("v", g * u - k * x - c * v)
plant.output("y", "m", x, sigma=0.01)
plant.propose()
further = {"x^4": x**4, "x^5": x**5, "v^4": v**4, "v^5": v**5, "u^4": u**4, "x^4 v": x**4 * v, "x v^4": x * v**4,
           "x^2 u": x**2 * u, "x u^2": x * u**2, "v^2 u": v**2 * u, "v u^2": v * u**2, "x v u": x * v * u,
           "x^3 v": x**3 * v, "x^2 v^2": x**2 * v**2, "x v^3": x * v**3, "x^3 u": x**3 * u}
for name, term in further.items():
    plant.effect(f"further.{name}", term, rate="v")
plant.write()
