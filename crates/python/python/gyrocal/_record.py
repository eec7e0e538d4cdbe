"""Records and bench descriptions, and what they are made of."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _gyrocal
from ._errors import refusal
from ._table import Table

__all__ = [
    "COLUMNS",
    "AxesLike",
    "Bench",
    "BenchLike",
    "Record",
    "RecordLike",
    "as_axes",
    "as_bench",
    "as_record",
]

#: The columns of a record; the last one is optional.
COLUMNS = ("time_s", "accel_x_g", "accel_y_g", "accel_z_g", "temperature_c")


class Record(Table):
    """Accelerometer samples of a platform that its gyros hold in inertial space.

    Specific force is in units of local gravity, up positive: an accelerometer at rest with its axis up
    reads +1. ``nan`` is a missing value. A record does not change.

    Args:
        time_s: Time of each row, s.
        accel_g: Specific force, one row a sample, along platform axes x, y, z, g.
        temperature_c: Temperature of each row, if it was logged, degrees Celsius.
        name: The name that errors and results give the record.

    >>> import gyrocal
    >>> record = gyrocal.Record([0.0, 60.0], [[0.0, 0.0, 1.0], [0.0, 0.001, 1.0]])
    >>> record.time_s.shape, record.accel_g.shape, record.temperature_c
    ((2,), (2, 3), None)
    >>> record.to_pandas().columns.tolist()
    ['time_s', 'accel_x_g', 'accel_y_g', 'accel_z_g']
    """

    __slots__ = ("_held",)
    _held: _gyrocal.Record

    def __init__(
        self,
        time_s: ArrayLike,
        accel_g: ArrayLike,
        temperature_c: ArrayLike | None = None,
        *,
        name: str = "<arrays>",
    ) -> None:
        samples = _numbers(accel_g, f"{name}, column `accel_g`")
        if samples.ndim != 2 or samples.shape[1] != 3:
            raise refusal(
                f"{name}, `accel_g`", f"the shape {samples.shape}", "(rows, 3)",
                "give one row a sample: np.column_stack([x, y, z])",
            )
        self._held = _gyrocal.Record.of_columns(
            name,
            _column(time_s, "time_s", name),
            [samples[:, axis] for axis in range(3)],
            None if temperature_c is None else _column(temperature_c, "temperature_c", name),
        )

    @classmethod
    def _of(cls, held: _gyrocal.Record) -> Record:
        record = cls.__new__(cls)
        record._held = held
        return record

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Record:
        """Reads a record from a file (CSV), whose columns are :data:`COLUMNS`.

        Raises:
            InputError: The file cannot be read, or a value of it is wrong: with line and column.
        """
        return cls._of(_gyrocal.Record.read(path))

    @classmethod
    def from_frame(cls, frame: Any, *, name: str | None = None) -> Record:
        """Takes a record from a frame, a table or a mapping of columns.

        The columns are :data:`COLUMNS`. An object with ``__arrow_c_stream__`` (Polars, PyArrow, DuckDB
        and others) is read through Arrow's C stream interface; of a pandas frame or a mapping each
        column is taken as a NumPy array.

        Args:
            frame: The columns: times in s, specific force in g, temperatures in degrees Celsius.
            name: The name that errors and results give the record; that of the type if it is not given.

        Raises:
            InputError: There is no such column, or a value is wrong.
        """
        if name is None:
            name = f"<{type(frame).__name__}>"
        refuse_no_frame(frame)
        if isinstance(frame, np.ndarray):
            return cls._of(_of_structured(frame, name))
        if isinstance(frame, Mapping):
            return cls._of(_of_mapping(frame, name))
        is_pandas = type(frame).__module__.partition(".")[0] == "pandas"
        if not is_pandas and hasattr(frame, "__arrow_c_stream__"):
            return cls._of(_gyrocal.Record.of_arrow(name, frame.__arrow_c_stream__()))
        if hasattr(frame, "columns") and hasattr(frame, "__getitem__"):
            names = [str(column) for column in frame.columns]
            _gyrocal.check_columns(names, name)
            return cls._of(_of_mapping({column: frame[column] for column in names}, name))
        raise refusal(
            name, f"a {type(frame).__name__}",
            "a path, a Record, a frame, an Arrow table or a mapping of columns",
            "give {'time_s': ..., 'accel_x_g': ..., 'accel_y_g': ..., 'accel_z_g': ...}",
        )

    @property
    def name(self) -> str:
        """The name that errors and results give the record."""
        return self._held.name

    @property
    def sha256(self) -> str:
        """SHA-256 of the file or, of a record in memory, of its values."""
        return self._held.sha256

    @property
    def time_s(self) -> NDArray[np.float64]:
        """Time of each row, (rows,), s; a view."""
        return self._held.time_s

    @property
    def accel_g(self) -> NDArray[np.float64]:
        """Specific force along x, y, z, (rows, 3), g; a view."""
        return self._held.accel_g

    @property
    def temperature_c(self) -> NDArray[np.float64] | None:
        """Temperature of each row, if it was logged, (rows,), degrees Celsius; a view."""
        return self._held.temperature_c

    def columns(self) -> dict[str, NDArray[np.float64]]:
        """The columns by name, as views: what frames of any kind are made of."""
        columns = {"time_s": self.time_s}
        columns |= {name: self.accel_g[:, axis] for axis, name in enumerate(COLUMNS[1:4])}
        if self.temperature_c is not None:
            columns[COLUMNS[4]] = self.temperature_c
        return columns

    def _columns(self) -> dict[str, NDArray[np.float64]]:
        return self.columns()

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Writes the record to a file, which reads as the same numbers."""
        _write(path, self._held.to_csv())

    def __len__(self) -> int:
        return len(self._held)

    def __repr__(self) -> str:
        days = float(self.time_s[-1] - self.time_s[0]) / 86400.0 if len(self) else 0.0
        return f"<gyrocal.Record {self.name}: {len(self)} rows over {days:.2f} days>"

    def __reduce__(self) -> tuple[Any, ...]:
        arrays = (self.time_s, self.accel_g, self.temperature_c)
        return _record_of_arrays, (*(np.array(a) if a is not None else None for a in arrays), self.name)


