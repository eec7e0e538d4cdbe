"""The catalogue of effects: every effect that a diagnosis can test, one entry each.

To add an effect, add an entry. Its derivatives, its place in `Catalogue` and its row in the
table of effects follow with the next build; docs/adding-a-term.md walks through an example.

Letters are those of IEEE Std 517-1974 (single-degree-of-freedom gyros: D_F, D_I, D_O, D_S and
their squares and products) and IEEE Std 1293-2018 (accelerometers: K_0, K_1, K_2, ...), where
I, O and S are the input, output and spin axis. Input axes are the platform axes. The model does not
specify which of the two other axes is the output axis of a gyro, so either letter may apply.
docs/glossary.md defines all terms.
"""

import math

import casadi as ca

from effect import (
    OTHER_START, Effect, Enters, Equivalence, Experiment, Kind, NoiseProperty, OTHER_INITIAL_STATE,
    Parameter, others,
)
from layout import AXES

DAY_S = 86400
HOUR_S = 3600
RAD_PER_DEG = math.pi / 180

GYRO_STANDARD = "IEEE Std 517-1974"
TUNED_GYRO_STANDARD = "IEEE Std 813-1988"
ACCELEROMETER_STANDARD = "IEEE Std 1293-2018"
NOISE_STANDARD = "IEEE Std 952-1997"

SITE_EXPERIMENTS = (
    OTHER_START,
    Experiment("MeasureInput", "an independent astronomic latitude and a checked clock"),
)

SQUARES = Equivalence(
    "the squares of the three components of specific force sum to gravity squared, so the two "
    "differ by a constant drift and the square along the input axis, which are estimated "
    "coefficients: their signatures are equal in every record on a static base",
    "specific force of another magnitude, as on a centrifuge; on a static base either one "
    "compensates the drift",
)
EARTH_RATE = Equivalence(
    "each rotates or scales the Earth rate in platform axes, and the three coefficients D_I absorb "
    "all but one direction of that change: their signatures are equal in every record",
    "an independent astronomic latitude, or a check of the sampling clock against a time signal; "
    "the Earth rate itself is known far better",
)


def _size(unit: str) -> tuple[Parameter]:
    return (Parameter("size", unit),)


def _rotation() -> tuple[Parameter, ...]:
    return tuple(Parameter(i, "deg", f"rotation about platform {i}", RAD_PER_DEG) for i in AXES)


def _onset() -> Parameter:
    return Parameter("onset_s", "s", "time of the change since the first row")


def _products(i: str) -> list[str]:
    """Pairs of axes of the product terms of gyro i, without its own square (nominal)."""
    pairs = [j + k for j in AXES for k in AXES if j <= k]
    return [pair for pair in pairs if pair != i + i]


def _product_twin(i: str, pair: str) -> tuple[str, ...]:
    """Since a.a = g^2 the squares along the two other axes are equivalent, with opposite signs."""
    j, k = others(i)
    return (f"gyro_{i}.g_{k}{k}",) if pair == j + j else ()


def _share_after(onset_s: ca.SX, at) -> ca.SX:
    """The fraction of a step after an onset."""
    share = (at.time_s - onset_s) / at.interval_s + 0.5
    return ca.fmax(0, ca.fmin(1, share))


def _turned_about_east(angle_rad: ca.SX, at) -> ca.SX:
    """Earth rate at a latitude that is larger by an angle; it has no component along East."""
    return ca.cos(angle_rad) * at.omega_0 + ca.sin(angle_rad) * ca.cross(at.east_0, at.omega_0)


