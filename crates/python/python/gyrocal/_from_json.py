"""Results from their JSON."""

from __future__ import annotations

import json
import os
from pathlib import Path

from ._errors import GyrocalError, InputError, refusal
from ._plant_results import PlantDiagnosis, PlantFit
from ._result import Result
from ._results import Calibration, Characteristics, Diagnosis, Fleet, Plan

__all__ = ["from_json"]

#: A key that no other result has, and the class.
_CLASSES: dict[str, type[Result]] = {
    "verdict_text": Calibration,
    "proposals": Plan,
    "cells": Characteristics,
    "recurring": Fleet,
    "unknowns": PlantFit,
}


def from_json(text_or_path: str | os.PathLike[str]) -> Result:
    """Reads a result that ``to_json`` gave, or that the command wrote with ``--json``.

    Args:
        text_or_path: The JSON itself, or the path of a file of it.

    Returns:
        A :class:`Calibration`, :class:`Characteristics`, :class:`Diagnosis`, :class:`Fleet`, :class:`Plan`,
        :class:`PlantDiagnosis` or :class:`PlantFit`, as the JSON is. A diagnosis has no ``scores``, a calibration
        no ``llf``, a plant no outputs over time and its page no charts.

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
            "a result of calibrate, characterise, diagnose, plan, fleet.summarise, Plant.diagnose or Plant.fit",
            "a simulation is made again from its scenario and seed; json.loads reads any other",
        )
    result = kinds[0](text)
    try:
        # What is no whole result is told here, and not where it is shown.
        result._words()
    except (GyrocalError, KeyError, TypeError) as error:
        raise refusal(name, f"no whole {kinds[0].__name__}: {error}", "one that this version wrote") from error
    return result
