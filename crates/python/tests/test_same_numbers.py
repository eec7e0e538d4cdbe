"""The package gives the numbers of the command, bit for bit."""

import json

import numpy as np
import pytest

import gyrocal
from conftest import DATA, ROOT, run_command, without_command_line

FAULT = ["examples/data/hidden_fault.csv", "examples/data/hidden_fault.bench.toml"]
THREE_DAYS = ["examples/data/three_days.csv", "examples/data/three_days.bench.toml"]


def test_diagnosis(tmp_path):
    by_command = run_command(["diagnose", FAULT[0], "--bench", FAULT[1]], tmp_path)
    found = gyrocal.diagnose(*FAULT)
    assert without_command_line(found.to_dict()) == without_command_line(by_command)
    assert found.verdict == "effects-found"
    assert found.findings[0].effect == "gyro_y.g_z"

    # The values of a frame are those of the file; where they come from is another thing.
    frame = gyrocal.Record.read(FAULT[0]).to_pandas()
    of_frame = gyrocal.diagnose(frame, FAULT[1]).to_dict()
    for result in (of_frame, by_command):
        del result["manifest"]
    assert of_frame == by_command


def test_calibration(tmp_path):
    by_command = run_command(["calibrate", THREE_DAYS[0], "--bench", THREE_DAYS[1]], tmp_path)
    found = gyrocal.calibrate(*THREE_DAYS)
    assert without_command_line(found.to_dict()) == without_command_line(by_command)
    assert found.estimates.shape == (9,) and found.covariance.shape == (9, 9)


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ({"method": "streaming"}, ["--streaming"]),
        ({"method": "paper", "factorised": True}, ["--paper", "--factorised"]),
        ({"average_s": 600.0, "robust_sigmas": 3.0}, ["--average", "600", "--robust=3"]),
        ({"effects": ["gyro_y.g_z"], "noise": False}, ["--with", "gyro_y.g_z", "--no-noise"]),
    ],
)
def test_calibration_with_options(tmp_path, options, arguments):
    call = ["calibrate", THREE_DAYS[0], "--bench", THREE_DAYS[1], *arguments]
    by_command = run_command(call, tmp_path)
    found = gyrocal.calibrate(*THREE_DAYS, **options)
    assert without_command_line(found.to_dict()) == without_command_line(by_command)


def test_several_records(tmp_path):
    records = [THREE_DAYS[0], FAULT[0]]
    call = ["calibrate", *records, "--bench", THREE_DAYS[1], "--bench", FAULT[1]]
    by_command = run_command(call, tmp_path)
    found = gyrocal.calibrate(records, [THREE_DAYS[1], FAULT[1]])
    assert without_command_line(found.to_dict()) == without_command_line(by_command)
    assert len(found.runs) == 2


@pytest.fixture(scope="module")
def strapdown(tmp_path_factory):
    """A record computed from the log of a strapdown unit at rest, its bench file and its axes."""
    folder = tmp_path_factory.mktemp("strapdown")
    record, bench, axes = (folder / name for name in ("r.csv", "b.toml", "a.csv"))
    log = ROOT / "tests/data/measured/ring_laser_static"
    call = ["import", "strapdown", log / "imu.csv", "--log-description", log / "log.toml"]
    run_command([*call, "--out", record, "--bench-out", bench, "--axes-out", axes], folder)
    return record, bench, axes


def test_gyro_axes(tmp_path, strapdown):
    record, bench, file = strapdown
    quaternions = np.loadtxt(file, delimiter=",", skiprows=1)[:, 1:]
    for function, options, more in (
        (gyrocal.diagnose, {}, []),
        (gyrocal.calibrate, {"effects": ["gyro_y.g_z"]}, ["--with", "gyro_y.g_z"]),
    ):
        call = [function.__name__, record, "--bench", bench, "--gyro-axes", file, *more]
        by_command = run_command(call, tmp_path)
        found = function(record, bench, gyro_axes=file, **options)
        assert without_command_line(found.to_dict()) == without_command_line(by_command)
        # The values of an array are those of the file; where they come from is another thing.
        of_array = function(record, bench, gyro_axes=quaternions, **options).to_dict()
        assert of_array["manifest"]["inputs"][2]["path"] == "<gyro_axes>"
        effects = ", effects=['gyro_y.g_z']" if options else ""
        assert of_array["manifest"]["command"].endswith(f", gyro_axes=<ndarray>{effects})")
        for result in (of_array, by_command):
            del result["manifest"]
        assert of_array == by_command
    assert by_command["schema_version"]


