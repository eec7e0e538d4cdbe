"""An axis with a motor and viscous friction; its encoder is read and a controller drives it."""

from gyrocal_plant import Plant

plant = Plant("Servo", "A motor turns an axis.")
angle = plant.state("angle", "rad", sigma=1.0, typical=1.0, doc="angle of the axis")
rate = plant.state("rate", "rad/s", sigma=3.0, typical=3.0, doc="rate of the axis")
a = plant.parameter("a", "V^-1 s^-2", 30.0, positive=True, doc="gain of the motor over inertia")
b = plant.parameter("b", "s^-1", 4.0, positive=True, doc="viscous friction over inertia")
drive = plant.input("drive", "V", typical=1.0, doc="voltage of the motor")
plant.rate("angle", rate)
plant.rate("rate", a * drive - b * rate)
plant.output("y", "rad", angle, sigma=0.002, doc="encoder")

if __name__ == "__main__":
    plant.write()
