"""Calibration and diagnosis of gyro drift of inertially stabilised platforms.

A record is a time series of the accelerometers of a platform that its gyros hold in inertial space. The
functions take it from a file, a frame (pandas, Polars), an Arrow table or NumPy arrays, and give the
numbers that the command ``gyrocal`` gives.

>>> import gyrocal
>>> simulated = gyrocal.simulate("examples/data/hidden_fault.scenario.toml")
>>> simulated.record
<gyrocal.Record <simulation>: 4321 rows over 3.00 days>
"""

from ._calls import calibrate, characterise, diagnose, plan, simulate
from ._errors import ComputationError, GyrocalError, InputError, SetupError
from ._gyrocal import VERSION as __version__
from ._plant import Plant
from ._record import COLUMNS, Bench, Record
from ._results import (
    Calibration,
    Characteristics,
    Diagnosis,
    Fields,
    Fleet,
    Plan,
    PlantDiagnosis,
    Result,
    Simulation,
    from_json,
    report,
)

__all__ = [
    "COLUMNS",
    "Bench",
    "Calibration",
    "Characteristics",
    "ComputationError",
    "Diagnosis",
    "Fields",
    "Fleet",
    "GyrocalError",
    "InputError",
    "Plan",
    "Plant",
    "PlantDiagnosis",
    "Record",
    "Result",
    "SetupError",
    "Simulation",
    "__version__",
    "calibrate",
    "characterise",
    "diagnose",
    "from_json",
    "plan",
    "report",
    "simulate",
]
