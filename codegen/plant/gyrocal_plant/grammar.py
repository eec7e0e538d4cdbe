"""Terms that a model may lack, proposed from its states, inputs and outputs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

import casadi as ca

# A sign changes within this share of the typical size of its argument.
SHARPNESS = 0.02
# A dead zone and a saturation are first looked for at this share of the typical size; a fit moves the knee.
KNEE = 0.5
# With more states and inputs than these, products of three factors are left out.
MOST_FOR_CUBES = 3


@dataclass
class Knee:
    """Where a function bends, which a fit estimates beside its size."""

    sx: ca.SX
    # The state or input that it is a value of.
    of: str
    # Where it is before a record, and the standard deviation of that.
    value: float
    sigma: float


def functions(symbols: list[tuple[str, str, ca.SX, float | None, bool]]
              ) -> Iterator[tuple[str, str, str, ca.SX, Knee | None]]:
    """Functions of states and inputs: id, words, unit, expression, and the knee of one that has one.

    A symbol is a name, its unit, the expression, its typical size (None if it is not known), and whether
    it is a state.
    """
    for name, unit, symbol, typical, _ in symbols:
        smooth = [
            (name, f"proportional to {name}", unit, symbol),
            (f"{name}^2", f"the square of {name}", _power(unit, 2), symbol**2),
            (f"{name}^3", f"the cube of {name}", _power(unit, 3), symbol**3),
            (f"|{name}|", f"the absolute value of {name}", unit, ca.fabs(symbol)),
            (f"{name}|{name}|", f"{name} times its absolute value", _power(unit, 2), symbol * ca.fabs(symbol)),
        ]
        if typical:
            smooth.append((f"sign({name})", f"the sign of {name}", "1", ca.tanh(symbol / (SHARPNESS * typical))))
        yield from ((*one, None) for one in smooth)
        if typical:
            beyond, above = (Knee(ca.SX.sym("knee"), name, KNEE * typical, typical) for _ in range(2))
            dead = symbol - ca.fmax(-beyond.sx, ca.fmin(beyond.sx, symbol))
            yield (f"beyond({name})", f"what {name} exceeds a knee by on either side: a dead zone, or "
                   "with a change of slope a saturation", unit, dead, beyond)
            yield (f"above({name})", f"what {name} exceeds a knee by", unit, ca.fmax(0, symbol - above.sx), above)
    for (a, of_a, one, _, one_moves), (b, of_b, other, _, other_moves) in combinations(symbols, 2):
        yield f"{a} {b}", f"the product of {a} and {b}", f"{of_a} {of_b}", one * other, None
        if len(symbols) <= MOST_FOR_CUBES and one_moves and other_moves:
            yield f"{a}^2 {b}", f"the square of {a} times {b}", f"{_power(of_a, 2)} {of_b}", one**2 * other, None
            yield f"{a} {b}^2", f"{a} times the square of {b}", f"{of_a} {_power(of_b, 2)}", one * other**2, None
            yield f"{a} |{b}|", f"{a} times the absolute value of {b}", f"{of_a} {of_b}", one * ca.fabs(other), None
            yield f"{b} |{a}|", f"{b} times the absolute value of {a}", f"{of_a} {of_b}", other * ca.fabs(one), None


def _power(unit: str, power: int) -> str:
    return " ".join([unit] * power)


def of_input(unit: str) -> Iterator[tuple[str, str, str, str]]:
    """Errors of an input over time: id, words, formula and unit."""
    yield "delay", "acts late, by a delay", "u(t - size) - u(t)", "s"
    yield "play", "has play, as by backlash or hysteresis: half its width", "play(u) - u", unit


def of_output(name: str, unit: str, reading: ca.SX, slope: ca.SX | None
              ) -> Iterator[tuple[str, str, str, ca.SX]]:
    """Errors of a sensor: functions of what it should read. `slope` is its rate of change."""
    yield "gain", f"the gain of {name}", "1", reading
    yield f"{name}^2", f"the square of {name}", _power(unit, 2), reading**2
    yield f"{name}^3", f"the cube of {name}", _power(unit, 3), reading**3
    yield f"|{name}|", f"the absolute value of {name}", unit, ca.fabs(reading)
    if slope is not None:
        yield "lag", f"{name} is late, as by a lag or a delay", f"{unit}/s", -slope
