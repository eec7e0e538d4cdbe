"""Records from frames of every kind, and what is refused of them."""

import pickle
import threading
import time

import numpy as np
import pandas as pd
import polars as pl
import pyarrow as pa
import pytest

import gyrocal
from gyrocal import fleet


def equal(record, other):
    same_temperature = (record.temperature_c is None) == (other.temperature_c is None)
    return (
        same_temperature
        and np.array_equal(record.time_s, other.time_s)
        and np.array_equal(record.accel_g, other.accel_g, equal_nan=True)
    )


def frames(columns):
    structured = np.zeros(len(columns["time_s"]), dtype=[(name, "f8") for name in columns])
    for name, values in columns.items():
        structured[name] = values
    table = pa.table(columns)
    half = table.num_rows // 2
    return {
        "mapping": dict(columns),
        "structured": structured,
        "pandas": pd.DataFrame(columns),
        "pandas-arrow": pa.table(columns).to_pandas(types_mapper=pd.ArrowDtype),
        "pandas-nullable": pd.DataFrame(columns).convert_dtypes(),
        "polars": pl.DataFrame(columns),
        "arrow": table,
        "arrow-chunks": pa.concat_tables([table.slice(0, half), table.slice(half)]),
        "arrow-batch": table.to_batches()[0],
        "arrow-reader": table.to_reader(max_chunksize=7),
    }


KINDS = list(frames({"time_s": [0.0, 1.0]}))


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_of_frames_give_the_same_record(simulated, kind):
    columns = simulated.record.columns()
    columns["temperature_c"] = np.linspace(20.0, 21.0, len(simulated.record))
    record = gyrocal.Record.from_frame(frames(columns)[kind])
    expected = gyrocal.Record(simulated.record.time_s, simulated.record.accel_g, columns["temperature_c"])
    assert equal(record, expected)
    assert record.sha256 == expected.sha256


def test_order_of_columns_and_types_of_numbers_are_free():
    columns = {
        "accel_z_g": np.array([1, 1, 1], dtype=np.int32),
        "time_s": np.array([0, 60, 120], dtype=np.int64),
        "accel_x_g": np.zeros(3, dtype=np.float32),
        "accel_y_g": np.array([0.0, np.nan, 0.0]),
    }
    expected = gyrocal.Record([0, 60, 120], [[0, 0, 1], [0, np.nan, 1], [0, 0, 1]])
    for name, frame in frames(columns).items():
        assert equal(gyrocal.Record.from_frame(frame), expected), name
    with_nulls = pa.table({**columns, "accel_y_g": pa.array([0.0, None, 0.0])})
    assert equal(gyrocal.Record.from_frame(with_nulls), expected)
    assert equal(gyrocal.Record.from_frame(pl.from_arrow(with_nulls)), expected)


def test_arrays_of_a_record_are_views_that_cannot_be_written_to(simulated):
    record = simulated.record
    assert np.shares_memory(record.accel_g, record.accel_g)
    assert np.shares_memory(record.time_s, record.columns()["time_s"])
    with pytest.raises(ValueError, match="read-only"):
        record.accel_g[0, 0] = 1.0
    kept = gyrocal.simulate("examples/data/three_days.scenario.toml").record.accel_g
    assert kept.shape == (4321, 3) and np.all(np.isfinite(kept))


def test_strided_columns_are_read(simulated):
    samples = np.asfortranarray(simulated.record.accel_g)
    assert equal(gyrocal.Record(simulated.record.time_s, samples), simulated.record)
    backwards = simulated.record.time_s[::-1]
    assert equal(gyrocal.Record(backwards[::-1], samples), simulated.record)


def test_objects_can_be_pickled(simulated, diagnosed):
    assert equal(pickle.loads(pickle.dumps(simulated.record)), simulated.record)
    assert pickle.loads(pickle.dumps(simulated.bench)).to_dict() == simulated.bench.to_dict()
    assert pickle.loads(pickle.dumps(diagnosed)) == diagnosed
    assert pickle.loads(pickle.dumps(simulated)).record.sha256 == simulated.record.sha256
    with pytest.raises(gyrocal.InputError) as caught:
        gyrocal.Bench({"site": {"latitude_deg": 91.0}})
    restored = pickle.loads(pickle.dumps(caught.value))
    assert (str(restored), restored.line) == (str(caught.value), caught.value.line)


