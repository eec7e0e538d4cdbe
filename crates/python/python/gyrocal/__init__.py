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
from ._errors import ComputationError, GyrocalError, GyrocalWarning, InputError, SetupError
from ._from_json import from_json
from ._gyrocal import VERSION as __version__
from ._plant import Plant
from ._plant_results import PlantDiagnosis, PlantFit
from ._record import COLUMNS, Bench, Record
from ._result import Fields, Result, report
from ._results import Calibration, Characteristics, Diagnosis, Fleet, Plan, Simulation

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
    "GyrocalWarning",
    "InputError",
    "Plan",
    "Plant",
    "PlantDiagnosis",
    "PlantFit",
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
