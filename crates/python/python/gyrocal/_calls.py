"""The functions of the package."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from numbers import Number
from typing import Any, Literal, Union

import numpy as np

from . import _gyrocal
from ._errors import InputError, SetupError
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
    """
    command = _call(simulate, locals())
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

    Raises:
        InputError: An argument, a record or a bench description is wrong.
        SetupError: A gross error of the set-up leaves nothing sound; its ``result`` tells which.
        ComputationError: The records could not be calibrated.
    """
    effects = list(effects)
    command = _call(calibrate, locals())
    given = [as_record(one) for one in _several(records)]
    benches = [as_bench(one) for one in _several(bench)]
    if len(benches) == 1:
        benches *= len(given)
    if not given or len(benches) != len(given):
        raise InputError(
            f"bench: found {len(benches)} descriptions for {len(given)} records, expected one for all, "
            "or one for each",
            found=str(len(benches)),
            expected=str(len(given)),
        )
    axes = _several_axes(gyro_axes)
    if gyro_axes is not None and len(axes) != len(given):
        raise InputError(
            f"gyro_axes: found {len(axes)} for {len(given)} records, expected one for each, in their order",
            found=str(len(axes)),
            expected=str(len(given)),
        )
    if axes and (method != "batch" or average_s is not None):
        raise InputError(
            "gyro_axes: they go with the batch estimator, without average_s",
            advice="average the log where it is imported: gyrocal import strapdown --average",
        )
    _check_calibration(method, len(given), average_s, robust_sigmas, noise, factorised)
    runs = [(one._held, other._held) for one, other in zip(given, benches)]
    try:
        text = _gyrocal.calibrate(
            runs, axes, method, factorised, noise, average_s, robust_sigmas, effects, command
        )
    except SetupError as error:
        error.result = Calibration(error.result)
        raise
    return Calibration(text)


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

    Raises:
        InputError: An argument, the record or the bench description is wrong.
        ComputationError: The record could not be diagnosed.
    """
    if filter not in (None, "euler"):
        raise InputError(f"filter: found {filter!r}, expected 'euler' or None", expected="euler")
    if gyro_axes is not None and filter is not None:
        raise InputError("filter: it is that of a platform, not of a unit with gyro_axes")
    if (later_gyro_axes is not None) != (gyro_axes is not None and later is not None):
        raise InputError(
            f"later_gyro_axes: found {'none' if later_gyro_axes is None else 'some'}, expected them if later "
            "and gyro_axes are given, and only then",
            advice="give the axes of the later record beside those of the record",
        )
    effects = list(effects)
    command = _call(diagnose, locals())
    other = None if later is None else (as_record(later[0])._held, as_bench(later[1])._held)
    answer = _gyrocal.diagnose(
        as_record(record)._held,
        as_bench(bench)._held,
        other,
        None if gyro_axes is None else as_axes(gyro_axes, "gyro_axes"),
        None if later_gyro_axes is None else as_axes(later_gyro_axes, "later_gyro_axes"),
        effects,
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
        hours: Durations of the next run; that of the record if none is given.
        limits_deg: Limits of the platform angles ``x``, ``y``, ``z``, or of those of the unit; before those
            of the bench.
        aim: Criterion of the ranking; ``set`` if a finding has alternatives.
        sigmas: Also finds the shortest run after which coefficients have these sigmas.
        one_name: Also finds the shortest run after which one effect stays in each confidence set.
        effects: Effects that the diagnosis also tests.
        false_alarm: Family-wise probability of a false alarm of the diagnosis.

    Raises:
        InputError: An argument, the record or the bench description is wrong.
        ComputationError: No next run could be planned.
    """
    hours = [hours] if isinstance(hours, (int, float)) else list(hours)
    effects = list(effects)
    command = _call(plan, locals())
    if diagnosis is not None and (effects or false_alarm != 0.01):
        raise InputError("plan: effects and false_alarm are those of the diagnosis that is given")
    text = _gyrocal.plan(
        as_record(record)._held,
        as_bench(bench)._held,
        None if gyro_axes is None else as_axes(gyro_axes, "gyro_axes"),
        None if diagnosis is None else diagnosis.to_json(),
        [float(one) for one in hours],
        [(axis, (float(low), float(high))) for axis, (low, high) in (limits_deg or {}).items()],
        aim,
        [(name, float(sigma)) for name, sigma in (sigmas or {}).items()],
        one_name,
        effects,
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

    Raises:
        InputError: An argument is wrong.
    """
    cells = [cells] if isinstance(cells, str) else list(cells)
    methods = None if methods is None else list(methods)
    command = _call(characterise, locals())
    for name, value, least in (("runs", runs, 1), ("seed", seed, 0), ("threads", threads, 1)):
        if value is not None and (not isinstance(value, int) or value < least):
            raise InputError(f"{name}: found {value!r}, expected an integer of at least {least}")
    return Characteristics(_gyrocal.characterise(cells, runs, seed, results, methods, threads, command))


def _several(value: Any) -> list[Any]:
    return list(value) if isinstance(value, (list, tuple)) else [value]


def _several_axes(value: Any) -> list[tuple[str, Any]]:
    """Axes of each record, with the name of the argument."""
    if value is None:
        return []
    if not isinstance(value, (list, tuple)) or _is_rows(value):
        return [("gyro_axes", as_axes(value, "gyro_axes"))]
    named = [(f"gyro_axes[{index}]", one) for index, one in enumerate(value)]
    return [(name, as_axes(one, name)) for name, one in named]


def _is_rows(value: Sequence[Any]) -> bool:
    """Whether these are the rows of one array, and not several things."""
    first = value[0] if len(value) > 0 else None
    if isinstance(first, (list, tuple)):
        return all(isinstance(one, Number) for one in first)
    return isinstance(first, np.ndarray) and first.ndim == 1


def _check_calibration(
    method: str,
    records: int,
    average_s: float | None,
    robust_sigmas: float | None,
    noise: bool,
    factorised: bool,
) -> None:
    for name, value in (("average_s", average_s), ("robust_sigmas", robust_sigmas)):
        if value is not None and not 0.0 < value < float("inf"):
            raise InputError(f"{name}: found {value!r}, expected a positive number", found=repr(value))
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


def _call(function: Callable[..., Any], given: Mapping[str, Any]) -> str:
    """The call in words, for the manifest: `given` are its arguments, of which defaults are left out."""
    shown = []
    for name, default, by_name in _parameters(function):
        if not _is_default(given[name], default):
            shown.append(f"{name}={_shown(given[name])}" if by_name else _shown(given[name]))
    public = [part for part in function.__module__.split(".") if not part.startswith("_")]
    return f"{'.'.join(public)}.{function.__qualname__}({', '.join(shown)})"


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
    if isinstance(value, (list, tuple)) and not _is_rows(value):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, Mapping) and all(map(_is_setting, value.values())):
        return f"{{{', '.join(f'{key!r}: {_shown(one)}' for key, one in value.items())}}}"
    return f"<{type(value).__name__}>"


def _is_setting(value: Any) -> bool:
    """Whether a value of a mapping is a number or a pair of them, and no column of a record."""
    if isinstance(value, (list, tuple)):
        return len(value) == 2 and all(isinstance(one, Number) for one in value)
    return isinstance(value, Number)
