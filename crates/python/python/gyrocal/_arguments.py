"""Arguments of the functions: what they hold, and a call in words."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from numbers import Integral, Number, Real
from typing import Any

import numpy as np

from ._errors import refusal
from ._record import Bench, Record

__all__ = ["as_list", "call", "check", "is_rows"]


def call(function: Callable[..., Any], given: Mapping[str, Any]) -> str:
    """Checks the arguments, and gives the call in words for the manifest, without defaults.

    `given` are all arguments of the function by name. What is no list but may be iterated is made one before.
    """
    words = []
    for name, default, by_name in _parameters(function):
        value = given[name]
        if value is not default:
            check(name, value)
        if not _is_default(value, default):
            words.append(f"{name}={_shown(value)}" if by_name else _shown(value))
    public = [part for part in function.__module__.split(".") if not part.startswith("_")]
    return f"{'.'.join(public)}.{function.__qualname__}({', '.join(words)})"


def as_list(value: Any) -> Any:
    """The elements of what may be iterated; a text, and what may not be, as it is: :func:`check` refuses it."""
    if isinstance(value, (str, bytes, Mapping)):
        return value
    try:
        return list(value)
    except TypeError:
        return value


def check(name: str, value: Any) -> None:
    """Refuses a value that the argument of this name cannot have."""
    expected, fits = _KINDS.get(name, ("", _is_anything))
    if not fits(value):
        advice = f"give [{value!r}]" if isinstance(value, str) and expected.startswith("a list") else None
        raise refusal(name, _shown(value), expected, advice)


def is_rows(value: Sequence[Any]) -> bool:
    """Whether these are the rows of one array, and not several things."""
    first = value[0] if len(value) > 0 else None
    if isinstance(first, (list, tuple)):
        return all(isinstance(one, Number) for one in first)
    return isinstance(first, np.ndarray) and first.ndim == 1


def _is_anything(_: Any) -> bool:
    return True


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _is_integer(value: Any, least: int) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool) and least <= int(value) < 2**63


def _is_list(value: Any, fits: Callable[[Any], bool]) -> bool:
    return isinstance(value, list) and all(map(fits, value))


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _is_table(value: Any, fits: Callable[[Any], bool]) -> bool:
    return isinstance(value, Mapping) and all(map(_is_text, value)) and all(map(fits, value.values()))


def _is_pair(value: Any) -> bool:
    return not isinstance(value, (str, bytes)) and hasattr(value, "__len__") and len(value) == 2 and all(
        map(_is_number, value)
    )


#: What arguments hold, by their names, which mean the same in all functions: in words, and as a test.
_KINDS: dict[str, tuple[str, Callable[[Any], bool]]] = {
    name: (expected, fits)
    for names, expected, fits in (
        ("aim", "set or sigmas", _is_text),
        ("method", "batch, streaming or paper", _is_text),
        ("noise factorised one_name one_step", "True or False", lambda value: isinstance(value, (bool, np.bool_))),
        (
            "alpha false_alarm false_discovery_rate group_probability outlier_probability",
            "a probability between 0 and 1",
            lambda value: _is_number(value) and 0.0 < value < 1.0,
        ),
        (
            "average_s robust_sigmas",
            "a positive number",
            lambda value: _is_number(value) and 0.0 < value < float("inf"),
        ),
        ("seed first_rows", "an integer of at least 0 and below 2^63", lambda value: _is_integer(value, 0)),
        ("runs threads", "an integer of at least 1 and below 2^63", lambda value: _is_integer(value, 1)),
        ("effects methods cells", "a list of names", lambda value: _is_list(value, _is_text)),
        ("hours", "a number of hours, or a list of them", lambda value: _is_list(value, _is_number)),
        (
            "limits_deg",
            "two numbers for each axis, such as {'x': (-30, 30)}",
            lambda value: _is_table(value, _is_pair),
        ),
        (
            "sigmas",
            "a number for each coefficient, such as {'gyro_x.bias': 1e-4}",
            lambda value: _is_table(value, _is_number),
        ),
        (
            "scenario",
            "a path, or the tables of a scenario file",
            lambda value: isinstance(value, (str, os.PathLike, Mapping)),
        ),
    )
    for name in names.split()
}


@cache
def _parameters(function: Callable[..., Any]) -> list[tuple[str, Any, bool]]:
    """Name and default of each parameter, and whether it is given by name."""
    every = inspect.signature(function).parameters.values()
    return [(one.name, one.default, one.kind is one.KEYWORD_ONLY) for one in every if one.name != "self"]


def _is_default(value: Any, default: Any) -> bool:
    # Arrays and frames compare element by element.
    if isinstance(value, (list, tuple)):
        return default == () and len(value) == 0
    return value is default or (isinstance(value, (str, Number)) and bool(value == default))


def _shown(value: Any) -> str:
    """A value in words: settings and names as they are, of data the type."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, os.PathLike):
        return repr(os.fspath(value))
    if isinstance(value, (str, Number)) or value is None:
        return repr(value)
    if isinstance(value, (Record, Bench)):
        return value.name
    if isinstance(value, (list, tuple)) and not is_rows(value):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, Mapping) and all(map(_is_setting, value.values())):
        return f"{{{', '.join(f'{key!r}: {_shown(one)}' for key, one in value.items())}}}"
    return f"<{type(value).__name__}>"


def _is_setting(value: Any) -> bool:
    """Whether a value of a mapping is a number or a pair of them, and no column of a record."""
    if isinstance(value, (list, tuple)):
        return len(value) == 2 and all(isinstance(one, Number) for one in value)
    return isinstance(value, Number)
