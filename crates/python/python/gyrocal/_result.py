"""What all results are: attributes, plain data, text, frames and pages."""

from __future__ import annotations

import json
import os
import textwrap
from collections.abc import Iterable, Iterator
from typing import Any

from . import _gyrocal
from ._arguments import as_list
from ._errors import refusal
from ._table import Table

__all__ = ["Fields", "Result", "report"]


class Fields:
    """An object of the JSON contract; its keys are attributes.

    >>> import gyrocal
    >>> one = gyrocal.Fields({"effect": "gyro_y.g_z", "parameters": [{"estimate": 0.02}]})
    >>> one.parameters[0].estimate, one["effect"], list(one)
    (0.02, 'gyro_y.g_z', ['effect', 'parameters'])
    """

    __slots__ = ("_fields",)
    _fields: dict[str, Any]

    def __init__(self, fields: dict[str, Any]) -> None:
        object.__setattr__(self, "_fields", fields)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        own = getattr(type(self), name, None)
        if isinstance(own, property):
            # It is asked again, for its own words why there is none.
            return own.__get__(self)
        try:
            return _wrapped(self._fields[name])
        except KeyError:
            known = ", ".join(self._fields)
            raise AttributeError(f"there is no `{name}`; there are {known}", name=name, obj=self) from None

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"`{name}` cannot be set: a result does not change")

    def __getitem__(self, name: str) -> Any:
        return _wrapped(self._fields[name])

    def __contains__(self, name: object) -> bool:
        return name in self._fields

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fields) and self._fields == other._fields

    def __hash__(self) -> int:
        return hash(json.dumps(self._fields, sort_keys=True))

    def __repr__(self) -> str:
        inside = ", ".join(f"{key}={value!r}" for key, value in self._fields.items())
        return f"Fields({textwrap.shorten(inside, 200, placeholder=' …')})"

    def to_dict(self) -> dict[str, Any]:
        """The same as plain data: a copy."""
        copied: dict[str, Any] = json.loads(json.dumps(self._fields))
        return copied


def _wrapped(value: Any) -> Any:
    if isinstance(value, dict):
        return Fields(value)
    if isinstance(value, list):
        return [_wrapped(element) for element in value]
    return value


class Result(Fields, Table):
    """A result. Its keys, those of the JSON contract of the command, are attributes.

    ``str`` gives the first screen and the sections of the page; a notebook shows them. The main table goes
    to pandas, Polars and Arrow.

    >>> import gyrocal
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> made.to_dict()["coefficients"][0]
    {'name': 'gyro_x.bias', 'value': 0.412, 'unit': 'deg/h'}
    >>> made.coefficients[0].value
    0.412
    """

    __slots__ = ("_text",)
    _text: str
    schema_version: int
    manifest: Fields

    def __init__(self, text: str) -> None:
        super().__init__(json.loads(text))
        object.__setattr__(self, "_text", text)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text,)

    def to_dict(self) -> dict[str, Any]:
        """The result as plain data, equal to the JSON that the command writes."""
        plain: dict[str, Any] = json.loads(self._text)
        return plain

    def to_json(self) -> str:
        """The result as JSON."""
        return self._text

    def summary(self) -> str:
        """What was found, how sure, and what to do next: the first screen of the command, as text."""
        first, _ = self._words()
        return _text(first)

    def report(self, path: str | os.PathLike[str]) -> None:
        """Writes the result as an HTML page, one file that needs no network.

        Raises:
            InputError: There is no page of such a result.
        """
        report([self], path)

    def _page(self) -> _gyrocal.PlantPage | None:
        """What a page needs beside the result."""
        return None

    def _rows(self) -> list[dict[str, Any]]:
        raise NotImplementedError

    def _columns(self) -> dict[str, Any]:
        rows = self._rows()
        names = dict.fromkeys(name for row in rows for name in row)
        return {name: [row.get(name) for row in rows] for name in names}

    def _words(self) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
        """The first screen, and the sections of the page, as sentences, lists and tables."""
        first, sections = _gyrocal.words_of(type(self).__name__, self._text)
        return json.loads(first), json.loads(sections)

    def _shown(self) -> list[dict[str, Any]]:
        first, sections = self._words()
        return first + sections

    def __str__(self) -> str:
        return _text(self._shown())

    def __repr__(self) -> str:
        return f"<gyrocal.{type(self).__name__}>"

    def _repr_html_(self) -> str:
        return _gyrocal.html_of(json.dumps(self._shown()))


def _text(words: list[dict[str, Any]]) -> str:
    return _gyrocal.text_of(json.dumps(words)).rstrip("\n")


def report(results: Result | Iterable[Result], path: str | os.PathLike[str]) -> None:
    """Writes results as one HTML page, one file that needs no network.

    Args:
        results: A result, or several in the order of the page: of :func:`gyrocal.calibrate`,
            :func:`gyrocal.diagnose`, :func:`gyrocal.plan`, :func:`gyrocal.characterise`,
            :func:`gyrocal.fleet.summarise`, :meth:`gyrocal.Plant.diagnose` and :meth:`gyrocal.Plant.fit`.
        path: The file to write.

    Raises:
        InputError: There is no page of such a result, or there is no result.

    >>> import gyrocal, pathlib, tempfile
    >>> found = gyrocal.calibrate("examples/data/three_days.csv", "examples/data/three_days.bench.toml")
    >>> page = pathlib.Path(tempfile.mkdtemp(), "page.html")
    >>> gyrocal.report([found], page)
    >>> "gyro_x.bias" in page.read_text(encoding="utf-8")
    True
    """
    given = as_list([results] if isinstance(results, Result) else results)
    wrong = [one for one in given if not isinstance(one, Result)] if isinstance(given, list) else [given]
    if wrong or not given:
        raise refusal(
            "results", f"a {type(wrong[0]).__name__}" if wrong else "no result", "a result, or a list of them",
            "give what calibrate, characterise, diagnose, plan, fleet.summarise, Plant.diagnose or Plant.fit returned",
        )
    page = _gyrocal.report([(type(one).__name__, one.to_json(), one._page()) for one in given])
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(page)
