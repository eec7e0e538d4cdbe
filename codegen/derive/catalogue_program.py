"""The platform with every effect of the catalogue, and the tables of effects and channels."""

import extended_program
from casadi_program import Program
from catalogue import EFFECTS
from effect_check import check
from effect_table import Layout, effect_tables
from layout import drift


def program() -> Program:
    check(EFFECTS, [element.id for element in drift.elements] + [e.id for e in EFFECTS])
    terms = [effect for effect in EFFECTS if effect.has_term]
    layout = Layout(
        [element.id for element in drift.elements]
        + [element.id for element in extended_program.added_parameters(terms)],
        [element.id for element in extended_program.shape_elements(terms)],
        [effect.state_id(p) for effect, p in extended_program.weighted(terms)],
    )
    return extended_program.program(
        "catalogue", "Catalogue", "The platform with every effect of the catalogue.",
        terms, effect_tables(EFFECTS, layout), with_weights=True,
    )
