"""The catalogue of effects: whatever this project can look for, one entry each.

To add an effect, add an entry. Its derivatives, its place in `Catalogue` and its row in the
table of effects follow with the next build; docs/adding-a-term.md walks through an example.

Letters are those of IEEE Std 517-1974 (single-degree-of-freedom gyros: D_F, D_I, D_O, D_S and
squares and products of them) and IEEE Std 1293-2018 (accelerometers: K_0, K_1, K_2, ...), where
I, O and S stand for input, output and spin axis. Input axes are the platform axes; which of the
two other axes is a gyro's output axis is not known here, so either letter may apply.
"""

import math

import casadi as ca

from effect import Effect, Parameter, others
from layout import AXES

DAY_S = 86400
HOUR_S = 3600
RAD_PER_DEG = math.pi / 180

GYRO_STANDARD = "IEEE Std 517-1974"
TUNED_GYRO_STANDARD = "IEEE Std 813-1988"
ACCELEROMETER_STANDARD = "IEEE Std 1293-2018"
NOISE_STANDARD = "IEEE Std 952-1997"


def _size(unit: str) -> tuple[Parameter]:
    return (Parameter("size", unit),)


def _products(i: str) -> list[str]:
    """Pairs of axes whose products may drive gyro i, but for its own square (nominal)."""
    pairs = [j + k for j in AXES for k in AXES if j <= k]
    return [pair for pair in pairs if pair != i + i]


def _product_twin(i: str, pair: str) -> tuple[str, ...]:
    """a.a = g^2 makes the squares along the two other axes one class, with opposite signs."""
    j, k = others(i)
    return (f"gyro_{i}.g_{k}{k}",) if pair == j + j else ()


def _share_after(onset_s: ca.SX, at) -> ca.SX:
    """The share of a step that lies after an onset."""
    share = (at.time_s - onset_s) / at.interval_s + 0.5
    return ca.fmax(0, ca.fmin(1, share))


def _turned_about_east(angle_rad: ca.SX, at) -> ca.SX:
    """Earth rate at a latitude greater by an angle; it has no component along East."""
    return ca.cos(angle_rad) * at.omega_0 + ca.sin(angle_rad) * ca.cross(at.east_0, at.omega_0)


