"""What a user writes, as a type checker reads it; `test_typed.py` checks it. Nothing here runs."""

from pathlib import Path
from typing import assert_type

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
from matplotlib.figure import Figure
from numpy.typing import NDArray

import gyrocal
from gyrocal import fleet

simulated = gyrocal.simulate("scenario.toml", seed=3)
assert_type(simulated, gyrocal.Simulation)
assert_type(simulated.record, gyrocal.Record)
assert_type(simulated.record.accel_g, NDArray[np.float64])
assert_type(simulated.record.temperature_c, NDArray[np.float64] | None)
bench = gyrocal.Bench({"site": {"latitude_deg": 39.1}})
assert_type(bench.latitude_deg, float)

calibrated = gyrocal.calibrate(simulated.record, bench)
assert_type(calibrated, gyrocal.Calibration)
assert_type(calibrated.covariance, NDArray[np.float64])
assert_type(calibrated.to_pandas(), pd.DataFrame)
assert_type(calibrated.to_polars(), pl.DataFrame)
assert_type(calibrated.params, NDArray[np.float64])
assert_type(calibrated.conf_int(alpha=0.1), NDArray[np.float64])
assert_type(calibrated.summary(), str)
assert_type(gyrocal.from_json("result.json"), gyrocal.Result)

of_unit = gyrocal.calibrate(simulated.record, bench, gyro_axes=np.zeros((3, 4)))
assert_type(of_unit, gyrocal.Calibration)
gyrocal.diagnose(simulated.record, bench, gyro_axes="axes.csv")

diagnosed = gyrocal.diagnose(pd.DataFrame(), Path("bench.toml"), false_alarm=0.01)
assert_type(diagnosed, gyrocal.Diagnosis)
assert_type(diagnosed.verdict, str)
assert_type(diagnosed.scores, bytes | None)
assert_type(diagnosed.pvalues, dict[str, float])
planned = gyrocal.plan(simulated.record, bench, diagnosis=diagnosed, hours=24)
assert_type(planned, gyrocal.Plan)
gyrocal.report([calibrated, diagnosed, planned], "page.html")
gyrocal.report(diagnosed, Path("page.html"))

plant = gyrocal.Plant("plant.json")
assert_type(plant.inputs, list[str])
of_plant = plant.diagnose("record.csv", "columns.toml", later=pd.DataFrame())
assert_type(of_plant, gyrocal.PlantDiagnosis)
of_plant.report("page.html")
assert_type(of_plant.resid, NDArray[np.float64])
fit = plant.fit(pd.DataFrame(), first_rows=3)
assert_type(fit, gyrocal.PlantFit)
assert_type(fit.bic, float)
assert_type(fit.predict(one_step=True), NDArray[np.float64])
assert_type(fit.plot(), Figure)
assert_type(calibrated.plot(alpha=0.1), Figure)
assert_type(calibrated.llf, float)

for batch in fleet.diagnose_batches([pa.RecordBatch.from_pylist([], fleet.INPUT)]):
    assert_type(fleet.summarise([batch]), gyrocal.Fleet)

try:
    gyrocal.characterise("clean", runs=2)
except gyrocal.SetupError as error:
    assert_type(error.line, int | None)
    assert_type(error.advice, str | None)

# What is wrong is told: each of these comments is needed, or the checker says so.
gyrocal.diagnose(simulated.record)  # type: ignore[call-arg]
gyrocal.diagnose(simulated.record, bench, false_alarm="0.01")  # type: ignore[arg-type]
gyrocal.simulate(3)  # type: ignore[arg-type]
gyrocal.report(3, "page.html")  # type: ignore[arg-type]
gyrocal.plan(simulated.record, bench, hours="24")  # type: ignore[arg-type]
