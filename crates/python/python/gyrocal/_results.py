"""Results: attributes, plain data, frames and HTML."""

from __future__ import annotations

import json
import os
import textwrap
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from . import _gyrocal
from ._errors import InputError

if TYPE_CHECKING:
    import pandas as pd

    from ._record import Bench, Record

__all__ = [
    "Calibration",
    "Characteristics",
    "Diagnosis",
    "Fields",
    "Fleet",
    "Plan",
    "PlantDiagnosis",
    "Result",
    "Simulation",
    "report",
]


class Fields:
    """An object of the JSON contract; its keys are attributes."""

    __slots__ = ("_fields",)
    _fields: dict[str, Any]

    def __init__(self, fields: dict[str, Any]) -> None:
        object.__setattr__(self, "_fields", fields)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
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
        return json.loads(json.dumps(self._fields))


def _wrapped(value: Any) -> Any:
    if isinstance(value, dict):
        return Fields(value)
    if isinstance(value, list):
        return [_wrapped(element) for element in value]
    return value


class Result(Fields):
    """A result. Its keys, those of the JSON contract of the command, are attributes.

    ``str`` gives the first screen and the sections of the page; a notebook shows them.
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
        return json.loads(self._text)

    def to_json(self) -> str:
        """The result as JSON."""
        return self._text

    def to_dataframe(self) -> pd.DataFrame:
        """The main table of the result as a pandas frame."""
        import pandas as pd

        return pd.DataFrame(self._rows())

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

    def _shown(self) -> list[dict[str, Any]]:
        """Sentences and tables."""
        return json.loads(_gyrocal.words_of(type(self).__name__, self._text))

    def __str__(self) -> str:
        return _gyrocal.text_of(json.dumps(self._shown())).rstrip("\n")

    def __repr__(self) -> str:
        return f"<gyrocal.{type(self).__name__}>"

    def _repr_html_(self) -> str:
        return _gyrocal.html_of(json.dumps(self._shown()))


def report(results: Result | Iterable[Result], path: str | os.PathLike[str]) -> None:
    """Writes results as one HTML page, one file that needs no network.

    Args:
        results: A result, or several in the order of the page: of :func:`gyrocal.calibrate`,
            :func:`gyrocal.diagnose`, :func:`gyrocal.plan`, :func:`gyrocal.fleet.summarise` and
            :meth:`gyrocal.Plant.diagnose`.
        path: The file to write.

    Raises:
        InputError: There is no page of such a result, or there is no result.
    """
    given = [results] if isinstance(results, Result) else list(results)
    for one in given:
        if not isinstance(one, Result):
            raise InputError(
                f"report: found a {type(one).__name__}, expected results",
                found=type(one).__name__,
                expected="results",
                advice="give what calibrate, diagnose, plan, fleet.summarise or Plant.diagnose returned",
            )
    if not given:
        raise InputError(
            "report: found no result, expected one or more",
            found="no result",
            expected="one or more",
            advice="give what calibrate, diagnose, plan, fleet.summarise or Plant.diagnose returned",
        )
    page = _gyrocal.report([(type(one).__name__, one.to_json(), one._page()) for one in given])
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(page)


class Diagnosis(Result):
    """Result of :func:`gyrocal.diagnose`."""

    __slots__ = ("_scores",)
    _scores: bytes | None
    verdict: str
    record: Fields
    setup: list[Fields]
    findings: list[Fields]
    ranking: list[Fields]
    set_ups: Fields | None
    gain: Fields | None
    remainder: Fields
    threshold: float | None
    search_complete: bool

    def __init__(self, text: str, scores: bytes | None = None) -> None:
        super().__init__(text)
        object.__setattr__(self, "_scores", None if scores is None else bytes(scores))

    def __reduce__(self) -> tuple[Any, ...]:
        kind, arguments = super().__reduce__()
        return kind, (*arguments, self._scores)

    @property
    def scores(self) -> bytes | None:
        """Scores of the record on all effects that it does not show by itself.

        They are what :func:`gyrocal.fleet.summarise` pools; ``None`` of a record that was not searched.
        """
        return self._scores

    def _rows(self) -> list[dict[str, Any]]:
        """One row a finding; the parameters are columns."""
        return _finding_rows(self._fields["findings"])

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.Diagnosis {self.verdict}{': ' + effects if effects else ''}>"


class Calibration(Result):
    """Result of :func:`gyrocal.calibrate`."""

    __slots__ = ()
    verdict: str
    verdict_text: str
    coefficients: list[Fields]
    nis_mean: float | None
    nis_band: list[float] | None
    rows: int
    method: str
    effects: list[Fields]
    setup: list[Fields]
    runs: list[Fields]
    records: list[Fields]
    usable: bool

    @property
    def names(self) -> list[str]:
        """Names of the coefficients, in the order of ``covariance``."""
        return [coefficient["name"] for coefficient in self._fields["coefficients"]]

    @property
    def estimates(self) -> NDArray[np.float64]:
        """The coefficients."""
        return np.array([one["estimate"] for one in self._fields["coefficients"]])

    @property
    def sigmas(self) -> NDArray[np.float64]:
        """Their standard deviations."""
        return np.array([one["sigma"] for one in self._fields["coefficients"]])

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Their covariance."""
        return np.array(self._fields["covariance"])

    def _rows(self) -> list[dict[str, Any]]:
        """One row a coefficient."""
        return self.to_dict()["coefficients"]

    def __repr__(self) -> str:
        return f"<gyrocal.Calibration {self.verdict}: {len(self.names)} coefficients>"


