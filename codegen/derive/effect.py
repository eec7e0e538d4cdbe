"""Types of the entries of the catalogue: effects, their terms, and the symbols of a term."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import casadi as ca

from layout import AXES


class Kind(Enum):
    """How an effect acts over time. Values are the variants of `EffectKind` in Rust."""

    CONSTANT = "Constant"
    """No explicit function of time."""
    STEP = "Step"
    """Zero before an onset, one after it."""
    FROM_ONSET = "FromOnset"
    """Zero before an onset, any function of time after it."""
    EXPONENTIAL = "Exponential"
    """A function of time with a time constant."""
    RAMP = "Ramp"
    """Proportional to time."""
    PERIODIC = "Periodic"
    """Periodic in time, with `period_s`."""
    REGRESSOR = "Regressor"
    """Proportional to a power of what follows from a logged quantity: temperature, its rate of
    change, its hysteresis."""
    RANDOM_WALK = "RandomWalk"
    """Integral of white noise."""
    STATE_JUMP = "StateJump"
    """Sudden change of moving states at an onset."""
    INITIAL_STATE = "InitialState"
    """Error of moving states at the first row, outside their prior."""
    NOISE = "Noise"
    """A property of the noise, given by `noise`."""
    INTEGRATION = "Integration"
    """The integration rule of a filter."""


KINDS_WITH_TERM = {Kind.CONSTANT, Kind.STEP, Kind.FROM_ONSET, Kind.EXPONENTIAL, Kind.RAMP,
                   Kind.PERIODIC, Kind.REGRESSOR}
"""Kinds with a term in the symbolic model."""

KINDS_WITH_WEIGHT = KINDS_WITH_TERM - {Kind.CONSTANT}
"""Kinds whose terms are explicit functions of time, of a regressor or of a shape."""


class NoiseProperty(Enum):
    """Values are the variants of the enum of the same name in Rust."""

    LEVEL = "Level"
    OUTLIERS = "Outliers"
    QUANTISATION = "Quantisation"
    CORRELATION = "Correlation"


class Enters(Enum):
    """Where an effect enters the model."""

    RATE = "rate"
    """Drift of gyros: the term returns the addition by axis, deg/h."""
    OUTPUT = "output"
    """Outputs of accelerometers: the term returns the addition by axis, g."""
    INPUT = "input"
    """`omega_0` or `f_0`, or both: the term returns them with the effect."""
    TIME = "time"
    """Time: the term is a factor of all rates."""
    STATE = "state"
    """Moving states: no term."""
    FILTER = "filter"
    """The filter: no term."""


class Continuation(Enum):
    """Continuation of an effect in a later record. Values are the variants in Rust."""

    BEGINS_ANEW = "BeginsAnew"
    GOES_ON = "GoesOn"
    STAYS = "Stays"
    THIS_RECORD = "ThisRecord"


USUAL_CONTINUATION = {
    Kind.CONSTANT: Continuation.STAYS,
    Kind.STEP: Continuation.STAYS,
    Kind.FROM_ONSET: Continuation.GOES_ON,
    Kind.EXPONENTIAL: Continuation.BEGINS_ANEW,
    Kind.RAMP: Continuation.GOES_ON,
    Kind.PERIODIC: Continuation.GOES_ON,
    Kind.REGRESSOR: Continuation.GOES_ON,
    Kind.RANDOM_WALK: Continuation.STAYS,
    Kind.STATE_JUMP: Continuation.THIS_RECORD,
    Kind.INITIAL_STATE: Continuation.THIS_RECORD,
    Kind.NOISE: Continuation.STAYS,
    Kind.INTEGRATION: Continuation.STAYS,
}


@dataclass(frozen=True)
class Experiment:
    """An experiment that distinguishes effects: a variant of the enum in Rust, and its object."""

    variant: str
    of: str = ""


OTHER_INITIAL_STATE = Experiment("OtherInitialState")
OTHER_START = Experiment("OtherStart")
MEASURE_INITIAL_STATE = Experiment("MeasureInitialState")
START_LATE = Experiment("StartLate")


@dataclass(frozen=True)
class Equivalence:
    """Reason why effects are exact equivalents, and the experiment that would distinguish them."""

    reason: str
    experiment: str


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect: its name within the effect, its unit, its meaning."""

    name: str
    unit: str
    doc: str = "size"
    scale: float = 1.0
    """Unit of the model over this unit."""