def _record_of_arrays(time_s: Any, accel_g: Any, temperature_c: Any, name: str) -> Record:
    return Record(time_s, accel_g, temperature_c, name=name)


class Bench:
    """Description of a bench: site, first attitude, noise and prior, as in a bench file.

    Args:
        tables: The tables of a bench file, for example ``{"site": {"latitude_deg": 39.1}, ...}``.
        name: The name that errors and results give it.

    >>> import gyrocal
    >>> bench = gyrocal.Bench.read("examples/data/three_days.bench.toml")
    >>> bench.latitude_deg, gyrocal.Bench(bench.to_dict()).latitude_deg
    (48.2, 48.2)
    """

    __slots__ = ("_held",)
    _held: _gyrocal.Bench

    def __init__(self, tables: Mapping[str, Any], *, name: str = "<bench>") -> None:
        self._held = _gyrocal.Bench.of_json(_json(tables, name), name)

    @classmethod
    def _of(cls, held: _gyrocal.Bench) -> Bench:
        bench = cls.__new__(cls)
        bench._held = held
        return bench

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Bench:
        """Reads a bench file (TOML)."""
        return cls._of(_gyrocal.Bench.read(path))

    @classmethod
    def parse(cls, text: str, *, name: str = "<bench>") -> Bench:
        """Takes the text of a bench file."""
        return cls._of(_gyrocal.Bench.of_text(text, name))

    @property
    def name(self) -> str:
        """The name that errors and results give it."""
        return self._held.name

    @property
    def latitude_deg(self) -> float:
        """Latitude, north positive, deg."""
        return self._held.latitude_deg

    def to_dict(self) -> dict[str, Any]:
        """The tables of a bench file."""
        import tomllib

        return tomllib.loads(self.to_toml())

    def to_toml(self) -> str:
        """The text of a bench file."""
        return self._held.to_toml()

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes a bench file."""
        _write(path, self.to_toml())

    def __repr__(self) -> str:
        return f"<gyrocal.Bench {self.name}: latitude {self.latitude_deg} deg>"

    def __reduce__(self) -> tuple[Any, ...]:
        return _bench_of_text, (self.to_toml(), self.name)


def _bench_of_text(text: str, name: str) -> Bench:
    return Bench.parse(text, name=name)


RecordLike = Union[Record, str, "os.PathLike[str]", Mapping[str, Any], Any]
BenchLike = Union[Bench, str, "os.PathLike[str]", Mapping[str, Any]]
AxesLike = Union[str, "os.PathLike[str]", NDArray[Any], Sequence[Sequence[float]]]


def as_record(record: RecordLike) -> Record:
    """The record itself, or what a path, frame, table or mapping gives."""
    if isinstance(record, Record):
        return record
    if isinstance(record, (str, os.PathLike)):
        return Record.read(record)
    return Record.from_frame(record)


def as_bench(bench: BenchLike) -> Bench:
    """The bench description itself, or what a path or the tables of a bench file give."""
    if isinstance(bench, Bench):
        return bench
    if isinstance(bench, (str, os.PathLike)):
        return Bench.read(bench)
    if isinstance(bench, Mapping):
        return Bench(bench)
    raise refusal(
        "bench", f"a {type(bench).__name__}", "a path, a Bench or the tables of a bench file",
        "give {'site': {...}, 'platform': {...}, 'noise': {...}}",
    )


def refuse_no_frame(record: Any) -> None:
    """Refuses a list of records where one is taken, and a frame that is not read yet."""
    if type(record).__name__ == "LazyFrame":
        raise refusal("record", "a LazyFrame", "a frame that holds its rows", "give frame.collect()")
    if isinstance(record, (list, tuple)):
        raise refusal(
            "record", f"a {type(record).__name__} of {len(record)}", "one record",
            "calibrate takes several; diagnoses and plans of several records are made by the command",
        )


def as_axes(axes: AxesLike, name: str) -> NDArray[np.float64] | str:
    """The path of a file of axes, or the quaternions as an array of two dimensions.

    `name` is that of the argument, for errors.
    """
    if isinstance(axes, (str, os.PathLike)):
        return os.fspath(axes)
    array = _numbers(axes, name)
    if array.ndim != 2 or array.shape[1] != 4:
        raise refusal(
            name, f"the shape {array.shape}", "(rows, 4)",
            "give one quaternion a row: np.column_stack([q_w, q_x, q_y, q_z])",
        )
    return array


def _of_structured(array: NDArray[Any], name: str) -> _gyrocal.Record:
    if array.dtype.names is None:
        raise refusal(
            name, f"an array of {array.dtype} without names of columns", "named columns",
            "give Record(time_s, accel_g), or a mapping of columns",
        )
    return _of_mapping({column: array[column] for column in array.dtype.names}, name)


def _of_mapping(columns: Mapping[str, Any], name: str) -> _gyrocal.Record:
    _gyrocal.check_columns([str(column) for column in columns], name)
    arrays = {column: _column(values, column, name) for column, values in columns.items()}
    return _gyrocal.Record.of_columns(
        name,
        arrays["time_s"],
        [arrays[column] for column in COLUMNS[1:4]],
        arrays.get(COLUMNS[4]),
    )


def _column(values: Any, column: str, name: str) -> NDArray[np.float64]:
    place = f"{name}, column `{column}`"
    array = _numbers(values, place)
    if array.ndim != 1:
        raise refusal(place, f"{array.ndim} dimensions", "one", "give one column")
    return array


def _numbers(values: Any, place: str) -> NDArray[np.float64]:
    """The values as float64: a view where they are that already. `place` is for errors."""
    if hasattr(values, "to_numpy"):
        kind = getattr(values, "dtype", None)
        # Nullable columns of pandas: a missing value is a masked one.
        nullable = hasattr(kind, "na_value") and getattr(kind, "kind", "O") in "iuf"
        array = values.to_numpy(dtype=np.float64, na_value=np.nan) if nullable else values.to_numpy()
    else:
        array = _array(values, place)
    if array.dtype.kind in "iuf":
        numbers: NDArray[np.float64] = array.astype(np.float64, copy=False)
        return numbers
    advice = {
        "M": "give seconds: (t - t[0]) / np.timedelta64(1, 's')",
        "m": "give seconds: t / np.timedelta64(1, 's')",
        "O": "the column holds other things than numbers: pandas.to_numeric(column) shows which",
        "b": "give numbers",
    }.get(array.dtype.kind, "convert the column to float64")
    raise refusal(place, f"the type {array.dtype}", "float64", advice)


def _array(values: Any, place: str) -> NDArray[Any]:
    try:
        return np.asarray(values)
    except ValueError as error:
        raise refusal(
            place, "rows of different lengths", "an array", "give as many values in each row"
        ) from error


def _json(tables: Mapping[str, Any], name: str) -> str:
    return json.dumps(_plain(tables, name, ""))


def _plain(value: Any, name: str, place: str) -> Any:
    """The value as JSON has it; `place` is its key, for errors."""
    if isinstance(value, Mapping):
        return {
            str(key): _plain(inner, name, f"{place}.{key}".lstrip("."))
            for key, inner in value.items()
        }
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(inner, name, place) for inner in value]
    if isinstance(value, float) and not np.isfinite(value):
        raise refusal(f"{name}, `{place}`", f"{value}", "a finite number", "leave out what is not known")
    if isinstance(value, (bool, int, float, str)):
        return value
    advice = "leave out what is not given" if value is None else "give numbers, strings, lists and tables"
    found = "None" if value is None else f"a {type(value).__name__}"
    raise refusal(f"{name}, `{place}`", found, "a value of TOML", advice)


def _write(path: str | os.PathLike[str], text: str) -> None:
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(text)
