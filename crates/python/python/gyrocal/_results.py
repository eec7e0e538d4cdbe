"""The results, each with its attributes and its main table."""

from __future__ import annotations

import json
import os
from pathlib import Path
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from . import _gyrocal
from ._arguments import check
from ._errors import GyrocalError, InputError, refusal
from ._result import Fields, Result, report, table

if TYPE_CHECKING:
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
    "from_json",
    "report",
]


class _Estimates(Result):
    """Coefficients with their standard deviations, under the names of this package and of statsmodels."""

    __slots__ = ()

    def _estimated(self) -> list[dict[str, Any]]:
        raise NotImplementedError

    @property
    def names(self) -> list[str]:
        """Names of the coefficients, in the order of all arrays of them."""
        return [one["name"] for one in self._estimated()]

    @property
    def estimates(self) -> NDArray[np.float64]:
        """The coefficients, each in its unit."""
        return np.array([one["estimate"] for one in self._estimated()])

    @property
    def sigmas(self) -> NDArray[np.float64]:
        """Standard deviations of the coefficients, each in its unit."""
        return np.array([one["sigma"] for one in self._estimated()])

    @property
    def params(self) -> NDArray[np.float64]:
        """The same as ``estimates``."""
        return self.estimates

    @property
    def bse(self) -> NDArray[np.float64]:
        """The same as ``sigmas``."""
        return self.sigmas

    def conf_int(self, alpha: float = 0.05) -> NDArray[np.float64]:
        """Confidence intervals of the coefficients, from the normal distribution.

        Args:
            alpha: Probability that an interval misses.

        Returns:
            Lower and upper ends, (coefficients, 2), each in its unit.
        """
        check("alpha", alpha)
        reach = -NormalDist().inv_cdf(alpha / 2.0) * self.sigmas
        return np.column_stack([self.estimates - reach, self.estimates + reach])


class _Searched(_Estimates):
    """A search for effects; the coefficients are those with the accepted findings in the model."""

    __slots__ = ()

    def _estimated(self) -> list[dict[str, Any]]:
        found = self._fields["coefficients"]
        best: list[dict[str, Any]] = found["nominal"] if found["extended"] is None else found["extended"]
        return best

    @property
    def pvalues(self) -> dict[str, float]:
        """The p-value of each finding, corrected for the search, by its effect."""
        return {one["effect"]: one["p_value"] for one in self._fields["findings"]}

    def conf_int(self, alpha: float = 0.05) -> NDArray[np.float64]:
        """Confidence intervals of the coefficients.

        With findings they are those of the result, over all members of the confidence sets, where it holds them,
        and only of 95 %; otherwise from the normal distribution.

        Args:
            alpha: Probability that an interval misses.

        Returns:
            Lower and upper ends, (coefficients, 2), each in its unit.
        """
        over_set = self._fields["coefficients"]["over_set"]
        if over_set is None:
            return super().conf_int(alpha)
        check("alpha", alpha)
        if alpha != 0.05:
            raise refusal("alpha", repr(alpha), "0.05", "the result holds intervals of 95 %")
        return np.array([one["interval"] for one in over_set])

    def _rows(self) -> list[dict[str, Any]]:
        """One row a finding; its parameters are columns."""
        return _finding_rows(self._fields["findings"])