def test_plan_of_a_strapdown_unit(tmp_path, strapdown):
    record, bench, file = strapdown
    quaternions = np.loadtxt(file, delimiter=",", skiprows=1)[:, 1:]
    call = ["plan", record, "--bench", bench, "--gyro-axes", file]
    by_command = run_command(call, tmp_path)
    planned = gyrocal.plan(record, bench, gyro_axes=file)
    assert without_command_line(planned.to_dict()) == without_command_line(by_command)
    assert planned.attitude_of == "unit"
    of_array = gyrocal.plan(record, bench, gyro_axes=quaternions)
    assert of_array.manifest.inputs[2].path == "<gyro_axes>"
    assert of_array.proposals == planned.proposals

    # From a diagnosis with the same axes, and with no others.
    found = gyrocal.diagnose(record, bench, gyro_axes=file)
    json_file = tmp_path / "diagnosis.json"
    json_file.write_text(json.dumps(found.to_dict()))
    by_command = run_command([*call, "--diagnosis", json_file], tmp_path)
    planned = gyrocal.plan(record, bench, gyro_axes=file, diagnosis=found).to_dict()
    del by_command["manifest"], planned["manifest"]
    assert planned == by_command
    with pytest.raises(gyrocal.InputError, match="strapdown unit"):
        gyrocal.plan(record, bench, diagnosis=found)
    with pytest.raises(gyrocal.InputError, match="stabilised platform"):
        gyrocal.plan(record, bench, gyro_axes=file, diagnosis=gyrocal.diagnose(record, bench))
    with pytest.raises(gyrocal.InputError, match="SHA-256"):
        gyrocal.plan(record, bench, gyro_axes=-quaternions, diagnosis=found)


def test_gyro_axes_of_a_later_record(tmp_path, strapdown):
    record, bench, file = strapdown
    held = gyrocal.Record.read(record)
    quaternions = np.loadtxt(file, delimiter=",", skiprows=1)[:, 1:]
    half = len(held) // 2
    parts = []
    for name, rows in (("first", slice(None, half)), ("later", slice(half, None))):
        part, axes = tmp_path / f"{name}.csv", tmp_path / f"{name}.axes.csv"
        gyrocal.Record(held.time_s[rows], held.accel_g[rows]).to_csv(part)
        lines = file.read_text().splitlines()
        axes.write_text("\n".join([lines[0], *lines[1:][rows]]) + "\n")
        parts.append((part, axes, quaternions[rows]))
    tables = gyrocal.Bench.read(bench).to_dict()
    # The later half begins in another attitude.
    for key in ("initial_angles_deg", "initial_angles_sigma_deg"):
        tables.get("platform", {}).pop(key, None)
    free = tmp_path / "free.toml"
    gyrocal.Bench(tables).write(free)
    (first, first_file, first_axes), (later, later_file, later_axes) = parts
    call = ["diagnose", first, "--bench", free, "--gyro-axes", first_file]
    call += ["--validate", later, "--validate-bench", free, "--validate-gyro-axes", later_file]
    by_command = run_command(call, tmp_path)
    found = gyrocal.diagnose(
        first, free, later=(later, free), gyro_axes=first_axes, later_gyro_axes=later_axes
    ).to_dict()
    names = [one["path"] for one in found["manifest"]["inputs"]]
    assert names[4:] == ["<gyro_axes>", "<later_gyro_axes>"]
    for result in (found, by_command):
        del result["manifest"]
    assert found == by_command


def test_simulation(tmp_path):
    scenario = "examples/data/hidden_fault.scenario.toml"
    out = tmp_path / "record.csv"
    bench = tmp_path / "bench.toml"
    call = ["simulate", scenario, "--seed", "7", "--out", out, "--bench-out", bench]
    by_command = run_command(call, tmp_path)
    made = gyrocal.simulate(scenario, seed=7)
    assert without_command_line(made.to_dict()) == without_command_line(by_command)
    made.record.to_csv(tmp_path / "python.csv")
    assert (tmp_path / "python.csv").read_bytes() == out.read_bytes()
    made.bench.write(tmp_path / "python.toml")
    assert (tmp_path / "python.toml").read_bytes() == bench.read_bytes()
    # The committed record is that of the committed seed.
    committed = gyrocal.Record.read(DATA / "hidden_fault.csv")
    assert np.array_equal(gyrocal.simulate(scenario).record.accel_g, committed.accel_g)


def test_plan(tmp_path, simulated):
    record, bench = tmp_path / "record.csv", tmp_path / "bench.toml"
    simulated.record.to_csv(record)
    simulated.bench.write(bench)
    call = ["plan", record, "--bench", bench, "--hours", "12", "--limits", "x=-60..60"]
    by_command = run_command(call, tmp_path)
    options = {"hours": 12.0, "limits_deg": {"x": (-60.0, 60.0)}}
    planned = gyrocal.plan(record, bench, **options)
    assert without_command_line(planned.to_dict()) == without_command_line(by_command)
    assert list(planned.to_pandas().hours) == [12.0] * len(planned.proposals)
    assert planned.manifest.command == (
        f"gyrocal.plan('{record}', '{bench}', hours=[12.0], limits_deg={{'x': [-60.0, 60.0]}})"
    )

    # From a diagnosis at hand, as the command from a file of it.
    found = gyrocal.diagnose(record, bench)
    file = tmp_path / "diagnosis.json"
    file.write_text(json.dumps(found.to_dict()))
    by_command = run_command([*call, "--diagnosis", file], tmp_path)
    planned = gyrocal.plan(record, bench, diagnosis=found, **options)
    del by_command["manifest"]
    assert {k: v for k, v in planned.to_dict().items() if k != "manifest"} == by_command


def test_characteristics(tmp_path):
    call = ["characterise", "--cell", "clean", "--runs", "2", "--seed", "40", "--method", "none"]
    by_command = run_command(call, tmp_path)
    found = gyrocal.characterise("clean", runs=2, seed=40, methods=[])
    assert found.manifest.command == "gyrocal.characterise(['clean'], runs=2, seed=40, methods=[])"
    assert without_command_line(found.to_dict()) == without_command_line(by_command)
