"""The analytic platform with every effect of the catalogue, in the axes of gyros and accelerometers.

Parameters, shapes and their order are those of `catalogue_program`: its tables hold for both.
"""

import extended_program
from casadi_program import Program
from catalogue import EFFECTS


def program() -> Program:
    return extended_program.program(
        "strapdown_catalogue", "StrapdownCatalogue",
        "The analytic platform of a strapdown unit with every effect of the catalogue, in the axes "
        "of its gyros and accelerometers.",
        [effect for effect in EFFECTS if effect.has_term],
        strapdown=True,
    )
