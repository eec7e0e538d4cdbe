"""Dimensions of units, and their propagation through an expression."""

from __future__ import annotations

import re
from fractions import Fraction

import casadi as ca

# Dimensions as powers of kg, m, s, A, K, mol. Prefixes and factors do not matter here: an equation in
# one set of units is not checked for factors of ten.
_BASE = {
    "kg": "kg", "g": "kg", "m": "m", "s": "s", "A": "A", "K": "K", "degC": "K", "mol": "mol",
    "min": "s", "h": "s", "l": "m^3", "rad": "", "deg": "", "1": "", "%": "", "cd": "cd",
    "Hz": "s^-1", "N": "kg m s^-2", "J": "kg m^2 s^-2", "W": "kg m^2 s^-3",
    "Pa": "kg m^-1 s^-2", "bar": "kg m^-1 s^-2", "C": "A s", "V": "kg m^2 s^-3 A^-1",
    "Ohm": "kg m^2 s^-3 A^-2", "F": "kg^-1 m^-2 s^4 A^2", "H": "kg m^2 s^-2 A^-2",
    "T": "kg s^-2 A^-1",
}
_PREFIX = "GMkcdmun"
Dimension = dict[str, Fraction]


def _power(dimension: Dimension, exponent) -> Dimension:
    return {name: power * exponent for name, power in dimension.items() if power * exponent}


def _product(one: Dimension, other: Dimension) -> Dimension:
    total = {name: one.get(name, 0) + other.get(name, 0) for name in {*one, *other}}
    return {name: power for name, power in total.items() if power}


def _atom(name: str) -> Dimension:
    if name in _BASE:
        text = _BASE[name]
        if text == name:
            return {name: Fraction(1)}
        return parse(text) if text else {}
    if len(name) > 1 and name[0] in _PREFIX and name[1:] in _BASE:
        return _atom(name[1:])
    # A unit of the user's own.
    return {name: Fraction(1)}


def parse(text: str) -> Dimension:
    """Dimension of a unit such as `kg m/s^2`, `N s/m` or `1`; what follows `/` divides."""
    dimension: Dimension = {}
    sign = 1
    for token in re.findall(r"/|[^\s/*]+", text):
        if token == "/":
            sign = -1
            continue
        match = re.fullmatch(r"([A-Za-z%]+|1)(?:\^?(-?\d+(?:\.\d+)?))?", token)
        if not match:
            raise ValueError(f"the unit `{text}` has `{token}`, expected names and powers such as "
                             "`kg m/s^2`")
        exponent = Fraction(match.group(2) or 1) * sign
        dimension = _product(dimension, _power(_atom(match.group(1)), exponent))
    return dimension


def written(dimension: Dimension) -> str:
    """A dimension in base units."""
    parts = [name if power == 1 else f"{name}^{float(power):g}"
             for name, power in sorted(dimension.items())]
    return " ".join(parts) or "1"


def plain(unit: str) -> str:
    """The unit in base units, without `/`."""
    return written(parse(unit))


def over(unit: str, by: str) -> str:
    """The unit of a size: that of its channel over that of its term."""
    return written(_product(parse(unit), _power(parse(by), -1)))


def per_s(unit: str) -> str:
    """The unit of a rate."""
    return over(unit, "s")


class Disagree(Exception):
    """Two dimensions that must be equal are not."""


_SAME = {ca.OP_ADD, ca.OP_SUB, ca.OP_FMIN, ca.OP_FMAX, ca.OP_HYPOT, ca.OP_FMOD, ca.OP_REMAINDER,
         ca.OP_COPYSIGN}
_KEEPS = {ca.OP_NEG, ca.OP_TWICE, ca.OP_FABS, ca.OP_ASSIGN}
_COMPARES = {ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE}


def of(expression: ca.SX, symbols: list[ca.SX], units: list[str]) -> Dimension | None:
    """Dimension of a scalar expression of symbols with these units.

    `None` where it holds numbers of no known dimension; a number takes that of its partner in a sum.
    Raises `Disagree` where a sum, a comparison or an elementary function mixes dimensions.
    """
    function = ca.Function("dimension", [ca.vertcat(*symbols)], [expression])
    known = [parse(unit) if unit else None for unit in units]
    work: dict[int, Dimension | None] = {}
    numbers: dict[int, float] = {}
    result: Dimension | None = None
    for k in range(function.n_instructions()):
        op = function.instruction_id(k)
        to, args = function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_OUTPUT:
            result = work[args[0]]
            continue
        if op == ca.OP_CONST:
            numbers[to[0]] = function.instruction_constant(k)
            work[to[0]] = None
            continue
        exponent = numbers.get(args[1]) if len(args) > 1 else None
        numbers.pop(to[0], None)
        work[to[0]] = known[args[1]] if op == ca.OP_INPUT else _step(
            op, [work[arg] for arg in args], exponent)
    return result


def _step(op: int, operands: list[Dimension | None], exponent: float | None) -> Dimension | None:
    one = operands[0]
    if op in _SAME or op in _COMPARES:
        other = operands[1]
        if one is not None and other is not None and one != other:
            raise Disagree(f"`{written(one)}` meets `{written(other)}`")
        return {} if op in _COMPARES else (one if other is None else other)
    if op in _KEEPS:
        return one
    if op == ca.OP_MUL:
        return None if None in operands and all(o in (None, {}) for o in operands) else _product(
            one or {}, operands[1] or {})
    if op == ca.OP_DIV:
        return None if None in operands and all(o in (None, {}) for o in operands) else _product(
            one or {}, _power(operands[1] or {}, -1))
    if op == ca.OP_INV:
        return None if one is None else _power(one, -1)
    if op == ca.OP_SQ:
        return None if one is None else _power(one, 2)
    if op == ca.OP_SQRT:
        return None if one is None else _power(one, Fraction(1, 2))
    if op in (ca.OP_POW, ca.OP_CONSTPOW):
        if one and exponent is not None:
            return _power(one, Fraction(exponent).limit_denominator(100))
        return None if one is None else {}
    if op == ca.OP_IF_ELSE_ZERO:
        return operands[1]
    if op in (ca.OP_SIGN, ca.OP_ATAN2, ca.OP_NOT, ca.OP_AND, ca.OP_OR):
        return {}
    if one:
        raise Disagree(f"a function of a number without a unit has an argument in `{written(one)}`")
    return {}