class Diagnosis(_Searched):
    """Result of :func:`gyrocal.diagnose`.

    ``findings`` are the named causes, each with ``parameters`` (``estimate``, ``sigma``, ``unit``) and
    ``alternatives``; the coefficients are those with the accepted findings in the model.

    >>> import gyrocal
    >>> found = gyrocal.diagnose("examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml")
    >>> found.verdict, [one.effect for one in found.findings]
    ('effects-found', ['gyro_y.g_z'])
    >>> found.conf_int().shape, found.pvalues["gyro_y.g_z"] < 1e-6
    ((9, 2), True)
    >>> print(found.summary().splitlines()[0])
    FAULT: gyro_y.g_z, mass unbalance of gyro y along the cross axis z (D_O or D_S):
    """

    __slots__ = ("_scores",)
    _scores: bytes | None
    verdict: str
    record: Fields
    setup: list[Fields]
    findings: list[Fields]
    ranking: list[Fields]
    coefficients: Fields
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

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance of the coefficients, (coefficients, coefficients), in products of their units."""
        return np.array(self._fields["coefficients"]["covariance"])

    def cov_params(self) -> NDArray[np.float64]:
        """The same as ``covariance``."""
        return self.covariance

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.Diagnosis {self.verdict}{': ' + effects if effects else ''}>"


class Calibration(_Estimates):
    """Result of :func:`gyrocal.calibrate`: nine drift coefficients in deg/h, deg/h/g and deg/h/g^2.

    >>> import gyrocal
    >>> found = gyrocal.calibrate("examples/data/three_days.csv", "examples/data/three_days.bench.toml")
    >>> found.names[:3]
    ['gyro_x.bias', 'gyro_x.g_x', 'gyro_x.g_xx']
    >>> found.params.shape, found.bse.shape, found.conf_int().shape, found.cov_params().shape
    ((9,), (9,), (9, 2), (9, 9))
    >>> list(found.to_pandas().columns)
    ['name', 'estimate', 'sigma', 'unit', 'determined']
    """

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
    def covariance(self) -> NDArray[np.float64]:
        """Covariance of the coefficients, (coefficients, coefficients), in products of their units."""
        return np.array(self._fields["covariance"])

    def cov_params(self) -> NDArray[np.float64]:
        """The same as ``covariance``."""
        return self.covariance

    def _estimated(self) -> list[dict[str, Any]]:
        coefficients: list[dict[str, Any]] = self._fields["coefficients"]
        return coefficients

    def _rows(self) -> list[dict[str, Any]]:
        """One row a coefficient."""
        return list(self.to_dict()["coefficients"])

    def __repr__(self) -> str:
        return f"<gyrocal.Calibration {self.verdict}: {len(self.names)} coefficients>"


class Plan(Result):
    """Result of :func:`gyrocal.plan`; ``proposals`` are the runs, the best first.

    >>> import gyrocal
    >>> files = "examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml"
    >>> planned = gyrocal.plan(*files, hours=24)
    >>> best = planned.proposals[0]
    >>> len(best.initial_angles_deg), best.duration_s / 3600
    (3, 24.0)
    """

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
    """Result of :func:`gyrocal.characterise`; ``cells`` hold the figures of each cell.

    >>> import gyrocal
    >>> measured = gyrocal.characterise("clean", runs=1, methods=[])
    >>> measured
    <gyrocal.Characteristics: 1 cells>
    >>> list(measured.to_pandas().columns)[:4]
    ['cell', 'figure', 'target', 'measured']
    """

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
        return [table("Operating characteristics", heads, ("measured", "runs"), cells)]

    def __repr__(self) -> str:
        return f"<gyrocal.Characteristics: {len(self._fields['cells'])} cells>"


class Fleet(Result):
    """Result of :func:`gyrocal.fleet.summarise`.

    >>> import gyrocal
    >>> from gyrocal import fleet
    >>> made = [gyrocal.simulate("examples/data/hidden_fault.scenario.toml", seed=seed) for seed in range(2)]
    >>> batch = fleet.batch_of_records((f"unit-{i}", "run-1", x.record, x.bench) for i, x in enumerate(made))
    >>> together = fleet.summarise(fleet.diagnose_batches([batch]))
    >>> together.units, together.found_in_units[0].effect
    (2, 'gyro_y.g_z')
    >>> together.to_pandas().shape
    (9, 18)
    """

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


class PlantDiagnosis(_Searched):
    """Result of :meth:`gyrocal.Plant.diagnose`. The page of one that was pickled has no charts.

    The coefficients are parameters and initial states in the units of the plant; the result has no covariance.

    >>> import gyrocal
    >>> plant = gyrocal.Plant("examples/duffing/plant.json")
    >>> found = plant.diagnose("examples/duffing/record.csv", "examples/duffing/columns.toml")
    >>> found.names, found.conf_int().shape
    (['k', 'c', 'g', 'initial x', 'initial v'], (5, 2))
    >>> list(found.pvalues)
    ['v_rate.x^3']
    """

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

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.PlantDiagnosis of {self.plant}, {self.verdict}{': ' + effects if effects else ''}>"


class Simulation(Result):
    """Result of :func:`gyrocal.simulate`: the truth, and the record and bench description made of it.

    >>> import gyrocal
    >>> made = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
    >>> made
    <gyrocal.Simulation: 4321 rows, seed 39>
    >>> made.hidden[0].effect, made.record.accel_g.shape, made.bench.latitude_deg
    ('gyro_y.g_z', (4321, 3), 39.1)
    """

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
        return list(self.to_dict()["coefficients"])

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


#: A key that no other result has, and the class.
_CLASSES: dict[str, type[Result]] = {
    "verdict_text": Calibration,
    "proposals": Plan,
    "cells": Characteristics,
    "recurring": Fleet,
}


def from_json(text_or_path: str | os.PathLike[str]) -> Result:
    """Reads a result that ``to_json`` gave, or that the command wrote with ``--json``.

    Args:
        text_or_path: The JSON itself, or the path of a file of it.

    Returns:
        A :class:`Calibration`, :class:`Characteristics`, :class:`Diagnosis`, :class:`Fleet`, :class:`Plan` or
        :class:`PlantDiagnosis`, as the JSON is. A diagnosis has no ``scores``, and the page of a plant no charts.

    Raises:
        InputError: The file cannot be read, or holds no such result.

    >>> import gyrocal
    >>> text = gyrocal.calibrate("examples/data/three_days.csv", "examples/data/three_days.bench.toml").to_json()
    >>> gyrocal.from_json(text)
    <gyrocal.Calibration consistent: 9 coefficients>
    """
    if not isinstance(text_or_path, (str, os.PathLike)):
        raise refusal("text_or_path", f"a {type(text_or_path).__name__}", "a text of JSON or a path")
    name, text = "<text>", text_or_path
    if isinstance(text, os.PathLike) or not text.lstrip().startswith("{"):
        name = os.fspath(text)
        try:
            text = Path(name).read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise InputError(f"{name}: cannot be read: {error}", file=name) from error
    try:
        fields = json.loads(text)
    except ValueError as error:
        raise InputError(f"{name}: found no JSON: {error}", file=name) from error
    keys = fields if isinstance(fields, dict) else {}
    kinds = [kind for key, kind in _CLASSES.items() if key in keys]
    if {"findings", "subject"} <= set(keys):
        kinds = [PlantDiagnosis if "plant" in (keys.get("subject") or "") else Diagnosis]
    if not kinds:
        raise refusal(
            name, "JSON of another kind",
            "a result of calibrate, characterise, diagnose, plan, fleet.summarise or Plant.diagnose",
            "a simulation is made again from its scenario and seed; json.loads reads any other",
        )
    result = kinds[0](text)
    try:
        # What is no whole result is told here, and not where it is shown.
        result._shown()
    except (GyrocalError, KeyError, TypeError) as error:
        raise refusal(name, f"no whole {kinds[0].__name__}: {error}", "one that this version wrote") from error
    return result