@dataclass(frozen=True)
class At:
    """Symbols of a term. Vectors along platform axes are indexed by axis: `at.a["x"]`."""

    a: dict[str, ca.SX]
    """Specific force along the platform axes, g."""
    drift: dict[str, ca.SX]
    """Drift of each gyro with its noise, without terms that themselves use drifts, deg/h."""
    field: dict[str, ca.SX]
    """Magnetic field of the Earth along the platform axes, gauss."""
    time_s: ca.SX
    """Time since the first row: the middle of the step in a drift, the sample in an output."""
    interval_s: ca.SX
    """Length of the step."""
    temperature_k: ca.SX
    """Temperature above its mean over the record."""
    temperature_rate_k_per_h: ca.SX
    """Rate of change of the temperature."""
    temperature_hysteresis_k: ca.SX
    """Temperature less what follows it with a play of a quarter of its range over the record: it
    differs between the way up and the way down."""
    omega_0: ca.SX
    """Earth rate in chart axes, rad/s."""
    f_0: ca.SX
    """Specific force in chart axes, g."""
    east_0: ca.SX
    """Unit vector East in chart axes."""


@dataclass(frozen=True)
class Effect:
    """One entry of the catalogue. All parameters are zero in the nominal model.

    `term(p, at)` is the effect as an expression of its parameters `p["size"]`, ... and of `at`;
    `enters` determines what it returns. An effect without a term is not part of the symbolic model;
    the table of effects has the same fields for it.
    """

    id: str
    kind: Kind
    enters: Enters
    name: str
    """Physical name, with the letter of the literature where there is one."""
    parameters: tuple[Parameter, ...]
    """Constants that a filter can estimate: states of the model."""
    typical_size: float
    """Size of the first parameter, in its unit, that a fault-free instrument may have."""
    reference: str = ""
    term: Callable[[dict[str, ca.SX], At], object] | None = None
    axes: tuple[str, ...] = ()
    """Axes of the channels or states that an effect without a term enters."""
    shapes: tuple[Parameter, ...] = ()
    """Onset (`onset_s`) or time constant (`time_constant_h`): the term is not linear in it."""
    period_s: float | None = None
    """Period of a periodic effect."""
    power: int = 1
    """Power of the regressors that a term of a regressor is proportional to."""
    noise: NoiseProperty | None = None
    """Property of the noise, for a noise effect."""
    equivalents: tuple[str, ...] = ()
    """Exact equivalents: effects that no record can distinguish from this one; declared in one
    entry."""
    equivalence: Equivalence | None = None
    """Reason of the equivalence, in one entry of the class."""
    near_twins: tuple[str, ...] = ()
    """Effects that a short record hardly distinguishes from it; declared in one entry."""
    nested: tuple[str, ...] = ()
    """Simpler effects that it tends to at a limit of its shape: one of them is named instead unless
    this one is significantly better."""
    continues: Continuation | None = None
    """Continuation in a later record, if not the usual one of its kind."""
    separated_by: tuple[Experiment, ...] | None = None
    """Experiments that distinguish it from others, if not the usual ones of its kind."""
    family: str = ""
    """Id with letters in place of axes, `gyro_i.g_jk`, common to effects that differ by their axes;
    default: the id."""
    default_search: bool = True
    formula: str = ""
    """Formula as text, only where the expression is not readable."""

    def state_id(self, parameter: Parameter) -> str:
        """Public id of a parameter that is a state: the id of the effect if it is the only one."""
        return self.id if len(self.parameters) == 1 else f"{self.id}.{parameter.name}"

    def shape_id(self, parameter: Parameter) -> str:
        """Public id of a parameter that is given."""
        return f"{self.id}.{parameter.name}"

    @property
    def has_term(self) -> bool:
        return self.term is not None

    @property
    def continuation(self) -> Continuation:
        return self.continues or USUAL_CONTINUATION[self.kind]

    @property
    def experiments(self) -> tuple[Experiment, ...]:
        if self.separated_by is not None:
            return self.separated_by
        match self.kind:
            case Kind.NOISE | Kind.INTEGRATION:
                return ()
            case Kind.STATE_JUMP | Kind.INITIAL_STATE:
                return (MEASURE_INITIAL_STATE,)
            case Kind.EXPONENTIAL:
                return (OTHER_START, START_LATE)
            case Kind.REGRESSOR:
                return (OTHER_START, Experiment("ControlRegressor", "temperature"))
            case Kind.CONSTANT:
                return (OTHER_INITIAL_STATE,)
            case _:
                return (OTHER_START,)


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
