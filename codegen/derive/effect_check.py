"""Whether an entry of the catalogue is what it declares: checked before anything is derived."""

from __future__ import annotations

import difflib
import random

import casadi as ca

from casadi_program import ExportError
from effect import (
    KINDS_WITH_TERM, KINDS_WITH_WEIGHT, At, Continuation, Effect, Enters, Kind, by_axis, rust_name,
)
from layout import AXES, REGRESSORS

FILE = "codegen/derive/catalogue.py"

SHAPES = {Kind.STEP: "onset_s", Kind.FROM_ONSET: "onset_s", Kind.EXPONENTIAL: "time_constant_h",
          Kind.STATE_JUMP: "onset_s"}
"""The one shape that each kind has; the others have none."""

WITHOUT_TERM = {
    Kind.RANDOM_WALK: {Enters.RATE, Enters.OUTPUT},
    Kind.NOISE: {Enters.RATE, Enters.OUTPUT},
    Kind.STATE_JUMP: {Enters.STATE},
    Kind.INITIAL_STATE: {Enters.STATE},
    Kind.INTEGRATION: {Enters.FILTER},
}
"""Where effects without a term may enter."""

ROUNDING = 1e-9
"""Equal up to this share of the largest value: far more than rounding, far less than a term."""


class Symbols:
    """Symbols of everything that a term may be made of."""

    def __init__(self, effect: Effect):
        def vector(name: str) -> ca.SX:
            return ca.vertcat(*[ca.SX.sym(f"{name}_{i}") for i in AXES])

        self.force, self.field, self.drift = vector("a"), vector("b"), vector("omega_d")
        self.time_s, self.interval_s = ca.SX.sym("time_s"), ca.SX.sym("interval_s")
        self.regressors = ca.vertcat(*[ca.SX.sym(name) for name in REGRESSORS])
        self.at = At(
            a=by_axis(self.force), drift=by_axis(self.drift), field=by_axis(self.field),
            time_s=self.time_s, interval_s=self.interval_s,
            **dict(zip(REGRESSORS, ca.vertsplit(self.regressors))),
            omega_0=vector("omega_0"), f_0=vector("f_0"), east_0=vector("east_0"),
        )
        self.parameters = {p.name: ca.SX.sym(rust_name(effect.state_id(p)))
                           for p in effect.parameters}
        self.shapes = {p.name: ca.SX.sym(rust_name(effect.shape_id(p))) for p in effect.shapes}

    def term(self, effect: Effect):
        """What the term returns; refuses what it asks for and is not there."""
        try:
            return effect.term(self.parameters | self.shapes, self.at)
        except AttributeError as error:
            raise _error(
                effect, f"its term asks for `{error.name}`",
                f"the quantities of `At` (a, drift, field, time_s, interval_s, {', '.join(REGRESSORS)}, "
                "omega_0, f_0, east_0)",
                "use one of them, or add the quantity to `At` and to the inputs of the model",
            ) from None
        except KeyError as error:
            raise _error(
                effect, f"its term asks for the parameter {error}",
                f"one of {', '.join(f'`{n}`' for n in self.parameters | self.shapes)}",
                "declare it in `parameters` or `shapes`",
            ) from None


def check(effects: list[Effect], known: list[str]) -> None:
    """Refuses contradictory declarations, missing regressors and relations to nothing."""
    for effect in effects:
        if known.count(effect.id) > 1:
            raise _error(effect, "a second entry with this id", "each id once", "rename one")
        _check_kind(effect)
        for field in ("equivalents", "near_twins", "nested"):
            for other in getattr(effect, field):
                if other not in known:
                    near = difflib.get_close_matches(other, known, 3)
                    raise _error(
                        effect, f"`{other}` in `{field}`", "the id of an effect",
                        f"take one of the nearest: {', '.join(near) or 'there is none'}",
                    )


def _check_kind(effect: Effect) -> None:
    kind = effect.kind
    if (kind in KINDS_WITH_TERM) != effect.has_term:
        raise _error(
            effect, f"kind {kind.name} {'with' if effect.has_term else 'without'} a term",
            f"{'no' if effect.has_term else 'a'} term",
            "give another kind, or " + ("take the term out" if effect.has_term else "add one"),
        )
    if kind in WITHOUT_TERM and effect.enters not in WITHOUT_TERM[kind]:
        raise _error(
            effect, f"kind {kind.name} that enters {effect.enters.name}",
            " or ".join(sorted(place.name for place in WITHOUT_TERM[kind])),
            "give another kind or another place",
        )
    if kind in WITHOUT_TERM and kind is not Kind.INTEGRATION and not effect.axes:
        raise _error(effect, "no `axes`", "the axes that it enters", "name them in `axes`")
    if (kind is Kind.NOISE) != (effect.noise is not None):
        raise _error(effect, f"kind {kind.name} and noise {effect.noise}",
                     "a property of the noise for kind NOISE and for no other",
                     "give `noise=NoiseProperty...` or another kind")
    shapes = [p.name for p in effect.shapes]
    expected = [SHAPES[kind]] if kind in SHAPES else []
    if shapes != expected:
        raise _error(effect, f"kind {kind.name} with the shapes {shapes}", f"{expected}",
                     "give another kind or other shapes")
    if (kind is Kind.PERIODIC) != (effect.period_s is not None):
        raise _error(effect, f"kind {kind.name} with period_s {effect.period_s}",
                     "a period for kind PERIODIC and for no other", "give `period_s` in seconds")
    if effect.power != 1 and kind is not Kind.REGRESSOR or effect.power < 1:
        raise _error(effect, f"kind {kind.name} with the power {effect.power}",
                     "a power of one or more for kind REGRESSOR, and for no other kind",
                     "take `power` out or give another kind")
    if effect.continuation is Continuation.GOES_ON and kind not in KINDS_WITH_WEIGHT:
        raise _error(effect, f"kind {kind.name} that goes on in a later record",
                     "a function of time or of a regressor", "give another continuation")
    if effect.has_term:
        _check_term(effect)