def test_the_lock_of_the_interpreter_is_released(simulated):
    beats = []
    done = threading.Event()

    def beat():
        while not done.is_set():
            beats.append(time.monotonic())
            time.sleep(0.005)

    thread = threading.Thread(target=beat)
    thread.start()
    started = time.monotonic()
    gyrocal.diagnose(simulated.record, simulated.bench)
    ended = time.monotonic()
    done.set()
    thread.join()
    within = sum(started < moment < ended for moment in beats)
    # A thread that waits 5 ms beats some 200 times a second; with the lock held, once.
    assert within > 10 * (ended - started)


GOOD = {
    "time_s": np.arange(20) * 60.0,
    "accel_x_g": np.linspace(0.0, 0.02, 20),
    "accel_y_g": np.linspace(0.0, 0.01, 20),
    "accel_z_g": np.full(20, 0.9998),
}


def changed(**columns):
    return {**GOOD, **columns}


def bad(column, row, value):
    values = GOOD[column].copy()
    values[row] = value
    return changed(**{column: values})


def renamed(old, new):
    return {new if name == old else name: values for name, values in GOOD.items()}


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        (renamed("accel_x_g", "accel_x_mg"), ["accel_x_mg", "did you mean `accel_x_g`"]),
        (renamed("accel_x_g", "ax"), ["`ax`", "accel_x_g"]),
        ({k: v for k, v in GOOD.items() if k != "accel_z_g"}, ["accel_z_g"]),
        (changed(pressure=GOOD["time_s"]), ["pressure", "remove it"]),
        (changed(accel_y_g=np.array(["0.1"] * 20, dtype=object)), ["accel_y_g", "object", "to_numeric"]),
        (changed(accel_y_g=np.array(["0.1"] * 20)), ["accel_y_g", "convert"]),
        (
            changed(time_s=np.arange(20).astype("datetime64[m]")),
            ["time_s", "datetime64", "seconds"],
        ),
        (bad("time_s", 4, np.nan), ["time_s", "row 4", "NaN", "leave the row out"]),
        (bad("accel_z_g", 7, np.inf), ["accel_z_g", "row 7", "inf", "nan"]),
        (changed(temperature_c=np.full(20, np.nan)), ["temperature_c", "row 0", "interpolate"]),
        (changed(accel_x_g=np.zeros(19)), ["accel_x_g", "19 values", "20"]),
        (changed(accel_x_g=np.zeros((20, 2))), ["accel_x_g", "2 dimensions"]),
    ],
)
def test_frames_that_are_refused(columns, words):
    with pytest.raises(gyrocal.InputError) as caught:
        gyrocal.diagnose(columns, BENCH)
    for word in words:
        assert word in str(caught.value), str(caught.value)
    assert caught.value.found and caught.value.expected


@pytest.mark.parametrize("make", [pd.DataFrame, pl.DataFrame, pa.table])
def test_each_kind_of_frame_names_the_column_that_is_wrong(make):
    for columns, words in [
        (renamed("accel_x_g", "accel_x_mg"), ["accel_x_mg", "accel_x_g"]),
        (changed(accel_y_g=["0.1"] * 20), ["accel_y_g", "float64"]),
        (bad("time_s", 4, np.nan), ["time_s", "row 4"]),
    ]:
        with pytest.raises(gyrocal.InputError) as caught:
            gyrocal.diagnose(make(columns), BENCH)
        text = str(caught.value)
        assert all(word in text for word in words), text
        assert caught.value.advice, text


def test_units_in_the_metadata_of_arrow_are_checked():
    fields = [pa.field(name, pa.float64()) for name in GOOD]
    fields[1] = fields[1].with_metadata({"unit": "m/s^2"})
    with pytest.raises(gyrocal.InputError, match="accel_x_g.*m/s\\^2"):
        gyrocal.diagnose(pa.table(GOOD, schema=pa.schema(fields)), BENCH)
    fields[1] = fields[1].with_metadata({"unit": "g"})
    assert len(gyrocal.Record.from_frame(pa.table(GOOD, schema=pa.schema(fields)))) == 20


