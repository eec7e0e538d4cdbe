"""The state, its noise and the inputs: every name, unit and order is declared here, once.

Frames: `chart` is fixed to the Earth, East-North-Up at the start of a record unless the
filter has moved its chart; `platform` is the stabilised platform. Equation numbers are
those of Li Zhong, Geophysical and Geochemical Exploration 39(S1), 2015, 28-32.
"""

from dataclasses import dataclass

from casadi_program import Element, Group

AXES = ("x", "y", "z")

theta = Group(
    "theta",
    "Platform angles: rotations about x, then y, then z that carry the chart axes into "
    "the platform axes, equation (4).",
    [Element(f"theta_{i}", "rad", f"rotation about the {i} axis") for i in AXES],
)

drift = Group(
    "drift",
    "Drift coefficients of the three gyros, equations (1) and (2): constant parameters.",
    [
        element
        for i in AXES
        for element in (
            Element(f"gyro_{i}_bias", "deg/h", f"D_F of gyro {i}: drift at zero specific force",
                    f"gyro_{i}.bias"),
            Element(f"gyro_{i}_g_{i}", "deg/h/g",
                    f"D_I of gyro {i}: mass unbalance along its input axis", f"gyro_{i}.g_{i}"),
            Element(f"gyro_{i}_g_{i}{i}", "deg/h/g^2",
                    f"D_II of gyro {i}: square term along its input axis", f"gyro_{i}.g_{i}{i}"),
        )
    ],
)

drift_noise = Group(
    "drift_noise",
    "White drift of the three gyros, held over a step (epsilon of equation (1)).",
    [Element(f"epsilon_{i}", "deg/h", f"drift noise of gyro {i}") for i in AXES],
)

omega_0 = Group(
    "omega_0",
    "Earth rate in chart axes; in ENU it is (0, Omega cos(latitude), Omega sin(latitude)).",
    [Element(f"omega_0_{i}", "rad/s", f"Earth rate along chart {i}") for i in AXES],
)

f_0 = Group(
    "f_0",
    "Specific force in chart axes, in units of local gravity, up positive; (0, 0, 1) in ENU.",
    [Element(f"f_0_{i}", "g", f"specific force along chart {i}") for i in AXES],
)

step = Group("step", "Length of one filter step.", [Element("dt", "s", "step length")])

east_0 = Group(
    "east_0",
    "Unit vector East in chart axes; (1, 0, 0) in ENU.",
    [Element(f"east_0_{i}", "1", f"East along chart {i}") for i in AXES],
)

field_0 = Group(
    "field_0",
    "Magnetic field of the Earth in chart axes.",
    [Element(f"field_0_{i}", "gauss", f"magnetic field along chart {i}") for i in AXES],
)

platform_c_gyros = Group(
    "platform_c_gyros",
    "Direction cosine matrix by rows: platform components from components along the input axes "
    "of gyros that are fixed to a body and not to the platform.",
    [Element(f"platform_{i}_gyro_{j}", "1", f"platform {i} along the input axis of gyro {j}")
     for i in AXES for j in AXES],
)

force = Group(
    "force",
    "Specific force along the input axes, up positive.",
    [Element(f"force_{i}", "g", f"specific force along {i}") for i in AXES],
)

conditions = Group(
    "conditions",
    "Known quantities that change from step to step.",
    [
        Element("time_s", "s", "time since the first row: of the middle of the step for rates, of "
                "the sample for outputs"),
        Element("interval_s", "s", "length of the step, greater than zero"),
        Element("temperature_k", "K", "temperature above its mean over the record"),
        Element("temperature_rate_k_per_h", "K/h", "rate of change of the temperature"),
        Element("temperature_hysteresis_k", "K", "temperature less what follows it with a play"),
    ],
)

REGRESSORS = ("temperature_k", "temperature_rate_k_per_h", "temperature_hysteresis_k")
"""Elements of `conditions` that follow from the logged temperature."""


@dataclass(frozen=True)
class Channel:
    """A rate or an output of the model, with the id of the parameter that adds a constant to it."""

    id: str
    name: str
    unit: str
    label: str
    constant: str


RATE_CHANNELS = [
    Channel(f"gyro_{i}", f"drift of gyro {i}", "deg/h", i, f"gyro_{i}.bias") for i in AXES
]
OUTPUT_CHANNELS = [
    Channel(f"accel_{i}", f"reading of accelerometer {i}", "g", i, f"accel_{i}.bias") for i in AXES
]
