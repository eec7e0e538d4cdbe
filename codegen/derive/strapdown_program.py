"""The analytic platform: axes computed from the outputs of gyros fixed to a body.

The drift law is evaluated in the axes of the gyros, at the specific force along body axes. The
coefficients are errors of the outputs; the platform rotates by -platform_c_gyros times their sum.
Parameters and their order are those of `Surveyed`.
"""

import extended_program
from casadi_program import Program
from catalogue import EFFECTS
from surveyed_program import SITE


def program() -> Program:
    return extended_program.program(
        "strapdown", "Strapdown",
        "The analytic platform of a strapdown unit, with errors of latitude, Earth rate and "
        "gravity as parameters.",
        [effect for effect in EFFECTS if effect.id in SITE],
        strapdown=True,
    )
