"""What an entry of the catalogue is, and what its expression may be made of."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca

from layout import AXES


@dataclass(frozen=True)
class Parameter:
    """A number that an effect has: its name within the effect, its unit, its meaning."""

    name: str
    unit: str
    doc: str = "size"


@dataclass(frozen=True)
class At:
    """What terms are made of. Vectors along platform axes are taken by the axis: `at.a["x"]`."""

    a: dict[str, ca.SX]
    """Specific force along the platform axes, g."""
    drift: dict[str, ca.SX]
    """Drift of each gyro, deg/h, noise included, without terms that themselves take drifts."""
    field: dict[str, ca.SX]
    """Magnetic field of the Earth along the platform axes, gauss."""
    time_s: ca.SX
    """Time since the first row: the middle of the step in a drift, the sample in an output."""
    interval_s: ca.SX
    """Length of the step."""
    temperature_k: ca.SX
    """Temperature above its mean over the record."""
    omega_0: ca.SX
    """Earth rate in chart axes, rad/s."""
    f_0: ca.SX
    """Specific force in chart axes, g."""
    east_0: ca.SX
    """Unit vector East in chart axes."""


@dataclass(frozen=True)
class Effect:
    """One entry of the catalogue. All parameters are zero in the nominal model.

    `term(p, at)` is the effect as an expression of its parameters `p["size"]`, ... and of `at`.
    What it returns depends on where the effect enters:

    - `drift`: by axis what is added to the drift of a gyro, deg/h
    - `output`: by axis what is added to the reading of an accelerometer, g
    - `site`: `omega_0` or `f_0`, or both, as the effect makes them
    - `time`: a factor on all rates

    An effect without a term (kind `state`, `noise` or `filter`) is no part of the symbolic
    model; what reads the table of effects knows it by its id.
    """

    id: str
    enters: str
    name: str
    """Physical name, with the letter of the literature where there is one."""
    parameters: tuple[Parameter, ...]
    """Constants that a filter can estimate: states of the model."""
    typical_size: float
    """Of the first parameter, in its unit: what a sound instrument may have."""
    reference: str = ""
    term: Callable[[dict[str, ca.SX], At], object] | None = None
    shapes: tuple[Parameter, ...] = ()
    """Parameters that are given, not estimated as states: the term is not linear in them."""
    kind: str = "term"
    equivalents: tuple[str, ...] = ()
    """Effects that no record whatever can tell from this one; naming it in one entry will do."""
    near_twins: tuple[str, ...] = ()
    """Effects that a short record can hardly tell from it; naming it in one entry will do."""
    default_search: bool = True
    formula: str = ""
    """Written out only where the expression itself does not read well."""

    def state_id(self, parameter: Parameter) -> str:
        """Public id of a parameter that is a state: the effect's own if there is but one."""
        return self.id if len(self.parameters) == 1 else f"{self.id}.{parameter.name}"

    def shape_id(self, parameter: Parameter) -> str:
        """Public id of a parameter that is given."""
        return f"{self.id}.{parameter.name}"

    @property
    def has_term(self) -> bool:
        return self.term is not None


def rust_name(public_id: str) -> str:
    """`gyro_x.g_y` as a name in Rust."""
    return public_id.replace(".", "_")


def others(axis: str) -> tuple[str, str]:
    """The two other axes, in the order of the alphabet."""
    first, second = (other for other in AXES if other != axis)
    return first, second


def by_axis(vector: ca.SX) -> dict[str, ca.SX]:
    """A vector's components by the axis."""
    return dict(zip(AXES, ca.vertsplit(vector)))
