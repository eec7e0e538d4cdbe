"""The results, each with its attributes and its main table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ._estimates import Searched, WithCovariance
from ._plots import coefficients
from ._result import Fields, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._record import Bench, Record

__all__ = [
    "Calibration",
    "Characteristics",
    "Diagnosis",
    "Fleet",
    "Plan",
    "Simulation",
]


class _Coefficients(WithCovariance):
    """Coefficients of a platform."""

    __slots__ = ()

    def plot(self, alpha: float = 0.05, *, fig: Figure | None = None) -> Figure:
        """Draws the coefficients with their intervals, a panel for each unit, by Matplotlib.

        Args:
            alpha: Probability that an interval misses, as :meth:`conf_int` takes it.
            fig: A figure to draw in; a new one of pyplot if it is not given.

        Returns:
            The figure.

        Raises:
            ImportError: Matplotlib is not installed; it is the extra ``plot``.
        """
        return coefficients(self, alpha, fig)


class Diagnosis(Searched, _Coefficients):
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

    def _covariance(self) -> list[list[float]]:
        found = self._fields["coefficients"]
        rows: list[list[float]] = [] if found is None else found["covariance"]
        return rows

    def __repr__(self) -> str:
        effects = ", ".join(finding["effect"] for finding in self._fields["findings"])
        return f"<gyrocal.Diagnosis {self.verdict}{': ' + effects if effects else ''}>"


class Calibration(_Coefficients):
    """Result of :func:`gyrocal.calibrate`: nine drift coefficients in deg/h, deg/h/g and deg/h/g^2.

    >>> import gyrocal
    >>> found = gyrocal.calibrate("examples/data/three_days.csv", "examples/data/three_days.bench.toml")
    >>> found.names[:3]
    ['gyro_x.bias', 'gyro_x.g_x', 'gyro_x.g_xx']
    >>> found.params.shape, found.bse.shape, found.conf_int().shape, found.cov_params().shape
    ((9,), (9,), (9, 2), (9, 9))
    >>> found.nobs, found.llf > 0.0
    (4321, True)
    >>> list(found.to_pandas().columns)
    ['name', 'estimate', 'sigma', 'unit', 'determined']
    """

    __slots__ = ("_log_likelihood",)
    _log_likelihood: float | None
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

    def __init__(self, text: str, log_likelihood: float | None = None) -> None:
        super().__init__(text)
        object.__setattr__(self, "_log_likelihood", log_likelihood)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self._text, self._log_likelihood)

    @property
    def llf(self) -> float:
        """Logarithm of the likelihood of the records, over all values of the unknowns within their priors, nats.

        Where fast rows are averaged it is that of their means. It is not in the JSON: a result that was read from it
        does not have it.
        """
        if self._log_likelihood is None:
            raise AttributeError(
                "there is no `llf`: nothing was estimated, or the result was read from JSON, which does not hold it",
                name="llf",
                obj=self,
            )
        return self._log_likelihood

    @property
    def nobs(self) -> int:
        """The same as ``rows``: the number of rows that were used, of all records."""
        return self.rows

    def _covariance(self) -> list[list[float]]:
        rows: list[list[float]] = self._fields["covariance"]
        return rows

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

    def _words(self) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
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
        return blocks, []

    def __repr__(self) -> str:
        return f"<gyrocal.Simulation: {self.rows} rows, seed {self.manifest.seed}>"
