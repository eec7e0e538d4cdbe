"""The tables of effects and channels, in the types of `gyrocal_scalar::effect`."""

from __future__ import annotations

import casadi as ca

from casadi_program import Index, Items, Record, Table, Variant, optional
from effect import Effect, Enters, Equivalence
from effect_check import Symbols
from layout import AXES, OUTPUT_CHANNELS, RATE_CHANNELS, Channel, drift

MODULE = "effect"
NOMINAL_REFERENCE = "IEEE Std 517-1974"

EFFECT_FIELDS = (
    "id", "family", "name", "reference", "formula", "kind", "enters", "parameters", "typical_size",
    "is_nominal", "default_search", "needs", "equivalents", "equivalence", "near_twins", "nested",
    "continuation", "separated_by",
)
CHANNEL_FIELDS = ("id", "name", "unit", "label", "constant")


class Layout:
    """Order of parameters, shapes and weights of effects in the model."""

    def __init__(self, parameters: list[str], shapes: list[str], weights: list[str]):
        self.parameters, self.shapes, self.weights = parameters, shapes, weights


def effect_tables(effects: list[Effect], layout: Layout) -> list[Table]:
    known = [element.id for element in drift.elements] + [effect.id for effect in effects]
    equivalents = _closed(effects, known, "equivalents", transitive=True)
    twins = _closed(effects, known, "near_twins", transitive=False)
    reasons = _reasons(effects, equivalents)
    rows = [_nominal(place, twins, layout) for place in range(len(drift.elements))]
    rows += [_row(effect, equivalents, reasons, twins, layout) for effect in effects]
    return [
        Table(
            "effects", "Effect",
            "Every effect of the catalogue, in the order in which exact equivalents are named.",
            dict.fromkeys(EFFECT_FIELDS, ""), rows, MODULE,
        ),
        _channels("rates", "Rate channels: the drifts of the gyros.", RATE_CHANNELS, layout),
        _channels("outputs", "Output channels: the readings of the accelerometers.",
                  OUTPUT_CHANNELS, layout),
    ]


def _channels(name: str, doc: str, channels: list[Channel], layout: Layout) -> Table:
    rows = [
        {"id": c.id, "name": c.name, "unit": c.unit, "label": c.label,
         "constant": Index(layout.parameters.index(c.constant))}
        for c in channels
    ]
    return Table(name, "Channel", doc, dict.fromkeys(CHANNEL_FIELDS, ""), rows, MODULE)


def _row(effect: Effect, equivalents, reasons, twins, layout: Layout) -> dict:
    formula, needs, axes = _formula(effect)
    return {
        "id": effect.id,
        "family": effect.family or effect.id,
        "name": effect.name,
        "reference": effect.reference,
        "formula": formula,
        "kind": _kind(effect),
        "enters": _enters(effect, axes),
        "parameters": Items(tuple(_parameters(effect, layout))),
        "typical_size": effect.typical_size,
        "is_nominal": False,
        "default_search": effect.default_search,
        "needs": Items(tuple(needs)),
        "equivalents": equivalents[effect.id],
        "equivalence": _equivalence(reasons.get(effect.id)),
        "near_twins": twins[effect.id],
        "nested": list(effect.nested),
        "continuation": Variant(f"Continuation::{effect.continuation.value}"),
        "separated_by": Items(tuple(
            Variant(f"Experiment::{e.variant}", (e.of,) if e.of else ())
            for e in effect.experiments
        )),
    }


def _kind(effect: Effect) -> Variant:
    noise = effect.noise
    arguments = () if noise is None else (Variant(f"NoiseProperty::{noise.value}"),)
    return Variant(f"EffectKind::{effect.kind.value}", arguments)


def _enters(effect: Effect, axes: list[str]) -> Variant:
    variants = {Enters.RATE: "Rates", Enters.OUTPUT: "Outputs", Enters.STATE: "States"}
    if effect.enters in variants:
        indices = Items(tuple(Index(AXES.index(axis)) for axis in axes))
        return Variant(f"Enters::{variants[effect.enters]}", (indices,))
    match effect.enters:
        case Enters.INPUT:
            return Variant("Enters::Inputs", (tuple(axes),))
        case Enters.TIME:
            return Variant("Enters::Time")
        case Enters.FILTER:
            return Variant("Enters::Filter")