def test_values_of_no_platform_are_refused_with_their_row(simulated):
    columns = {name: values.copy() for name, values in simulated.record.columns().items()}
    columns["accel_z_g"][10] = 7.5
    with pytest.raises(gyrocal.InputError) as caught:
        gyrocal.diagnose(columns, simulated.bench)
    error = caught.value
    # The line of row 10 in a file, whose first line is the header.
    assert (error.line, error.file) == (12, "<dict>")
    assert "row 11 after the header" in error.found and error.code == "gyrocal::input::norm"


def test_other_units_are_told_as_an_error_of_the_set_up(simulated):
    columns = simulated.record.columns()
    for axis in "xyz":
        columns[f"accel_{axis}_g"] = 9.80665 * columns[f"accel_{axis}_g"]
    found = gyrocal.diagnose(columns, simulated.bench)
    assert found.verdict == "setup" and found.setup[0].kind == "unit"
    with pytest.raises(gyrocal.SetupError) as caught:
        gyrocal.calibrate(columns, simulated.bench)
    assert caught.value.result.verdict == "setup"
    assert caught.value.result.setup[0].kind == "unit"


def test_things_that_are_no_record_are_refused():
    for wrong in (np.zeros((5, 4)), 7, [1, 2, 3], None):
        with pytest.raises(gyrocal.InputError, match="expected"):
            gyrocal.Record.from_frame(wrong)
    with pytest.raises(gyrocal.InputError, match="cannot be read"):
        gyrocal.diagnose("missing.csv", BENCH)


BENCH = {
    "site": {"latitude_deg": 39.1},
    "platform": {
        "initial_angles_deg": [12.0, -25.0, 40.0],
        "initial_angles_sigma_deg": [0.01, 0.01, 0.01],
    },
    "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
}


@pytest.mark.parametrize(
    ("bench", "words"),
    [
        ({**BENCH, "site": {"latitude_deg": 91.0}}, ["91", "-90"]),
        ({**BENCH, "site": {"latitud_deg": 39.1}}, ["latitud_deg", "latitude_deg"]),
        ({key: value for key, value in BENCH.items() if key != "noise"}, ["noise"]),
        ({**BENCH, "noise": None}, ["None"]),
        ({**BENCH, "site": {"latitude_deg": float("nan")}}, ["nan"]),
        ({**BENCH, "site": {"latitude_deg": {1}}}, ["set"]),
        (7, ["int", "a path"]),
    ],
)
def test_bench_descriptions_that_are_refused(bench, words):
    with pytest.raises(gyrocal.InputError) as caught:
        gyrocal.diagnose(GOOD, bench)
    for word in words:
        assert word in str(caught.value), str(caught.value)


def test_errors_of_files_have_their_place(tmp_path):
    file = tmp_path / "record.csv"
    file.write_text("time_s,accel_x_g,accel_y_g,accel_z_g\n0,0,0,1\n60,zero,0,1\n")
    with pytest.raises(gyrocal.InputError) as caught:
        gyrocal.diagnose(file, BENCH)
    error = caught.value
    assert (error.file, error.line, error.column) == (str(file), 3, 4)
    assert error.found == "`zero`" and "finite number" in error.expected
    assert error.code == "gyrocal::input::not_a_number"
    assert isinstance(error, ValueError) and isinstance(error, gyrocal.GyrocalError)


def test_an_unknown_effect_is_the_same_error_in_all_functions(simulated):
    for function in (gyrocal.calibrate, gyrocal.diagnose, gyrocal.plan):
        with pytest.raises(gyrocal.InputError, match="^effects: there is no effect `gyro_y.g_zz_`") as caught:
            function(simulated.record, simulated.bench, effects=["gyro_y.g_zz_"])
        assert (caught.value.found, caught.value.advice is None) == ("gyro_y.g_zz_", False)
        assert "effects of the catalogue" in caught.value.expected


PLANT = "examples/duffing/plant.json"
SCENARIO = "examples/data/three_days.scenario.toml"


