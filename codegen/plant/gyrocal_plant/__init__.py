"""Declares a plant for a diagnosis and writes its program file; `docs/any-plant.md` is the manual."""

import sys
from pathlib import Path

try:
    import casadi_program  # noqa: F401
except ModuleNotFoundError:
    # In the tree of gyrocal the exporter stands beside this package.
    sys.path.append(str(Path(__file__).resolve().parents[2] / "emit" / "exporter"))

from .declaration import Plant, PlantError, handed_over

__all__ = ["Plant", "PlantError", "handed_over"]