def _parameters(effect: Effect, layout: Layout):
    for place, p in enumerate(effect.parameters):
        weight = None
        if effect.has_term:
            id = effect.state_id(p)
            role = Variant("Role::Parameter", (Index(layout.parameters.index(id)),))
            weight = layout.weights.index(id) if id in layout.weights else None
        elif effect.enters is Enters.STATE:
            role = Variant("Role::State", (Index(AXES.index(effect.axes[place])),))
        else:
            role = Variant("Role::Noise")
        yield _parameter(p.name, p.unit, role, p.scale, weight)
    for p in effect.shapes:
        id = effect.shape_id(p)
        index = Index(layout.shapes.index(id)) if id in layout.shapes else None
        if p.name == "onset_s":
            role = Variant("Role::Onset", (optional(index),))
        else:
            role = Variant("Role::TimeConstant", (index,))
        yield _parameter(p.name, p.unit, role, p.scale, None)


def _parameter(name: str, unit: str, role: Variant, scale: float, weight: int | None) -> Record:
    return Record("EffectParameter", {
        "name": name, "unit": unit, "role": role, "scale": scale,
        "weight": optional(None if weight is None else Index(weight)),
    })


def _nominal(place: int, twins, layout: Layout) -> dict:
    element, axis, power = drift.elements[place], AXES[place // 3], place % 3
    factor = ("", f"*a_{axis}", f"*sq(a_{axis})")[power]
    role = Variant("Role::Parameter", (Index(layout.parameters.index(element.id)),))
    return {
        "id": element.id,
        "family": ("gyro_i.bias", "gyro_i.g_i", "gyro_i.g_ii")[power],
        "name": element.doc,
        "reference": NOMINAL_REFERENCE,
        "formula": f"omega_d_{axis} += {element.name}{factor}",
        "kind": Variant("EffectKind::Constant"),
        "enters": Variant("Enters::Rates", (Items((Index(AXES.index(axis)),)),)),
        "parameters": Items((_parameter("size", element.unit, role, 1.0, None),)),
        "typical_size": 1.0,
        "is_nominal": True,
        "default_search": False,
        "needs": Items(()),
        "equivalents": [],
        "equivalence": _equivalence(None),
        "near_twins": twins[element.id],
        "nested": [],
        "continuation": Variant("Continuation::Stays"),
        "separated_by": Items(()),
    }


def _equivalence(found: Equivalence | None) -> Record:
    reason, experiment = ("", "") if found is None else (found.reason, found.experiment)
    return Record("Equivalence", {"reason": reason, "experiment": experiment})


def _reasons(effects: list[Effect], equivalents) -> dict[str, Equivalence]:
    """The reason of a class of equivalents, for each of its members."""
    own = {effect.id: effect.equivalence for effect in effects if effect.equivalence}
    found = dict(own)
    for id, others in equivalents.items():
        reasons = [own[other] for other in others if other in own]
        if id not in found and reasons:
            found[id] = reasons[0]
    return found


def _closed(effects: list[Effect], known: list[str], field: str, transitive: bool):
    """The relation in both directions, in the order of the table."""
    found: dict[str, set[str]] = {name: set() for name in known}
    for effect in effects:
        for other in getattr(effect, field):
            found[effect.id].add(other)
            found[other].add(effect.id)
    if transitive:
        for via in known:
            for one in found[via]:
                found[one] |= found[via] - {one}
    return {name: [other for other in known if other in others]
            for name, others in found.items()}


def _formula(effect: Effect) -> tuple[str, list[Variant], list[str]]:
    """The term as text, the data of record and bench that it needs, and where it enters: axes or
    names of inputs."""
    if not effect.has_term:
        return "", [], list(effect.axes)
    symbols = Symbols(effect)
    term = symbols.term(effect)
    axes = list(term) if isinstance(term, dict) else []
    everything = ca.veccat(*(term.values() if isinstance(term, dict) else [term]))
    needs = [need for need, symbol in (
        (Variant("Need::Column", ("temperature_c",)), symbols.regressors),
        (Variant("Need::Key", ("magnetic_field_gauss",)), symbols.field),
    ) if ca.depends_on(everything, symbol)]
    if effect.formula:
        return effect.formula, needs, axes
    if effect.enters is Enters.TIME:
        return f"rates -> {term} rates", needs, axes
    left = {Enters.RATE: "omega_d", Enters.OUTPUT: "e"}[effect.enters]
    text = "; ".join(f"{left}_{axis} += {part}" for axis, part in term.items())
    return text, needs, axes
