"""The platform with the effects that a user's model file lists, in the order of the file.

A model file is TOML, written by `gyrocal extend`; docs/extending.md describes it.
"""

from __future__ import annotations

import difflib
import math
import tomllib
from dataclasses import replace
from pathlib import Path

import extended_program
from casadi_program import ExportError, Program, Table
from catalogue import EFFECTS
from effect import Effect
from layout import drift

SCHEMA_VERSION = 1
KEYS = {"schema_version", "gyros", "effects", "shapes", "estimates"}
PLATFORM, STRAPDOWN = "platform", "strapdown"
GYROS = {
    PLATFORM: "The platform with {effects}.",
    STRAPDOWN: "The analytic platform of a strapdown unit with {effects}, in the axes of its gyros "
               "and accelerometers.",
}
"""What the gyros are fixed to, and the documentation of such a model."""
WIDE = 10
"""Sigma of a parameter without an estimate, in typical sizes."""

START_FIELDS = {
    "id": "public id of the parameter",
    "value": "initial value of a filter, in the unit of the parameter",
    "sigma": "standard deviation of the initial value",
}


def program(path: Path, name: str) -> Program:
    """The program called `name` of the model file at `path`."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ExportError(f"{path.name}: {error}") from None
    try:
        return _program(content, name)
    except ExportError as error:
        raise ExportError(f"{path.name}: {error}") from None


def _program(content: dict, name: str) -> Program:
    for key in content:
        if key not in KEYS:
            raise ExportError(f"found the key `{key}`, expected {_any_of(sorted(KEYS))}")
    if content.get("schema_version") != SCHEMA_VERSION:
        raise ExportError(f"found schema_version {content.get('schema_version')}, "
                          f"expected {SCHEMA_VERSION}")
    gyros = content.get("gyros", PLATFORM)
    if not isinstance(gyros, str) or gyros not in GYROS:
        raise ExportError(f"found gyros {gyros!r}, expected {_any_of(list(GYROS))}")
    ids = content.get("effects")
    if not isinstance(ids, list) or not ids or not all(isinstance(i, str) for i in ids):
        raise ExportError(f"found effects {ids!r}, expected a list of ids of effects")
    effects = [_effect(id, place, ids) for place, id in enumerate(ids)]
    effects = _with_shapes(effects, content.get("shapes", {}))
    # Tables have parameters in the order of the model.
    states = extended_program.added_parameters(effects)
    start = _start(effects, [element.id for element in states], content.get("estimates", {}))
    listed = ", ".join(f"`{effect.id}`" for effect in effects)
    return extended_program.program(
        name, "".join(word.capitalize() for word in name.split("_")),
        GYROS[gyros].format(effects=listed), effects,
        [Table("start", "StartValue",
               "Initial values of a filter: the parameters after the drift coefficients, in order.",
               START_FIELDS, start)],
        strapdown=gyros == STRAPDOWN,
    )


def _effect(id: str, place: int, ids: list[str]) -> Effect:
    if id in ids[:place]:
        raise ExportError(f"effects: found `{id}` twice, expected each effect once")
    found = next((effect for effect in EFFECTS if effect.id == id), None)
    if found is not None and found.has_term:
        return found
    if found is not None:
        raise ExportError(f"effects: found `{id}`, which is not a term of the model (its kind is "
                          f"{found.kind.name}), expected effects with a term")
    if id in (element.id for element in drift.elements):
        raise ExportError(f"effects: found `{id}`, which every model has, expected effects "
                          "in addition to the nominal coefficients")
    known = [effect.id for effect in EFFECTS if effect.has_term]
    near = difflib.get_close_matches(id, known, 3)
    raise ExportError(f"effects: found `{id}`, expected the id of an effect; the nearest are "
                      f"{', '.join(near) or 'none'}")


def _with_shapes(effects: list[Effect], given: dict) -> list[Effect]:
    """The effects with the shapes that the file gives as constants; others stay inputs."""
    known = [effect.shape_id(p) for effect in effects for p in effect.shapes]
    for key, value in given.items():
        _number("shapes", key, value, known)
        if key.endswith("time_constant_h") and value <= 0:
            raise ExportError(f"shapes: found `{key}` {value}, expected a number greater than 0")
    return [_fixed(effect, given) for effect in effects]


def _fixed(effect: Effect, given: dict) -> Effect:
    constants = {p.name: given[effect.shape_id(p)] for p in effect.shapes
                 if effect.shape_id(p) in given}
    if not constants:
        return effect
    term = effect.term
    return replace(
        effect, term=lambda p, at: term(p | constants, at),
        shapes=tuple(p for p in effect.shapes if p.name not in constants),
    )


def _start(effects: list[Effect], states: list[str], given: dict) -> list[dict]:
    for key, value in given.items():
        if key not in states:
            raise ExportError(f"estimates: found `{key}`, expected {_any_of(states)}")
        if not isinstance(value, dict) or set(value) != {"value", "sigma"}:
            raise ExportError(f"estimates: found `{key}` {value!r}, expected a table of value "
                              "and sigma")
        for name, number in value.items():
            _number(f"estimates, {key}", name, number, ["value", "sigma"])
        if value["sigma"] <= 0:
            raise ExportError(f"estimates: found `{key}` with sigma {value['sigma']}, expected "
                              "a number greater than 0")
    typical = {effect.state_id(p): effect.typical_size
               for effect in effects for p in effect.parameters}
    unknown = {id: {"value": 0.0, "sigma": WIDE * size} for id, size in typical.items()}
    return [{"id": id} | (unknown | given)[id] for id in states]


def _number(where: str, key: str, value, known: list[str]) -> None:
    if key not in known:
        raise ExportError(f"{where}: found `{key}`, expected {_any_of(known)}")
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise ExportError(f"{where}: found `{key}` {value!r}, expected a finite number")


def _any_of(names: list[str]) -> str:
    return " or ".join(f"`{name}`" for name in names) or "nothing"