class Plan(Result):
    """Result of :func:`gyrocal.plan`."""

    __slots__ = ()
    aim: str
    now: Fields
    proposals: list[Fields]
    going_on: list[Fields]
    goal: Fields | None
    setup: list[Fields]

    def _rows(self) -> list[dict[str, Any]]:
        """One row a proposed run."""
        rows = []
        for run in self._fields["proposals"]:
            angles = run["initial_angles_deg"] or [None] * 3
            row = dict(zip(("angle_x_deg", "angle_y_deg", "angle_z_deg"), angles))
            row["hours"] = run["duration_s"] / 3600.0
            row["sigma_ratio"] = run["outlook"]["sigma_ratio"]
            for one in run["outlook"]["coefficients"]:
                row[one["name"] + "_sigma"] = one["sigma"]
            rows.append(row)
        return rows

    def __repr__(self) -> str:
        return f"<gyrocal.Plan by {self.aim}: {len(self._fields['proposals'])} runs>"


class Characteristics(Result):
    """Result of :func:`gyrocal.characterise`."""

    __slots__ = ()
    cells: list[Fields]

    @property
    def holds(self) -> bool:
        """Whether every figure that has a target meets it."""
        return all(row["holds"] is not False for row in self._rows())

    def _rows(self) -> list[dict[str, Any]]:
        """One row a figure."""
        keys = ("cell", "figure", "target", "measured", "interval", "runs", "holds", "too_few")
        figures = (one for cell in self._fields["cells"] for one in cell["characteristics"])
        return [{key: one.get(key) for key in keys} for one in figures]

    def _shown(self) -> list[dict[str, Any]]:
        heads = ["cell", "figure", "measured", "runs", "holds"]
        words = {True: "yes", False: "no", None: ""}
        cells = [
            [
                str(row["cell"]),
                str(row["figure"]),
                "" if row["measured"] is None else f"{row['measured']:.4g}",
                str(row["runs"]),
                words[row["holds"]],
            ]
            for row in self._rows()
        ]
        return [_table("Operating characteristics", heads, ("measured", "runs"), cells)]

    def __repr__(self) -> str:
        return f"<gyrocal.Characteristics: {len(self._fields['cells'])} cells>"


class Fleet(Result):
    """Result of :func:`gyrocal.fleet.summarise`."""

    __slots__ = ()
    units: int
    records: int
    not_settled: int
    problems: list[Fields]
    false_discovery_rate: float
    group_probability: float
    outlier_probability: float
    coefficients: list[Fields]
    groups: list[Fields]
    recurring: list[Fields]
    found_in_units: list[Fields]

    def _rows(self) -> list[dict[str, Any]]:
        """One row a coefficient."""
        rows = []
        for one in self._fields["coefficients"]:
            row = {"name": one["name"], "unit": one["unit"]}
            for key in ("mean", "spread", "repeatability", "ageing", "ageing_spread"):
                found = one[key]
                row[key] = None if found is None else found["estimate"]
                low, high = (None, None) if found is None else found["interval"]
                row[f"{key}_low"], row[f"{key}_high"] = low, high
            row["outliers"] = [outlier["unit"] for outlier in one["outliers"]]
            rows.append(row)
        return rows

    def __repr__(self) -> str:
        effects = ", ".join(cause["effect"] for cause in self._fields["recurring"])
        groups = ", ".join(one["group"]["name"] for one in self._fields["groups"])
        found = "; ".join(filter(None, (effects, groups)))
        return f"<gyrocal.Fleet of {self.units} units{': ' + found if found else ''}>"