@pytest.mark.parametrize(
    ("call", "place", "found"),
    [
        (lambda r, b: gyrocal.plan(r, b, hours="24"), "hours", "'24'"),
        (lambda r, b: gyrocal.plan(r, b, hours=[True]), "hours", "[True]"),
        (lambda r, b: gyrocal.plan(r, b, limits_deg={"x": 3.0}), "limits_deg", "{'x': 3.0}"),
        (lambda r, b: gyrocal.plan(r, b, sigmas="gyro_x.bias"), "sigmas", "'gyro_x.bias'"),
        (lambda r, b: gyrocal.plan(r, b, diagnosis="d.json"), "diagnosis", "a str"),
        (lambda r, b: gyrocal.plan(r, b, aim=3), "aim", "3"),
        (lambda r, b: gyrocal.plan(r, b, effects="gyro_y.g_z"), "effects", "'gyro_y.g_z'"),
        (lambda r, b: gyrocal.diagnose(r, b, effects="gyro_y.g_z"), "effects", "'gyro_y.g_z'"),
        (lambda r, b: gyrocal.diagnose(r, b, effects=None), "effects", "None"),
        (lambda r, b: gyrocal.diagnose(r, b, false_alarm="0.01"), "false_alarm", "'0.01'"),
        (lambda r, b: gyrocal.diagnose(r, b, later=r), "later", "a Record"),
        (lambda r, b: gyrocal.calibrate(r, b, effects="gyro_y.g_z"), "effects", "'gyro_y.g_z'"),
        (lambda r, b: gyrocal.calibrate(r, b, average_s="60"), "average_s", "'60'"),
        (lambda r, b: gyrocal.calibrate(r, b, noise=1), "noise", "1"),
        (lambda r, b: gyrocal.characterise(3), "cells", "3"),
        (lambda r, b: gyrocal.characterise("clean", methods="nis"), "methods", "'nis'"),
        (lambda r, b: gyrocal.characterise("clean", runs=0), "runs", "0"),
        (lambda r, b: gyrocal.simulate(SCENARIO, seed=-1), "seed", "-1"),
        (lambda r, b: gyrocal.simulate(SCENARIO, seed=1.5), "seed", "1.5"),
        (lambda r, b: gyrocal.simulate(SCENARIO, seed=2**63), "seed", str(2**63)),
        (lambda r, b: gyrocal.simulate(5), "scenario", "5"),
        (lambda r, b: gyrocal.report(5, "page.html"), "results", "a int"),
        (lambda r, b: gyrocal.from_json(5), "text_or_path", "a int"),
        (lambda r, b: gyrocal.diagnose(pl.LazyFrame(r.columns()), b), "record", "a LazyFrame"),
        (lambda r, b: gyrocal.Plant(PLANT).diagnose(pl.LazyFrame(r.columns())), "record", "a LazyFrame"),
        (lambda r, b: gyrocal.Plant(PLANT).diagnose(5), "record", "a int"),
        (lambda r, b: gyrocal.Plant(PLANT).diagnose({}, 5), "columns", "a int"),
        (lambda r, b: gyrocal.Plant(PLANT).diagnose({}, false_alarm="0.01"), "false_alarm", "'0.01'"),
        (lambda r, b: gyrocal.Plant(PLANT).fit({}, first_rows=-1), "first_rows", "-1"),
        (lambda r, b: gyrocal.Plant(PLANT).fit({}, first_rows=1.5), "first_rows", "1.5"),
        (lambda r, b: fleet.summarise([], seed=-1), "seed", "-1"),
        (lambda r, b: fleet.summarise(5), "results", "a int"),
        (lambda r, b: list(fleet.diagnose_batches("abc")), "batches", "a str"),
        (lambda r, b: list(fleet.diagnose_batches([], false_alarm="0.01")), "false_alarm", "'0.01'"),
        (lambda r, b: fleet.diagnose_partitions("none", "none", false_alarm=2), "false_alarm", "2"),
        (lambda r, b: fleet.batch_of_records("abc"), "records", "a str"),
    ],
)
def test_wrong_arguments_are_one_kind_of_error(simulated, call, place, found):
    with pytest.raises(gyrocal.InputError) as caught:
        call(simulated.record, simulated.bench)
    assert str(caught.value).startswith(f"{place}: found {found}, expected ")
    assert caught.value.found == found and caught.value.expected


