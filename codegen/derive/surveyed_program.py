"""The nominal platform with the uncertain quantities of its site as parameters."""

import extended_program
from casadi_program import Program
from catalogue import EFFECTS

SITE = ("site.latitude", "site.earth_rate", "site.gravity")


def program() -> Program:
    return extended_program.program(
        "surveyed", "Surveyed",
        "The nominal platform with errors of latitude, Earth rate and gravity as parameters.",
        [effect for effect in EFFECTS if effect.id in SITE],
    )