def _check_term(effect: Effect) -> None:
    symbols = Symbols(effect)
    term = symbols.term(effect)
    if effect.enters in (Enters.RATE, Enters.OUTPUT):
        if not isinstance(term, dict) or not set(term) <= set(AXES) or not term:
            raise _error(effect, f"a term that returns {term}", f"a dict with keys of {AXES}",
                         "give for each axis what is added")
    expression = ca.veccat(*(term.values() if isinstance(term, dict) else [term]))
    sizes = ca.vertcat(*symbols.parameters.values())
    if effect.enters in (Enters.RATE, Enters.OUTPUT):
        if ca.depends_on(ca.jacobian(expression, sizes), sizes):
            raise _error(effect, "a term that is not linear in its parameters",
                         "linear in each of `parameters`",
                         "give what it is not linear in as a shape")
    of_time = ca.depends_on(expression, ca.vertcat(symbols.time_s, symbols.interval_s))
    of_temperature = ca.depends_on(expression, symbols.regressors)
    if effect.kind is Kind.CONSTANT and (of_time or of_temperature):
        raise _error(
            effect, f"kind CONSTANT with a term of {'time' if of_time else 'temperature'}",
            "no explicit time and no regressor in its term",
            "declare Kind.RAMP, PERIODIC, STEP, FROM_ONSET, EXPONENTIAL or REGRESSOR",
        )
    if effect.kind is Kind.REGRESSOR and not of_temperature:
        raise _error(effect, "kind REGRESSOR without a regressor in its term",
                     " or ".join(f"`at.{name}`" for name in REGRESSORS) + " in its term",
                     "use a regressor or give another kind")
    if effect.kind in KINDS_WITH_WEIGHT - {Kind.REGRESSOR} and not of_time:
        raise _error(effect, f"kind {effect.kind.name} without time in its term",
                     "`at.time_s` in its term", "use time, or declare Kind.CONSTANT")
    if effect.kind in KINDS_WITH_WEIGHT:
        if effect.enters not in (Enters.RATE, Enters.OUTPUT) or len(term) != 1:
            raise _error(effect, f"a function of time that enters {effect.enters.name} in "
                         f"{len(term) if isinstance(term, dict) else 1} channels",
                         "one rate or one output", "make one effect for each channel")
        if ca.depends_on(expression, ca.vertcat(symbols.field, symbols.drift)):
            raise _error(effect, "a function of time of the field or of drifts",
                         "time, temperature, specific force and its shape",
                         "leave the field and drifts to effects of kind CONSTANT")
        _check_course(effect, symbols, expression, sizes)


def _check_course(effect: Effect, symbols: Symbols, expression: ca.SX, sizes: ca.SX) -> None:
    """Evaluates the weights at random points: they must go as the kind says."""
    shapes = list(symbols.shapes.values())
    inputs = [symbols.force, symbols.time_s, symbols.interval_s, symbols.regressors, *shapes]
    weights = ca.Function("weights", inputs, [ca.densify(ca.jacobian(expression, sizes))])
    rng = random.Random(0)
    for _ in range(8):
        force = [rng.uniform(-1, 1) for _ in AXES]
        time_s, interval_s = rng.uniform(1e4, 1e5), rng.uniform(1, 100)
        given = ca.DM([rng.uniform(1, 5) for _ in REGRESSORS])
        if effect.kind in (Kind.STEP, Kind.FROM_ONSET):
            before = weights(force, time_s, interval_s, given, time_s + interval_s)
            after = weights(force, time_s, interval_s, given, time_s - interval_s)
            if not ca.norm_inf(ca.vec(before)) == 0:
                raise _error(effect, "a term that acts before its onset", "zero before it",
                             "multiply it with the share of the step after the onset")
            if effect.kind is Kind.STEP and not ca.norm_inf(ca.vec(after - 1)) == 0:
                raise _error(effect, f"kind STEP with the weight {after} after the onset",
                             "one", "declare Kind.FROM_ONSET")
        elif effect.kind is Kind.RAMP:
            once, twice = (weights(force, t, interval_s, given) for t in (time_s, 2 * time_s))
            _equal(effect, twice, 2 * once, "proportional to time")
        elif effect.kind is Kind.PERIODIC:
            later = weights(force, time_s + effect.period_s, interval_s, given)
            now = weights(force, time_s, interval_s, given)
            _equal(effect, later, now, "the same after `period_s`")
        elif effect.kind is Kind.REGRESSOR:
            once, twice = (weights(force, time_s, interval_s, r) for r in (given, 2 * given))
            _equal(effect, twice, 2**effect.power * once,
                   f"proportional to the power {effect.power} of the regressors")


def _equal(effect: Effect, found, expected, what: str) -> None:
    scale = max(float(ca.norm_inf(ca.vec(expected))), 1e-12)
    if not float(ca.norm_inf(ca.vec(found - expected))) <= ROUNDING * scale:
        raise _error(effect, f"kind {effect.kind.name} with the weight {found}, where {expected} "
                     "would follow", what, "give another kind or another term")


def _error(effect: Effect, found: str, expected: str, remedy: str) -> ExportError:
    return ExportError(
        f"{FILE}: effect `{effect.id}`: found {found}, expected {expected}; {remedy}"
    )
