"""Any plant: its equations from CasADi, its records, what its model lacks."""

from __future__ import annotations

import hashlib
import os
import warnings
from collections.abc import Mapping
from numbers import Real
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from . import _gyrocal
from ._arguments import call
from ._errors import GyrocalWarning, InputError, refusal
from ._plant_results import PlantDiagnosis, PlantFit
from ._record import _column, _json, refuse_no_frame

__all__ = ["Plant"]

#: A column of a record: its name, or a mapping with ``column``, ``factor`` and ``offset``.
Source = Union[str, Mapping[str, Any]]

#: An input by its name and the hash of its content.
Input = tuple[str, str]


class Plant:
    """A plant whose functions are interpreted: nothing is compiled for it.

    Args:
        declared: The plant as ``gyrocal_plant.Plant`` declares it, with its functions of CasADi and its
            catalogue of effects, or the path of the program file that such a declaration writes.

    >>> import gyrocal
    >>> plant = gyrocal.Plant("examples/duffing/plant.json")
    >>> plant.name, plant.inputs, plant.outputs
    ('Duffing', ['u'], ['y'])
    """

    __slots__ = ("_held", "_program")
    _held: _gyrocal.Plant
    _program: tuple[str, str]

    def __init__(self, declared: Any) -> None:
        if isinstance(declared, (str, os.PathLike)):
            name = os.fspath(declared)
            text = _text(_read(declared), name)
        elif hasattr(declared, "to_json"):
            name, text = f"<{type(declared).__name__}>", declared.to_json()
        else:
            raise refusal(
                "plant", f"a {type(declared).__name__}", "a declared plant or a program file",
                "declare it with gyrocal_plant.Plant (docs/any-plant.md)",
            )
        self._set(text, name)

    def _set(self, text: str, name: str) -> None:
        self._program = (text, name)
        self._held = _gyrocal.Plant.of_program(text, name)

    @property
    def name(self) -> str:
        """Its name."""
        return self._held.name

    @property
    def inputs(self) -> list[str]:
        """Names of its inputs."""
        return self._held.inputs

    @property
    def outputs(self) -> list[str]:
        """Names of its outputs."""
        return self._held.outputs

    @property
    def regressors(self) -> list[str]:
        """Names of the logged quantities that it depends on."""
        return self._held.regressors

    @property
    def effects(self) -> list[str]:
        """Ids of the effects of its catalogue."""
        return self._held.effects

    def diagnose(
        self,
        record: Any,
        columns: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        *,
        later: Any = None,
        later_columns: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        false_alarm: float = 0.01,
    ) -> PlantDiagnosis:
        """Shows what the model of the plant lacks in a record, and names the cause.

        Args:
            record: A CSV file, a frame of pandas or Polars, an Arrow table or a mapping of columns.
            columns: Its columns by the names of the plant: the tables ``time``, ``inputs``, ``outputs`` and
                ``regressors`` of a map file, or the path of one. Without it columns have the names of the
                plant, and time is ``time_s``.
            later: A later record of the same plant, to measure the gain of what is found.
            later_columns: Its columns, if they differ.
            false_alarm: Family-wise probability of a false alarm.

        Returns:
            The verdict, the findings with their sets, and the parameters in the units of the plant.

        Raises:
            InputError: A record, a column or an argument is wrong.
            ComputationError: The plant could not be fitted.

        >>> import gyrocal
        >>> plant = gyrocal.Plant("examples/duffing/plant.json")
        >>> columns = {"time": "time_s", "inputs": {"u": "drive_n"}, "outputs": {"y": "displacement_m"}}
        >>> plant.diagnose("examples/duffing/record.csv", columns)
        <gyrocal.PlantDiagnosis of Duffing, effects-found: v_rate.x^3>
        """
        command = call(Plant.diagnose, locals())
        given, inputs = self._record(record, columns)
        other, later_inputs = self._later(later, columns, later_columns)
        inputs += [self._input(), *later_inputs]
        _tell_gaps(given, other)
        return PlantDiagnosis(*self._held.diagnose(given, other, false_alarm, inputs, command))

    def fit(
        self,
        record: Any,
        columns: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        *,
        later: Any = None,
        later_columns: Mapping[str, Any] | str | os.PathLike[str] | None = None,
        first_rows: int = 0,
    ) -> PlantFit:
        """Fits the model of the plant to a record, and searches nothing.

        Args:
            record: A CSV file, a frame of pandas or Polars, an Arrow table or a mapping of columns.
            columns: Its columns by the names of the plant, as :meth:`diagnose` takes them.
            later: A later record of the same plant, which has no part in the fit.
            later_columns: Its columns, if they differ.
            first_rows: Rows at the beginning of each record that errors do not count. Those of a later record tell
                its initial states.

        Returns:
            The parameters and initial states in the units of the plant, their covariance, the likelihood with its
            criteria, the errors of simulations, and the outputs over time.

        Raises:
            InputError: A record, a column or an argument is wrong.
            ComputationError: The plant could not be fitted.

        >>> import gyrocal
        >>> plant = gyrocal.Plant("examples/duffing/plant.json")
        >>> columns = {"time": "time_s", "inputs": {"u": "drive_n"}, "outputs": {"y": "displacement_m"}}
        >>> plant.fit("examples/duffing/record.csv", columns)
        <gyrocal.PlantFit of Duffing: 5 coefficients>
        """
        command = call(Plant.fit, locals())
        given, inputs = self._record(record, columns)
        other, later_inputs = self._later(later, columns, later_columns)
        inputs += [*later_inputs, self._input()]
        _tell_gaps(given, other)
        return PlantFit(*self._held.fit(given, other, first_rows, inputs, command))

    def _record(self, record: Any, columns: Any) -> tuple[_gyrocal.PlantRecord, list[Input]]:
        """A record, and what the manifest tells of it and of its map."""
        found, own = self._columns(record, columns)
        return self._held.record(found), [own, *_input_of_map(columns)]

    def _later(
        self, later: Any, columns: Any, later_columns: Any
    ) -> tuple[_gyrocal.PlantRecord | None, list[Input]]:
        if later is None:
            return None, []
        if later_columns is not None:
            return self._record(later, later_columns)
        # Its map is that of the record, which is told already.
        found, inputs = self._record(later, columns)
        return found, inputs[:1]

    def _input(self) -> Input:
        """What the manifest tells of the plant."""
        program, name = self._program
        return name, _sha256(program.encode())

    def _columns(self, record: Any, columns: Any) -> tuple[dict[str, Any], Input]:
        """The columns of a record by the names of the plant, and what is told of it in the manifest."""
        frame, name, content = _frame(record)
        places = self._map(columns)

        def group(kind: str, names: list[str]) -> list[NDArray[np.float64]]:
            known = places.get(kind, {})
            unknown = [one for one in known if one not in names]
            if unknown:
                raise InputError(
                    f"columns: found the {kind[:-1]} `{unknown[0]}`, which the plant has not",
                    found=unknown[0],
                    expected=", ".join(names),
                )
            missing = [one for one in names if one not in known]
            if missing:
                raise InputError(
                    f"columns: found no column for the {kind[:-1]} `{missing[0]}`",
                    expected=missing[0],
                    advice=f"add it to `{kind}`",
                )
            return [_values(frame, known[one], name) for one in names]

        inputs = group("inputs", self.inputs)
        found = {
            "name": name,
            "input_columns": [_column_name(places["inputs"][one]) for one in self.inputs],
            "time_s": _values(frame, _time(places), name),
            "inputs": inputs,
            "outputs": group("outputs", self.outputs),
            "regressors": group("regressors", self.regressors),
        }
        if content is None:
            values = [found["time_s"], *found["inputs"], *found["outputs"], *found["regressors"]]
            content = b"".join(column.tobytes() for column in values)
        return found, (name, _sha256(content))

    def _map(self, columns: Any) -> Mapping[str, Any]:
        if columns is None:
            same = {kind: {one: one for one in getattr(self, kind)} for kind in _KINDS}
            return {"time": "time_s", **same}
        if isinstance(columns, Mapping):
            return columns
        if not isinstance(columns, (str, os.PathLike)):
            raise refusal("columns", f"a {type(columns).__name__}", "a path, or the tables of a map file")
        import tomllib

        try:
            return tomllib.loads(Path(columns).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise InputError(f"{os.fspath(columns)}: {error}", file=os.fspath(columns)) from error

    def __repr__(self) -> str:
        return f"<gyrocal.Plant {self.name}: {len(self.effects)} effects in its catalogue>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _of_program, self._program


#: Kinds of columns, as the tables of a map name them.
_KINDS = ("inputs", "outputs", "regressors")


def _of_program(text: str, name: str) -> Plant:
    plant = Plant.__new__(Plant)
    plant._set(text, name)
    return plant


def _tell_gaps(*records: _gyrocal.PlantRecord | None) -> None:
    """Warns, where a method of the plant is called, of inputs that a record does not tell for a while."""
    for words in (words for record in records if record is not None for words in record.bridged):
        warnings.warn(words, GyrocalWarning, stacklevel=3)


def _column_name(source: Source) -> str:
    """Name of a column, for words."""
    return str(source["column"] if isinstance(source, Mapping) else source)


def _time(places: Mapping[str, Any]) -> Source:
    if "time" not in places:
        raise InputError("columns: found no `time`", expected="time", advice="add `time` to the columns")
    time: Source = places["time"]
    return time


def _frame(record: Any) -> tuple[Any, str, bytes | None]:
    """Columns by name, the name of the record, and the bytes of its file."""
    if isinstance(record, (str, os.PathLike)):
        name, content = os.fspath(record), _read(record)
        return _csv(_text(content, name), name), name, content
    refuse_no_frame(record)
    if not isinstance(record, Mapping) and not any(hasattr(record, one) for one in ("columns", "column_names")):
        raise refusal(
            "record", f"a {type(record).__name__}", "a path, a frame, an Arrow table or a mapping of columns"
        )
    return record, f"<{type(record).__name__}>", None


def _read(path: str | os.PathLike[str]) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        name = os.fspath(path)
        raise InputError(f"{name}: cannot be read: {error.strerror}", file=name) from error


def _text(content: bytes, name: str) -> str:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{name}: found a byte that is no text: {error}", file=name) from error


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _input_of_map(columns: Any) -> list[Input]:
    """What the manifest tells of a map of columns, if there is one."""
    if columns is None:
        return []
    if isinstance(columns, Mapping):
        return [("<columns>", _sha256(_json(columns, "<columns>").encode()))]
    return [(os.fspath(columns), _sha256(_read(columns)))]


def _csv(text: str, name: str) -> dict[str, NDArray[np.float64]]:
    import csv

    rows = list(csv.reader(text.splitlines(), skipinitialspace=True))
    if not rows:
        raise InputError(f"{name}: found no header", file=name)
    header = [field.strip() for field in rows[0]]
    columns: dict[str, list[str]] = {field: [] for field in header}
    for line, row in enumerate(rows[1:], start=2):
        if len(row) != len(header):
            raise InputError(
                f"{name}:{line}: found {len(row)} fields, expected {len(header)}", file=name, line=line
            )
        for field, value in zip(header, row):
            columns[field].append(value.strip())
    return {field: np.array(values, dtype=object) for field, values in columns.items()}


def _values(frame: Any, source: Source, name: str) -> NDArray[np.float64]:
    place = dict(source) if isinstance(source, Mapping) else {"column": source}
    column = place.pop("column", None)
    factor, offset = place.pop("factor", 1.0), place.pop("offset", 0.0)
    if column is None or place or not (isinstance(factor, Real) and isinstance(offset, Real)):
        raise refusal("columns", repr(source), "a name, or column, factor and offset")
    names = list(getattr(frame, "column_names", ())) or list(getattr(frame, "columns", frame))
    if column not in names:
        raise InputError(
            f"{name}: found no column `{column}`",
            expected=column,
            advice=f"it has {', '.join(map(str, names))}",
        )
    found = frame[column]
    if isinstance(found, np.ndarray) and found.dtype == object and all(
        isinstance(value, str) for value in found
    ):
        found = _parsed(found, column, name)
    return float(factor) * np.ascontiguousarray(_column(found, column, name)) + float(offset)


def _parsed(texts: NDArray[Any], column: str, name: str) -> NDArray[np.float64]:
    """The numbers of a file; an empty field is a missing value."""
    values = np.empty(len(texts))
    for row, text in enumerate(texts):
        try:
            values[row] = float(text) if text else np.nan
        except ValueError as error:
            raise InputError(
                f"{name}: row {row + 1} has `{text}` in column `{column}`, expected a number",
                file=name,
                found=text,
            ) from error
    return values