class PlantDiagnosis(Result):
    """Result of :meth:`gyrocal.Plant.diagnose`. The page of one that was pickled has no charts."""

    __slots__ = ("_charts",)
    _charts: _gyrocal.PlantPage | None
    verdict: str
    record: Fields
    findings: list[Fields]
    coefficients: Fields
    open_loop: list[Fields]
    noise: list[Fields]
    undetermined: list[Fields]
    gain: Fields | None
    remainder: Fields
    later_record: Fields | None

    def __init__(self, text: str, charts: _gyrocal.PlantPage | None = None) -> None:
        super().__init__(text)
        object.__setattr__(self, "_charts", charts)

    @property
    def plant(self) -> str:
        """Name of the plant."""
        return str(self._fields["subject"]["plant"])

    def _page(self) -> _gyrocal.PlantPage | None:
        return self._charts

    def _rows(self) -> list[dict[str, Any]]:
        """One row a finding; its parameters are columns."""
        return _finding_rows(self._fields["findings"])

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.PlantDiagnosis of {self.plant}, {self.verdict}{': ' + effects if effects else ''}>"


class Simulation(Result):
    """Result of :func:`gyrocal.simulate`: the truth, and the record and bench description made of it."""

    __slots__ = ("_bench", "_record")
    _bench: Bench
    _record: Record
    coefficients: list[Fields]
    hidden: list[Fields]
    rows: int
    #: Keys of the record of the simulation, which are no attributes of the truth.
    _own: ClassVar[tuple[str, ...]] = ("record", "bench")

    def __init__(self, text: str, record: Record, bench: Bench) -> None:
        super().__init__(text)
        object.__setattr__(self, "_record", record)
        object.__setattr__(self, "_bench", bench)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, self._record, self._bench)

    @property
    def record(self) -> Record:
        """The record."""
        return self._record

    @property
    def bench(self) -> Bench:
        """The bench description: what the operator knows."""
        return self._bench

    def _rows(self) -> list[dict[str, Any]]:
        """One row a true coefficient."""
        return self.to_dict()["coefficients"]

    def _shown(self) -> list[dict[str, Any]]:
        hidden = [
            f"{one['effect']} ("
            + ", ".join(f"{p['name']} {p['value']:g} {p['unit']}" for p in one["parameters"])
            + ")"
            for one in self._fields["hidden"]
        ]
        blocks: list[dict[str, Any]] = [
            {"paragraph": f"A simulated record of {self.rows} rows, seed {self.manifest.seed}."}
        ]
        if hidden:
            blocks.append({"list": {"title": "Hidden effects", "entries": hidden}})
        return blocks

    def __repr__(self) -> str:
        return f"<gyrocal.Simulation: {self.rows} rows, seed {self.manifest.seed}>"


def _finding_rows(findings: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """One row a finding; the parameters are columns."""
    keys = ("effect", "name", "kind", "formula", "z", "p_value", "coverage", "gain_nats", "accepted")
    rows = []
    for finding in findings:
        row = {key: finding[key] for key in keys if key in finding}
        row["alternatives"] = [other["effect"] for other in finding["alternatives"]]
        for parameter in finding["parameters"]:
            row[parameter["name"]] = parameter["estimate"]
            row[parameter["name"] + "_sigma"] = parameter["sigma"]
            row[parameter["name"] + "_unit"] = parameter["unit"]
        rows.append(row)
    return rows


def _table(title: str, heads: list[str], numbers: tuple[str, ...], rows: list[list[str]]) -> dict[str, Any]:
    """A table of plain cells, as those of the library."""
    columns = [{"head": head, "is_number": head in numbers} for head in heads]
    cells = [[{"text": text, "strong": False} for text in row] for row in rows]
    return {"table": {"title": title, "columns": columns, "rows": cells}}
