"""The table of effects: one row for each entry of the catalogue, and for the nominal terms."""

from __future__ import annotations

import difflib

import casadi as ca

from casadi_program import ExportError, Table
from effect import At, Effect, by_axis, rust_name
from layout import AXES, drift

FIELDS = {
    "id": "public id, such as `gyro_x.g_y`",
    "kind": "`nominal` or `term` (in the symbolic model), `noise`, `state` or `filter`",
    "enters": "where it enters: `drift`, `output`, `site`, `time`, `state` or `filter`",
    "name": "physical name, with the letter of the literature where there is one",
    "reference": "where the name is from; may be empty",
    "formula": "the term as the model has it; empty if it has none",
    "parameters": "names of its parameters in results",
    "units": "their units",
    "states": "ids of those parameters that are states of `Catalogue`, in the order of `parameters`",
    "shapes": "ids of those that are given to `Catalogue` as shapes; they follow the states",
    "typical_size": "what a sound instrument may have, in the unit of the first parameter",
    "default_search": "part of a search that was not told what to look for",
    "needs": "what a record or bench file must have: `temperature`, `field`",
    "equivalents": "effects that no record can tell from it",
    "near_twins": "effects that a short record can hardly tell from it",
}


def effect_table(effects: list[Effect]) -> Table:
    known = [effect.id for effect in effects] + [element.id for element in drift.elements]
    for name in known:
        if known.count(name) > 1:
            raise ExportError(f"the catalogue has two effects `{name}`")
    equivalents = _closed(effects, known, "equivalents", transitive=True)
    twins = _closed(effects, known, "near_twins", transitive=False)
    rows = [_nominal(place, twins) for place in range(len(drift.elements))]
    rows += [_row(effect, equivalents, twins) for effect in effects]
    return Table(
        "effects", "EffectRow",
        "Every effect that this project knows, in the order in which exact equivalents are named.",
        FIELDS, rows,
    )


def _row(effect: Effect, equivalents, twins) -> dict:
    formula, needs = _formula(effect)
    states = [effect.state_id(p) for p in effect.parameters] if effect.has_term else []
    parameters = effect.parameters + effect.shapes
    return {
        "id": effect.id,
        "kind": effect.kind,
        "enters": effect.enters,
        "name": effect.name,
        "reference": effect.reference,
        "formula": formula,
        "parameters": [p.name for p in parameters],
        "units": [p.unit for p in parameters],
        "states": states,
        "shapes": [effect.shape_id(p) for p in effect.shapes],
        "typical_size": effect.typical_size,
        "default_search": effect.default_search,
        "needs": needs,
        "equivalents": equivalents[effect.id],
        "near_twins": twins[effect.id],
    }


def _nominal(place: int, twins) -> dict:
    element, axis, power = drift.elements[place], AXES[place // 3], place % 3
    factor = ("", f"*a_{axis}", f"*sq(a_{axis})")[power]
    return {
        "id": element.id,
        "kind": "nominal",
        "enters": "drift",
        "name": element.doc,
        "reference": "IEEE Std 517-1974",
        "formula": f"omega_d_{axis} += {element.name}{factor}",
        "parameters": ["size"],
        "units": [element.unit],
        "states": [element.id],
        "shapes": [],
        "typical_size": 1.0,
        "default_search": False,
        "needs": [],
        "equivalents": [],
        "near_twins": twins[element.id],
    }


def _closed(effects: list[Effect], known: list[str], field: str, transitive: bool):
    """The relation read in both directions, in the order of the table."""
    found: dict[str, set[str]] = {name: set() for name in known}
    for effect in effects:
        for other in getattr(effect, field):
            if other not in found:
                near = difflib.get_close_matches(other, known, 3)
                raise ExportError(
                    f"effect `{effect.id}`, {field}: found `{other}`, expected the id of an "
                    f"effect; the nearest are {', '.join(near) or 'none'}"
                )
            found[effect.id].add(other)
            found[other].add(effect.id)
    if transitive:
        for via in known:
            for one in found[via]:
                found[one] |= found[via] - {one}
    return {name: [other for other in known if other in others]
            for name, others in found.items()}


def _formula(effect: Effect) -> tuple[str, list[str]]:
    """The term with plain symbols, and what it needs of record and bench."""
    if not effect.has_term:
        return "", []

    def vector(name: str) -> ca.SX:
        return ca.vertcat(*[ca.SX.sym(f"{name}_{i}") for i in AXES])

    field, temperature = vector("b"), ca.SX.sym("temperature_k")
    at = At(
        a=by_axis(vector("a")), drift=by_axis(vector("omega_d")), field=by_axis(field),
        time_s=ca.SX.sym("time_s"), interval_s=ca.SX.sym("interval_s"),
        temperature_k=temperature,
        omega_0=vector("omega_0"), f_0=vector("f_0"), east_0=vector("east_0"),
    )
    own = {p.name: ca.SX.sym(rust_name(effect.state_id(p))) for p in effect.parameters}
    own |= {p.name: ca.SX.sym(rust_name(effect.shape_id(p))) for p in effect.shapes}
    term = effect.term(own, at)
    parts = list(term.values()) if isinstance(term, dict) else [term]
    everything = ca.veccat(*parts)
    needs = [name for name, symbol in (("temperature", temperature), ("field", field))
             if ca.depends_on(everything, symbol)]
    if effect.formula:
        return effect.formula, needs
    if effect.enters == "time":
        return f"rates -> {term} rates", needs
    left = {"drift": "omega_d", "output": "e"}[effect.enters]
    return "; ".join(f"{left}_{axis} += {part}" for axis, part in term.items()), needs