EFFECTS = [
    # Drift of the gyros.
    *[
        Effect(
            f"gyro_{i}.g_{j}", Kind.CONSTANT, Enters.RATE,
            f"mass unbalance of gyro {i} along the cross axis {j} (D_O or D_S)",
            _size("deg/h/g"), 0.05, GYRO_STANDARD,
            lambda p, at, i=i, j=j: {i: p["size"] * at.a[j]},
            near_twins=(f"gyro_{i}{j}.axis_misalignment", f"gyro_{i}.magnetic",
                        f"gyro_{i}.diurnal"),
            family="gyro_i.g_j",
        )
        for i in AXES for j in others(i)
    ],
    *[
        Effect(
            f"gyro_{i}.g_{pair}", Kind.CONSTANT, Enters.RATE,
            f"anisoelasticity of gyro {i}: product of specific forces along {pair[0]} and "
            f"{pair[1]} (D_IO, D_IS, D_OS, D_OO or D_SS)",
            _size("deg/h/g^2"), 0.02, GYRO_STANDARD,
            lambda p, at, i=i, pair=pair: {i: p["size"] * (at.a[pair[0]] * at.a[pair[1]])},
            equivalents=_product_twin(i, pair),
            equivalence=SQUARES if _product_twin(i, pair) else None,
            family="gyro_i.g_jk",
        )
        for i in AXES for pair in _products(i)
    ],
    *[
        Effect(
            f"gyro_{i}.g_{i}{i}{i}", Kind.CONSTANT, Enters.RATE,
            f"cubic term of gyro {i} along its input axis (D_III)",
            _size("deg/h/g^3"), 0.01, TUNED_GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]**3},
            near_twins=(f"gyro_{i}.g_{i}",),
            family="gyro_i.g_iii",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.ramp", Kind.RAMP, Enters.RATE, f"linear ageing of gyro {i}: drift rate ramp (R)",
            _size("deg/h/day"), 0.005, NOISE_STANDARD,
            lambda p, at, i=i: {i: p["size"] * (at.time_s / DAY_S)},
            family="gyro_i.ramp",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.step", Kind.STEP, Enters.RATE, f"step of the drift of gyro {i}",
            _size("deg/h"), 0.02, "",
            lambda p, at, i=i: {i: p["size"] * _share_after(p["onset_s"], at)},
            shapes=(_onset(),),
            family="gyro_i.step",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.warmup", Kind.EXPONENTIAL, Enters.RATE, f"warm-up of gyro {i}: exponential decay of the drift",
            _size("deg/h"), 0.05, GYRO_STANDARD,
            lambda p, at, i=i: {
                i: p["size"] * ca.exp(-at.time_s / (HOUR_S * p["time_constant_h"]))
            },
            shapes=(Parameter("time_constant_h", "h", "time in which it falls to 1/e"),),
            near_twins=(f"gyro_{i}.ramp", "platform.initial_attitude"),
            nested=(f"gyro_{i}.ramp", "platform.initial_attitude"),
            family="gyro_i.warmup",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.diurnal", Kind.PERIODIC, Enters.RATE,
            f"diurnal drift of gyro {i}: period of one solar day, like room temperature",
            (Parameter("sine", "deg/h", "sine amplitude, phase zero at the first row"),
             Parameter("cosine", "deg/h", "cosine amplitude")),
            0.01, "",
            lambda p, at, i=i: {
                i: p["sine"] * ca.sin(2 * math.pi / DAY_S * at.time_s)
                + p["cosine"] * ca.cos(2 * math.pi / DAY_S * at.time_s)
            },
            period_s=DAY_S,
            formula=f"omega_d_{i} += gyro_{i}_diurnal_sine*sin(2*pi*time_s/86400) + "
                    f"gyro_{i}_diurnal_cosine*cos(2*pi*time_s/86400)",
            family="gyro_i.diurnal",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.temperature", Kind.REGRESSOR, Enters.RATE, f"temperature coefficient of the drift of gyro {i}",
            _size("deg/h/K"), 0.005, GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.temperature_k},
            near_twins=(f"gyro_{i}.diurnal",),
            family="gyro_i.temperature",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.temperature_square", Kind.REGRESSOR, Enters.RATE,
            f"square of temperature in the drift of gyro {i}",
            _size("deg/h/K^2"), 0.0005, "",
            lambda p, at, i=i: {i: p["size"] * at.temperature_k**2},
            power=2,
            near_twins=(f"gyro_{i}.temperature",),
            family="gyro_i.temperature_square",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.temperature_rate", Kind.REGRESSOR, Enters.RATE,
            f"drift of gyro {i} by the rate of change of temperature: thermal gradients, transients",
            _size("deg/h/(K/h)"), 0.005, NOISE_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.temperature_rate_k_per_h},
            # The rate of a daily wave is one, that of an exponential approach an exponential.
            near_twins=(f"gyro_{i}.diurnal", f"gyro_{i}.warmup"),
            family="gyro_i.temperature_rate",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.temperature_hysteresis", Kind.REGRESSOR, Enters.RATE,
            f"thermal hysteresis of the drift of gyro {i}: it differs between rising and falling "
            "temperature",
            _size("deg/h/K"), 0.005, "",
            lambda p, at, i=i: {i: p["size"] * at.temperature_hysteresis_k},
            near_twins=(f"gyro_{i}.temperature", f"gyro_{i}.temperature_rate",
                        f"gyro_{i}.diurnal"),
            family="gyro_i.temperature_hysteresis",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.random_walk", Kind.RANDOM_WALK, Enters.RATE, f"rate random walk of gyro {i} (K)",
            _size("deg/h/sqrt(h)"), 0.001, NOISE_STANDARD, axes=(i,),
            family="gyro_i.random_walk",
        )
        for i in AXES
    ],
    # Outputs of the accelerometers.
    *[
        Effect(
            f"accel_{i}.bias", Kind.CONSTANT, Enters.OUTPUT, f"bias of accelerometer {i} (K_0)",
            _size("g"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"]},
            family="accel_i.bias",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.scale", Kind.CONSTANT, Enters.OUTPUT, f"scale factor error of accelerometer {i} (K_1)",
            _size("1"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]},
            family="accel_i.scale",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.quadratic", Kind.CONSTANT, Enters.OUTPUT, f"square term of accelerometer {i} (K_2)",
            _size("g/g^2"), 2e-5, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]**2},
            family="accel_i.quadratic",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}{j}.nonorthogonality", Kind.CONSTANT, Enters.OUTPUT,
            f"orthogonality error of accelerometers {i} and {j}: symmetric part of the "
            "misalignment (delta_o, delta_p)",
            _size("rad"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i, j=j: {i: p["size"] * at.a[j], j: p["size"] * at.a[i]},
            family="accel_ij.nonorthogonality",
        )
        for i in AXES for j in AXES if i < j
    ],
    *[
        Effect(
            f"accel_{i}.temperature", Kind.REGRESSOR, Enters.OUTPUT,
            f"temperature coefficient of the bias of accelerometer {i}",
            _size("g/K"), 1e-5, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.temperature_k},
            family="accel_i.temperature",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.temperature_square", Kind.REGRESSOR, Enters.OUTPUT,
            f"square of temperature in the bias of accelerometer {i}",
            _size("g/K^2"), 1e-6, "",
            lambda p, at, i=i: {i: p["size"] * at.temperature_k**2},
            power=2,
            near_twins=(f"accel_{i}.temperature",),
            family="accel_i.temperature_square",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.temperature_rate", Kind.REGRESSOR, Enters.OUTPUT,
            f"bias of accelerometer {i} by the rate of change of temperature: thermal gradients, "
            "transients",
            _size("g/(K/h)"), 1e-5, "",
            lambda p, at, i=i: {i: p["size"] * at.temperature_rate_k_per_h},
            family="accel_i.temperature_rate",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.temperature_hysteresis", Kind.REGRESSOR, Enters.OUTPUT,
            f"thermal hysteresis of the bias of accelerometer {i}: it differs between rising and "
            "falling temperature",
            _size("g/K"), 1e-5, "",
            lambda p, at, i=i: {i: p["size"] * at.temperature_hysteresis_k},
            near_twins=(f"accel_{i}.temperature", f"accel_{i}.temperature_rate"),
            family="accel_i.temperature_hysteresis",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.noise", Kind.NOISE, Enters.OUTPUT, f"noise of accelerometer {i}, ratio to the declared noise",
            (Parameter("ratio", "1", "standard deviation over the declared one"),), 1.2,
            ACCELEROMETER_STANDARD, axes=(i,), noise=NoiseProperty.LEVEL,
            family="accel_i.noise",
        )
        for i in AXES
    ],
    Effect(
        "accel.outliers", Kind.NOISE, Enters.OUTPUT, "outliers: isolated values far outside the noise",
        (Parameter("fraction", "1", "fraction of the values"),
         Parameter("size", "1", "size, in declared standard deviations")),
        0.005, "", axes=AXES, noise=NoiseProperty.OUTLIERS,
    ),
    *[
        Effect(
            f"accel_{i}.quantisation", Kind.NOISE, Enters.OUTPUT, f"quantisation of accelerometer {i}",
            (Parameter("size", "g", "least significant bit"),), 1e-5,
            ACCELEROMETER_STANDARD, axes=(i,), noise=NoiseProperty.QUANTISATION,
            family="accel_i.quantisation",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.ramp", Kind.RAMP, Enters.OUTPUT, f"linear ageing of the bias of accelerometer {i}",
            _size("g/day"), 1e-6, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * (at.time_s / DAY_S)},
            near_twins=(f"accel_{i}.temperature",),
            family="accel_i.ramp",
        )
        for i in AXES
    ],
    Effect(
        "accel.coloured_noise", Kind.NOISE, Enters.OUTPUT, "correlation of the accelerometer noise, first order",
        (Parameter("correlation", "1", "correlation of successive samples"),), 0.3,
        ACCELEROMETER_STANDARD, axes=AXES, noise=NoiseProperty.CORRELATION,
    ),
    *[
        Effect(
            f"gyro_{i}.noise", Kind.NOISE, Enters.RATE, f"white drift noise of gyro {i}, ratio to the declared noise",
            (Parameter("ratio", "1", "standard deviation over the declared one"),), 1.2,
            NOISE_STANDARD, axes=(i,), noise=NoiseProperty.LEVEL,
            family="gyro_i.noise",
        )
        for i in AXES
    ],
    # Site, clock and attitude.
    Effect(
        "site.latitude", Kind.CONSTANT, Enters.INPUT, "error of the astronomic latitude", _size("deg"), 0.005, "",
        lambda p, at: {"omega_0": _turned_about_east(RAD_PER_DEG * p["size"], at)},
        # The three D_I absorb omega_0 - k f_0. The record determines the magnitude of Earth rate and
        # its angle to gravity only up to that: any two of these effects are equivalent.
        equivalents=("clock.rate", "site.earth_rate"), equivalence=EARTH_RATE,
        separated_by=SITE_EXPERIMENTS,
        formula="omega_0 -> omega_0 turned about East by site_latitude",
    ),
    Effect(
        "site.earth_rate", Kind.CONSTANT, Enters.INPUT, "relative error of the assumed Earth rate", _size("1"), 1e-8,
        "", lambda p, at: {"omega_0": (1 + p["size"]) * at.omega_0},
        equivalents=("clock.rate",), separated_by=SITE_EXPERIMENTS, default_search=False,
        formula="omega_0 -> (1 + site_earth_rate) omega_0",
    ),
    Effect(
        "site.gravity", Kind.CONSTANT, Enters.INPUT,
        "relative error of the assumed gravity: a common scale factor of the accelerometers",
        _size("1"), 5e-5, "", lambda p, at: {"f_0": (1 + p["size"]) * at.f_0},
        near_twins=tuple(f"accel_{i}.scale" for i in AXES), separated_by=SITE_EXPERIMENTS,
        default_search=False,
        formula="f_0 -> (1 + site_gravity) f_0",
    ),
    Effect(
        "clock.rate", Kind.CONSTANT, Enters.TIME,
        "relative rate error of the sampling clock, positive if fast: a second of it lasts 1 - p",
        _size("1"), 2e-5, "", lambda p, at: 1 - p["size"], separated_by=SITE_EXPERIMENTS,
    ),
    Effect(
        "platform.initial_attitude", Kind.INITIAL_STATE, Enters.STATE, "error of the initial attitude outside its prior",
        _rotation(), 0.05, "", axes=AXES,
    ),
    Effect(
        "platform.knock", Kind.STATE_JUMP, Enters.STATE, "attitude jump of unknown size and onset",
        _rotation(), 0.05, "", axes=AXES, shapes=(_onset(),),
    ),
    *[
        Effect(
            f"gyro_{i}{j}.axis_misalignment", Kind.CONSTANT, Enters.RATE,
            f"misalignment of the input axis of gyro {i} towards platform {j}",
            _size("rad"), 3e-4, GYRO_STANDARD,
            # The gyro measures the rate about j, and the servo loop compensates it about i. First
            # order: the square of a milliradian is 1e-6 of a drift. Coefficients refer to
            # specific force along platform axes, as everywhere.
            lambda p, at, i=i, j=j: {i: -p["size"] * at.drift[j]},
            default_search=False,
            family="gyro_ij.axis_misalignment",
        )
        for i in AXES for j in others(i)
    ],
    *[
        Effect(
            f"gyro_{i}.magnetic", Kind.CONSTANT, Enters.RATE, f"magnetic sensitivity of the drift of gyro {i}",
            _size("deg/h/gauss"), 0.01, GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.field[i]},
            separated_by=(
                OTHER_INITIAL_STATE, Experiment("ChangeInput", "the magnetic field turned or shielded"),
            ),
            default_search=False,
            family="gyro_i.magnetic",
        )
        for i in AXES
    ],
    Effect(
        "filter.discretisation", Kind.INTEGRATION, Enters.FILTER, "discretisation error of the filter",
        (), 0.0, "", default_search=False,
    ),
]