def test_arguments_of_other_number_types_are_taken(simulated):
    made = gyrocal.simulate(SCENARIO, seed=np.int64(3))
    assert made.manifest.seed == 3
    planned = gyrocal.plan(simulated.record, simulated.bench, hours=np.array([12.0, 24.0]))
    assert {run.duration_s for run in planned.proposals} == {12 * 3600.0, 24 * 3600.0}


def test_work_that_fails_says_what_to_do(simulated):
    with pytest.raises(gyrocal.InputError, match="false_alarm"):
        gyrocal.diagnose(simulated.record, simulated.bench, false_alarm=2.0)
    with pytest.raises(gyrocal.InputError, match="3 descriptions for 2 records"):
        gyrocal.calibrate([GOOD, GOOD], [BENCH, BENCH, BENCH])
    with pytest.raises(gyrocal.InputError, match="count twice"):
        gyrocal.calibrate([simulated.record, simulated.record], simulated.bench)


def test_a_list_of_records_is_refused_where_one_is_taken(simulated):
    record, bench = simulated.record, simulated.bench
    for function in (gyrocal.diagnose, gyrocal.plan):
        with pytest.raises(gyrocal.InputError, match="a list of 2, expected one record") as raised:
            function([record, record], bench)
        assert "command" in raised.value.advice


def test_gyro_axes_that_do_not_fit_are_refused(simulated):
    record, bench = simulated.record, simulated.bench
    rows = len(record)
    identity = np.tile([1.0, 0.0, 0.0, 0.0], (rows, 1))
    doubled = identity.copy()
    doubled[5] *= 2.0
    unknown = identity.copy()
    unknown[3, 0] = np.nan
    later = (record, bench)
    ragged = [[1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
    both = {"gyro_axes": identity, "later": later}
    cases = [
        (gyrocal.diagnose, {"gyro_axes": identity[:, :3]}, "gyro_axes: found the shape"),
        (gyrocal.diagnose, {"gyro_axes": ragged}, "gyro_axes: found rows of different lengths"),
        (gyrocal.diagnose, {"gyro_axes": [["a"] * 4]}, "gyro_axes: found the type"),
        (gyrocal.diagnose, {**both, "later_gyro_axes": ragged}, "later_gyro_axes: found rows of"),
        (gyrocal.diagnose, {**both, "later_gyro_axes": identity[1:]}, f"later_gyro_axes: found {rows - 1} rows"),
        (gyrocal.diagnose, {**both, "later_gyro_axes": doubled}, "later_gyro_axes, row 5"),
        (gyrocal.diagnose, {"gyro_axes": identity[1:]}, f"{rows}, as many as the record has"),
        (gyrocal.diagnose, {"gyro_axes": doubled}, "row 5: found a quaternion of norm 2.0000"),
        (gyrocal.diagnose, {"gyro_axes": unknown}, "row 3"),
        (gyrocal.diagnose, {"gyro_axes": identity, "filter": "euler"}, "filter"),
        (gyrocal.diagnose, both, "later_gyro_axes: found none"),
        (gyrocal.diagnose, {"later_gyro_axes": identity}, "later_gyro_axes: found some"),
        (gyrocal.calibrate, {"gyro_axes": doubled}, "norm 2.0000"),
        (gyrocal.calibrate, {"gyro_axes": [doubled]}, "gyro_axes[0], row 5"),
        (gyrocal.calibrate, {"gyro_axes": ragged}, "gyro_axes: found rows of different lengths"),
        (gyrocal.calibrate, {"gyro_axes": [identity, identity[:, :3]]}, "gyro_axes[1]: found the shape"),
        (gyrocal.calibrate, {"gyro_axes": [identity, identity]}, "2 for 1 records"),
        (gyrocal.calibrate, {"gyro_axes": []}, "0 for 1 records"),
        (gyrocal.calibrate, {"gyro_axes": identity, "method": "streaming"}, "batch estimator"),
        (gyrocal.calibrate, {"gyro_axes": identity, "average_s": 600.0}, "without average_s"),
    ]
    for function, options, message in cases:
        with pytest.raises(gyrocal.InputError) as raised:
            function(record, bench, **options)
        assert message in str(raised.value)