EFFECTS = [
    # Drift of the gyros.
    *[
        Effect(
            f"gyro_{i}.g_{j}", "drift",
            f"mass unbalance of gyro {i} that specific force along {j} acts on (D_O or D_S)",
            _size("deg/h/g"), 0.05, GYRO_STANDARD,
            lambda p, at, i=i, j=j: {i: p["size"] * at.a[j]},
            near_twins=(f"gyro_{i}{j}.axis_misalignment", f"gyro_{i}.magnetic",
                        f"gyro_{i}.diurnal"),
        )
        for i in AXES for j in others(i)
    ],
    *[
        Effect(
            f"gyro_{i}.g_{pair}", "drift",
            f"anisoelasticity of gyro {i}: product of specific forces along {pair[0]} and "
            f"{pair[1]} (D_IO, D_IS, D_OS, D_OO or D_SS)",
            _size("deg/h/g^2"), 0.02, GYRO_STANDARD,
            lambda p, at, i=i, pair=pair: {i: p["size"] * (at.a[pair[0]] * at.a[pair[1]])},
            equivalents=_product_twin(i, pair),
        )
        for i in AXES for pair in _products(i)
    ],
    *[
        Effect(
            f"gyro_{i}.g_{i}{i}{i}", "drift",
            f"cubic term of gyro {i} along its input axis (D_III)",
            _size("deg/h/g^3"), 0.01, TUNED_GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]**3},
            near_twins=(f"gyro_{i}.g_{i}",),
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.ramp", "drift", f"linear ageing of gyro {i}: drift rate ramp (R)",
            _size("deg/h/day"), 0.005, NOISE_STANDARD,
            lambda p, at, i=i: {i: p["size"] * (at.time_s / DAY_S)},
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.step", "drift", f"sudden change of the drift of gyro {i} that stays",
            _size("deg/h"), 0.02, "",
            lambda p, at, i=i: {i: p["size"] * _share_after(p["onset_s"], at)},
            shapes=(Parameter("onset_s", "s", "time of the change since the first row"),),
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.warmup", "drift", f"warm-up of gyro {i}: drift that decays",
            _size("deg/h"), 0.05, GYRO_STANDARD,
            lambda p, at, i=i: {
                i: p["size"] * ca.exp(-at.time_s / (HOUR_S * p["time_constant_h"]))
            },
            shapes=(Parameter("time_constant_h", "h", "time in which it falls to 1/e"),),
            near_twins=(f"gyro_{i}.ramp", "platform.initial_attitude"),
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.diurnal", "drift",
            f"drift of gyro {i} that follows the solar day, as room temperature does",
            (Parameter("sine", "deg/h", "part that begins at zero"),
             Parameter("cosine", "deg/h", "part that begins at its largest")),
            0.01, "",
            lambda p, at, i=i: {
                i: p["sine"] * ca.sin(2 * math.pi / DAY_S * at.time_s)
                + p["cosine"] * ca.cos(2 * math.pi / DAY_S * at.time_s)
            },
            formula=f"omega_d_{i} += gyro_{i}_diurnal_sine*sin(2*pi*time_s/86400) + "
                    f"gyro_{i}_diurnal_cosine*cos(2*pi*time_s/86400)",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.temperature", "drift", f"temperature coefficient of the drift of gyro {i}",
            _size("deg/h/K"), 0.005, GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.temperature_k},
            near_twins=(f"gyro_{i}.diurnal",),
        )
        for i in AXES
    ],
    *[
        Effect(
            f"gyro_{i}.random_walk", "drift", f"rate random walk of gyro {i} (K)",
            _size("deg/h/sqrt(h)"), 0.001, NOISE_STANDARD, kind="noise",
        )
        for i in AXES
    ],
    # What the accelerometers read.
    *[
        Effect(
            f"accel_{i}.bias", "output", f"bias of accelerometer {i} (K_0)",
            _size("g"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"]},
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.scale", "output", f"scale factor error of accelerometer {i} (K_1)",
            _size("1"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]},
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.quadratic", "output", f"square term of accelerometer {i} (K_2)",
            _size("g/g^2"), 2e-5, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.a[i]**2},
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}{j}.nonorthogonality", "output",
            f"axes of accelerometers {i} and {j} not at a right angle: the symmetric part of "
            "misalignment (delta_o, delta_p)",
            _size("rad"), 1e-4, ACCELEROMETER_STANDARD,
            lambda p, at, i=i, j=j: {i: p["size"] * at.a[j], j: p["size"] * at.a[i]},
        )
        for i in AXES for j in AXES if i < j
    ],
    *[
        Effect(
            f"accel_{i}.temperature", "output",
            f"temperature coefficient of the bias of accelerometer {i}",
            _size("g/K"), 1e-5, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.temperature_k},
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.noise", "output", f"noise of accelerometer {i} other than declared",
            (Parameter("ratio", "1", "sigma over the declared one"),), 1.2,
            ACCELEROMETER_STANDARD, kind="noise",
        )
        for i in AXES
    ],
    Effect(
        "accel.outliers", "output", "isolated samples far outside the noise",
        (Parameter("fraction", "1", "share of the samples"),
         Parameter("size", "1", "spread, in declared sigmas")),
        0.005, "", kind="noise",
    ),
    *[
        Effect(
            f"accel_{i}.quantisation", "output", f"quantisation of accelerometer {i}",
            (Parameter("size", "g", "least significant bit"),), 1e-5,
            ACCELEROMETER_STANDARD, kind="noise",
        )
        for i in AXES
    ],
    *[
        Effect(
            f"accel_{i}.ramp", "output", f"linear ageing of the bias of accelerometer {i}",
            _size("g/day"), 1e-6, ACCELEROMETER_STANDARD,
            lambda p, at, i=i: {i: p["size"] * (at.time_s / DAY_S)},
            near_twins=(f"accel_{i}.temperature",),
        )
        for i in AXES
    ],
    Effect(
        "accel.coloured_noise", "output", "accelerometer noise that is correlated in time",
        (Parameter("correlation", "1", "correlation of neighbouring samples"),), 0.3,
        ACCELEROMETER_STANDARD, kind="noise",
    ),
    *[
        Effect(
            f"gyro_{i}.noise", "drift", f"white drift noise of gyro {i} other than declared",
            (Parameter("ratio", "1", "sigma over the declared one"),), 1.2,
            NOISE_STANDARD, kind="noise",
        )
        for i in AXES
    ],
    # Where and when.
    Effect(
        "site.latitude", "site", "error of the astronomic latitude", _size("deg"), 0.005, "",
        lambda p, at: {"omega_0": _turned_about_east(RAD_PER_DEG * p["size"], at)},
        # The record sees the angle between Earth rate and gravity and the size of Earth rate only
        # up to omega_0 - k f_0, which the three D_I take up: any two of these are one.
        equivalents=("clock.rate", "site.earth_rate"),
        formula="omega_0 -> omega_0 turned about East by site_latitude",
    ),
    Effect(
        "site.earth_rate", "site", "relative error of the assumed Earth rate", _size("1"), 1e-8,
        "", lambda p, at: {"omega_0": (1 + p["size"]) * at.omega_0},
        equivalents=("clock.rate",), default_search=False,
        formula="omega_0 -> (1 + site_earth_rate) omega_0",
    ),
    Effect(
        "site.gravity", "site",
        "relative error of the assumed gravity: a common scale factor of the accelerometers",
        _size("1"), 5e-5, "", lambda p, at: {"f_0": (1 + p["size"]) * at.f_0},
        near_twins=tuple(f"accel_{i}.scale" for i in AXES), default_search=False,
        formula="f_0 -> (1 + site_gravity) f_0",
    ),
    Effect(
        "clock.rate", "time",
        "relative error of the sampling clock, which runs fast: a second of the record lasts 1 - p",
        _size("1"), 2e-5, "", lambda p, at: 1 - p["size"],
    ),
    Effect(
        "platform.initial_attitude", "state", "attitude at the first sample outside its prior",
        tuple(Parameter(i, "deg", f"rotation about platform {i}") for i in AXES),
        0.05, "", kind="state",
    ),
    Effect(
        "platform.knock", "state", "sudden change of attitude of unknown size and time",
        (*(Parameter(i, "deg", f"rotation about platform {i}") for i in AXES),
         Parameter("onset_s", "s", "time of the change since the first row")),
        0.05, "", kind="state",
    ),
    *[
        Effect(
            f"gyro_{i}{j}.axis_misalignment", "drift",
            f"input axis of gyro {i} turned towards platform {j}",
            _size("rad"), 3e-4, GYRO_STANDARD,
            # The gyro feels the rate about j, and the servo loop takes it out about i. Of first
            # order: the square of a milliradian is 1e-6 of a drift. Coefficients refer to
            # specific force along platform axes, as everywhere.
            lambda p, at, i=i, j=j: {i: -p["size"] * at.drift[j]},
            default_search=False,
        )
        for i in AXES for j in others(i)
    ],
    *[
        Effect(
            f"gyro_{i}.magnetic", "drift", f"drift of gyro {i} from the Earth's magnetic field",
            _size("deg/h/gauss"), 0.01, GYRO_STANDARD,
            lambda p, at, i=i: {i: p["size"] * at.field[i]},
            default_search=False,
        )
        for i in AXES
    ],
    Effect(
        "filter.discretisation", "filter", "the integration rule of the filter is too coarse",
        (), 0.0, "", kind="filter", default_search=False,
    ),
]
