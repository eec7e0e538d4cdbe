"""The platform with every effect of the catalogue, and the table of effects."""

import extended_program
from casadi_program import Program
from catalogue import EFFECTS
from effect_table import effect_table


def program() -> Program:
    return extended_program.program(
        "catalogue", "Catalogue", "The platform with every effect of the catalogue.",
        [effect for effect in EFFECTS if effect.has_term],
        [effect_table(EFFECTS)],
    )
