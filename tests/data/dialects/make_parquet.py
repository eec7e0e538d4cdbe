"""Writes `typed.parquet`: the rows of `truth.csv` in columns of many types, in row groups of ten rows.

Run with pyarrow installed.
"""

import csv
import datetime
import pathlib

import pyarrow
import pyarrow.parquet

HERE = pathlib.Path(__file__).parent
START = datetime.datetime(2026, 3, 1, 6, 0, 0, 125000, tzinfo=datetime.timezone.utc)
GRAVITY = 9.80665
HOLES = {(3, 1), (7, 0), (7, 1), (7, 2), (13, 2)}

with (HERE / "truth.csv").open() as file:
    truth = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
time = [row[0] for row in truth]
accel = list(zip(*(row[1:4] for row in truth)))
# Times of the clock of each unit, in nanoseconds.
at = [int(START.timestamp() * 1000) * 10**6 + int(t) * 10**9 for t in time]


def stamps(unit, zone=None):
    divisor = {"ns": 1, "us": 10**3, "ms": 10**6}[unit]
    return pyarrow.array([value // divisor for value in at], pyarrow.timestamp(unit, zone))


columns = {
    "time_s": pyarrow.array(time, pyarrow.float64()),
    "time_ms": pyarrow.array([int(t * 1000) for t in time], pyarrow.int64()),
    "gap_s": pyarrow.array([None if row == 5 else t for row, t in enumerate(time)], pyarrow.float64()),
    "sensor": pyarrow.array(["upper"] * len(time)).dictionary_encode(),
    "number": pyarrow.array([7] * len(time), pyarrow.uint8()),
    "nested": pyarrow.array([[1.0, 2.0]] * len(time)),
    "temperature_c": pyarrow.array([row[4] for row in truth], pyarrow.float64()),
}
for unit in ["ns", "us", "ms"]:
    columns[f"at_{unit}"] = stamps(unit)
    columns[f"at_{unit}_utc"] = stamps(unit, "UTC")
    columns[f"at_{unit}_zone"] = stamps(unit, "Asia/Kolkata")
for axis, values in zip("xyz", accel):
    index = "xyz".index(axis)
    columns[f"accel_{axis}_g"] = pyarrow.array(values, pyarrow.float64())
    columns[f"{axis}_m_per_s2"] = pyarrow.array([GRAVITY * value for value in values], pyarrow.float64())
    columns[f"{axis}_single"] = pyarrow.array(values, pyarrow.float32())
    # Values are multiples of 2^-14 g.
    columns[f"{axis}_counts"] = pyarrow.array([int(16384 * value) for value in values], pyarrow.int32())
    columns[f"{axis}_short"] = pyarrow.array([int(16384 * value) for value in values], pyarrow.int16())
    columns[f"{axis}_dictionary"] = pyarrow.array(values, pyarrow.float64()).dictionary_encode()
    columns[f"{axis}_holes"] = pyarrow.array(
        [None if (row, index) in HOLES else value for row, value in enumerate(values)], pyarrow.float64())

pyarrow.parquet.write_table(
    pyarrow.table(columns), HERE / "typed.parquet", compression="snappy", row_group_size=10)
pyarrow.parquet.write_table(
    pyarrow.table({name: columns[name] for name in ["at_ns", "accel_x_g", "accel_y_g", "accel_z_g"]}),
    HERE / "spark.parquet", compression="gzip", use_deprecated_int96_timestamps=True)
(HERE / "typed.map.toml").write_text(
    '[time]\ncolumn = "at_ns"\n[accel]\ncolumns = ["x_m_per_s2", "y_m_per_s2", "z_m_per_s2"]\nunit = "m/s2"\n'
    f'[temperature]\ncolumn = "temperature_c"\n[site]\ngravity_m_per_s2 = {GRAVITY}\n')
