"""A gauge: the amount in a compartment that no sensor sees has no scale."""

from gyrocal_plant import Plant

plant = Plant("Compartments", "A dose goes through one compartment into another, whose concentration is read.")
depot = plant.state("depot", "mol", sigma=1.0, typical=1.0)
blood = plant.state("blood", "mol l^-1", sigma=1.0, typical=1.0)
share = plant.parameter("share", "1", 0.8, positive=True, doc="share of the dose that is taken up")
uptake = plant.parameter("uptake", "s^-1", 0.5, positive=True)
volume = plant.parameter("volume", "l", 2.0, positive=True)
decay = plant.parameter("decay", "s^-1", 0.2, positive=True)
dose = plant.input("dose", "mol s^-1", typical=1.0)
plant.rate("depot", share * dose - uptake * depot)
plant.rate("blood", uptake * depot / volume - decay * blood)
plant.output("y", "mol l^-1", blood, sigma=0.01)
plant.write()
