"""The functions of the package."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from typing import Any, Literal, Union

from . import _gyrocal
from ._arguments import as_list, call, is_rows
from ._errors import InputError, SetupError, refusal
from ._record import (
    AxesLike,
    Bench,
    BenchLike,
    Record,
    RecordLike,
    _json,
    as_axes,
    as_bench,
    as_record,
)
from ._results import Calibration, Characteristics, Diagnosis, Plan, Simulation

__all__ = ["calibrate", "characterise", "diagnose", "plan", "simulate"]

ScenarioLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def simulate(scenario: ScenarioLike, *, seed: int | None = None) -> Simulation:
    """Simulates a record from a scenario with known coefficients, bench and sampling.

    The simulator is independent of the model of :func:`calibrate`. The same scenario and seed give the
    same record, bit for bit.

    Args:
        scenario: A scenario file (TOML), or its tables.
        seed: The seed; that of the scenario if it is not given.

    Returns:
        The truth, with ``record`` and ``bench``.

    Raises:
        InputError: The scenario makes no sense.

    >>> import gyrocal
    >>> made = gyrocal.simulate("examples/data/three_days.scenario.toml", seed=3)
    >>> made.record
    <gyrocal.Record <simulation>: 4321 rows over 3.00 days>
    """
    command = call(simulate, locals())
    if isinstance(scenario, Mapping):
        made = _gyrocal.simulate(None, _json(scenario, "<scenario>"), seed, "<simulation>", command)
    else:
        made = _gyrocal.simulate(os.fspath(scenario), None, seed, "<simulation>", command)
    record, bench, truth = made
    return Simulation(truth, Record._of(record), Bench._of(bench))


def calibrate(
    records: RecordLike | Sequence[RecordLike],
    bench: BenchLike | Sequence[BenchLike],
    *,
    gyro_axes: AxesLike | Sequence[AxesLike] | None = None,
    method: Literal["batch", "streaming", "paper"] = "batch",
    effects: Iterable[str] = (),
    average_s: float | None = None,
    robust_sigmas: float | None = None,
    noise: bool = True,
    factorised: bool = False,
) -> Calibration:
    """Estimates the nine drift coefficients from one record or several turn-ons of one platform.

    Args:
        records: A record, or a list of them.
        bench: The bench description, one for all records or a list of one for each.
        gyro_axes: Axes of the instruments of a strapdown unit in the computed platform: for each row of the
            record the unit quaternion (w, x, y, z) that takes components along the gyros' axes to components
            along the platform's, as an array of four columns or a file of them; of several records a list of
            one for each. Coefficients are then those of the gyros in their own axes.
        method: ``batch`` estimates from whole records, ``streaming`` is the filter that a controller
            embeds, ``paper`` the paper's.
        effects: Effects of the catalogue that are estimated too; for one record.
        average_s: Averages fast records over intervals of this length, s.
        robust_sigmas: Reduces the weight of values whose residual exceeds this many sigmas.
        noise: Whether the noise is estimated.
        factorised: Carries the covariance of the filter as factors; for ``streaming`` and ``paper``.

    Returns:
        The coefficients with their standard deviations in deg/h, deg/h/g and deg/h/g^2, their covariance (9, 9),
        and the verdict whether the record agrees with the model.

    Raises:
        InputError: An argument, a record or a bench description is wrong.
        SetupError: A gross error of the set-up leaves nothing sound; its ``result`` tells which.
        ComputationError: The records could not be calibrated.

    >>> import gyrocal
    >>> found = gyrocal.calibrate("examples/data/three_days.csv", "examples/data/three_days.bench.toml")
    >>> found
    <gyrocal.Calibration consistent: 9 coefficients>
    >>> f"{found.names[0]}: {found.estimates[0]:.4f} +- {found.sigmas[0]:.4f} deg/h"
    'gyro_x.bias: 0.4116 +- 0.0002 deg/h'
    """
    effects = as_list(effects)
    command = call(calibrate, locals())
    given = [as_record(one) for one in _several(records)]
    benches = [as_bench(one) for one in _several(bench)]
    if len(benches) == 1:
        benches *= len(given)
    if not given or len(benches) != len(given):
        raise refusal(
            "bench", f"{len(benches)} descriptions for {len(given)} records", "one for all, or one for each"
        )
    axes = _several_axes(gyro_axes)
    if gyro_axes is not None and len(axes) != len(given):
        raise refusal("gyro_axes", f"{len(axes)} for {len(given)} records", "one for each, in their order")
    if axes and (method != "batch" or average_s is not None):
        raise InputError(
            "gyro_axes: they go with the batch estimator, without average_s",
            advice="average the log where it is imported: gyrocal import strapdown --average",
        )
    _check_calibration(method, len(given), robust_sigmas, noise, factorised)
    runs = [(one._held, other._held) for one, other in zip(given, benches)]
    try:
        answer = _gyrocal.calibrate(
            runs, axes, method, factorised, noise, average_s, robust_sigmas, list(effects), command
        )
    except SetupError as error:
        error.result = Calibration(error.result)
        raise
    return Calibration(*answer)


def diagnose(
    record: RecordLike,
    bench: BenchLike,
    *,
    later: tuple[RecordLike, BenchLike] | None = None,
    gyro_axes: AxesLike | None = None,
    later_gyro_axes: AxesLike | None = None,
    effects: Iterable[str] = (),
    false_alarm: float = 0.01,
    filter: Literal["euler"] | None = None,
) -> Diagnosis:
    """Shows what the model gets wrong about a record, and names the cause.

    A gross error of the set-up that leaves nothing sound is an answer too: its ``verdict`` is
    ``setup``.

    Args:
        record: The record.
        bench: The bench description.
        later: A later record of the same platform with its bench description, to be predicted with the
            nominal and with the extended model.
        gyro_axes: Axes of the instruments of a strapdown unit in the computed platform: for each row of the
            record the unit quaternion (w, x, y, z) that takes components along the gyros' axes to components
            along the platform's, as an array of four columns or a file of them. Coefficients and effects are
            then those of the instruments in their own axes.
        later_gyro_axes: Those of the later record.
        effects: Effects to test that are not in the default set.
        false_alarm: Family-wise probability of a false alarm.
        filter: ``euler`` also tests the consistency of the paper's filter.

    Returns:
        The verdict, the findings with sizes in their units and alternatives, and the coefficients with them in
        the model.

    Raises:
        InputError: An argument, the record or the bench description is wrong.
        ComputationError: The record could not be diagnosed.

    >>> import gyrocal
    >>> found = gyrocal.diagnose("examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml")
    >>> found
    <gyrocal.Diagnosis effects-found: gyro_y.g_z>
    >>> size = found.findings[0].parameters[0]
    >>> f"{size.estimate:.4f} +- {size.sigma:.4f} {size.unit}"
    '0.0013 +- 0.0001 deg/h/g'
    """
    if filter not in (None, "euler"):
        raise refusal("filter", repr(filter), "'euler' or None")
    if later is not None and not (isinstance(later, (list, tuple)) and len(later) == 2):
        raise refusal(
            "later", f"a {type(later).__name__}", "a record and its bench description", "give (record, bench)"
        )
    if gyro_axes is not None and filter is not None:
        raise InputError("filter: it is that of a platform, not of a unit with gyro_axes")
    if (later_gyro_axes is not None) != (gyro_axes is not None and later is not None):
        raise InputError(
            f"later_gyro_axes: found {'none' if later_gyro_axes is None else 'some'}, expected them if later "
            "and gyro_axes are given, and only then",
            advice="give the axes of the later record beside those of the record",
        )
    effects = as_list(effects)
    command = call(diagnose, locals())
    other = None if later is None else (as_record(later[0])._held, as_bench(later[1])._held)
    answer = _gyrocal.diagnose(
        as_record(record)._held,
        as_bench(bench)._held,
        other,
        None if gyro_axes is None else as_axes(gyro_axes, "gyro_axes"),
        None if later_gyro_axes is None else as_axes(later_gyro_axes, "later_gyro_axes"),
        list(effects),
        false_alarm,
        filter is not None,
        command,
    )
    return Diagnosis(*answer)


def plan(
    record: RecordLike,
    bench: BenchLike,
    *,
    gyro_axes: AxesLike | None = None,
    diagnosis: Diagnosis | None = None,
    hours: float | Iterable[float] = (),
    limits_deg: Mapping[str, tuple[float, float]] | None = None,
    aim: Literal["set", "sigmas"] | None = None,
    sigmas: Mapping[str, float] | None = None,
    one_name: bool = False,
    effects: Iterable[str] = (),
    false_alarm: float = 0.01,
) -> Plan:
    """Finds the attitude and duration of the most informative next run.

    Args:
        record: The record.
        bench: The bench description.
        gyro_axes: Axes of the instruments of a strapdown unit in the computed platform, as :func:`diagnose`
            takes them. The next run is then a log of the unit at rest, and angles are those of the unit.
        diagnosis: Result of :func:`diagnose` for this record, with the same ``gyro_axes`` if any; if none is
            given, the record is diagnosed.
        hours: Duration of the next run, or a list of them, h; that of the record if none is given.
        limits_deg: Limits of the platform angles ``x``, ``y``, ``z``, or of those of the unit, each a pair,
            deg; before those of the bench.
        aim: Criterion of the ranking; ``set`` if a finding has alternatives.
        sigmas: Also finds the shortest run after which coefficients, by name, have these sigmas, in their units.
        one_name: Also finds the shortest run after which one effect stays in each confidence set.
        effects: Effects that the diagnosis also tests.
        false_alarm: Family-wise probability of a false alarm of the diagnosis.

    Returns:
        The proposed runs, the best first, with angles in degrees, durations in seconds and the sigmas that they
        are expected to give.

    Raises:
        InputError: An argument, the record or the bench description is wrong.
        ComputationError: No next run could be planned.

    >>> import gyrocal
    >>> files = "examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml"
    >>> gyrocal.plan(*files, diagnosis=gyrocal.diagnose(*files), hours=[12, 24])
    <gyrocal.Plan by sigmas: ... runs>
    """
    hours = as_list([hours] if isinstance(hours, Real) else hours)
    effects = as_list(effects)
    command = call(plan, locals())
    if not isinstance(diagnosis, (Diagnosis, type(None))):
        raise refusal("diagnosis", f"a {type(diagnosis).__name__}", "what diagnose returned")
    if diagnosis is not None and (effects or false_alarm != 0.01):
        raise InputError("plan: effects and false_alarm are those of the diagnosis that is given")
    text = _gyrocal.plan(
        as_record(record)._held,
        as_bench(bench)._held,
        None if gyro_axes is None else as_axes(gyro_axes, "gyro_axes"),
        None if diagnosis is None else diagnosis.to_json(),
        list(map(float, as_list(hours))),
        [(axis, (float(low), float(high))) for axis, (low, high) in (limits_deg or {}).items()],
        aim,
        [(name, float(sigma)) for name, sigma in (sigmas or {}).items()],
        one_name,
        list(effects),
        false_alarm,
        command,
    )
    return Plan(text)


def characterise(
    cells: str | Iterable[str] = (),
    *,
    runs: int | None = None,
    seed: int = 0,
    methods: Iterable[str] | None = None,
    results: str | os.PathLike[str] | None = None,
    threads: int | None = None,
) -> Characteristics:
    """Measures the operating characteristics of the diagnosis on simulated records.

    Args:
        cells: Cells of the table, for example ``clean`` and ``d8``; all of them if none is given, which
            takes hours.
        runs: Records of each cell; 1000 (``clean``: 2000) if it is not given.
        seed: First seed of each cell.
        methods: Baseline methods, of ``nis``, ``ljung-box``, ``bic`` and ``stls``; all of them if it is
            ``None``.
        results: A folder that keeps each finished record; a later call goes on from there.
        threads: Number of threads; one per core if it is not given.

    Returns:
        The figures of each cell with targets and 95 % intervals.

    Raises:
        InputError: An argument is wrong.

    >>> import gyrocal
    >>> measured = gyrocal.characterise("clean", runs=2, seed=40, methods=[])
    >>> measured.cells[0].seeds
    [40, 42]
    """
    cells = as_list([cells] if isinstance(cells, str) else cells)
    methods = None if methods is None else as_list(methods)
    command = call(characterise, locals())
    return Characteristics(_gyrocal.characterise(list(cells), runs, seed, results, methods, threads, command))


def _several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, (list, tuple)) else [value]


def _several_axes(value: Any) -> list[tuple[str, Any]]:
    """Axes of each record, with the name of the argument."""
    if value is None:
        return []
    if not isinstance(value, (list, tuple)) or is_rows(value):
        return [("gyro_axes", as_axes(value, "gyro_axes"))]
    named = [(f"gyro_axes[{index}]", one) for index, one in enumerate(value)]
    return [(name, as_axes(one, name)) for name, one in named]


def _check_calibration(
    method: str, records: int, robust_sigmas: float | None, noise: bool, factorised: bool
) -> None:
    if method == "batch":
        if factorised:
            raise InputError(
                "factorised: it is a form of the filter",
                advice="give method='streaming' or 'paper', or leave it out",
            )
        return
    if records > 1 or robust_sigmas is not None or not noise:
        raise InputError(
            f"method: `{method}` reads one record, without robust_sigmas, and estimates no noise",
            advice="leave these out, or use the batch estimator",
        )
