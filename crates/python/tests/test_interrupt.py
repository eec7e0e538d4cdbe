"""An interrupt ends a long call within seconds, and what was finished stays."""

import json
import subprocess
import sys

import pytest

# Far longer than a test: nothing but the interrupt ends these calls in time.
CALLS = {
    "diagnose": "gyrocal.diagnose(made.record, made.bench)",
    "calibrate": "gyrocal.calibrate(made.record, made.bench)",
    "plan": "gyrocal.plan(made.record, made.bench, hours=range(1, 500))",
    "plant": "diagnose_plant()",
    "simulate": "gyrocal.simulate({**SCENARIO, 'sampling': {'duration_s': 3e6, 'interval_s': 0.5}})",
    "characterise": "gyrocal.characterise('clean', runs=2000, methods=[], results=sys.argv[1])",
}

# A process of its own: where the tests run, signals may belong to somebody else.
SCRIPT = """
import os, signal, sys, threading, time
import gyrocal
import numpy as np

SCENARIO = {
    "seed": 3,
    "site": {"latitude_deg": 39.1},
    "platform": {"initial_angles_deg": [12.0, -25.0, 40.0], "initial_angles_sigma_deg": [0.01, 0.01, 0.01]},
    "gyros": {
        "bias_deg_per_h": [0.412, -0.287, 0.153],
        "g_deg_per_h_per_g": [-0.126, 0.214, 0.087],
        "gg_deg_per_h_per_g2": [0.041, -0.068, 0.023],
    },
    "hidden": [{"effect": "gyro_y.g_z", "size": 0.05}],
    "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
    "sampling": {"duration_s": 3e6, "interval_s": 60.0},
}
made = gyrocal.simulate(SCENARIO)
plant = gyrocal.Plant("examples/duffing/plant.json")

def diagnose_plant():
    time_s = 0.05 * np.arange(40_000)
    noise = np.random.default_rng(1).normal(size=(2, len(time_s)))
    names = ["time_s", *plant.inputs, *plant.outputs]
    return plant.diagnose(dict(zip(names, [time_s, *np.cumsum(noise, axis=1)])))

def interrupt():
    global asked
    asked = time.monotonic()
    os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Timer(float(sys.argv[2]), interrupt).start()
try:
    CALL
except KeyboardInterrupt:
    print(time.monotonic() - asked)
"""


def interrupted(call, folder, after_s=0.7):
    """Seconds from the signal to the exception."""
    arguments = [sys.executable, "-c", SCRIPT.replace("CALL", call), str(folder), str(after_s)]
    done = subprocess.run(arguments, check=True, capture_output=True, text=True, timeout=120)
    assert done.stdout, "it ended before the signal"
    return float(done.stdout)


@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_ends_a_long_call(name, tmp_path):
    assert interrupted(CALLS[name], tmp_path) < 2.0


def test_finished_records_are_kept(tmp_path):
    interrupted(CALLS["characterise"], tmp_path, after_s=3.0)
    (kept,) = tmp_path.glob("*.jsonl")
    _, *lines = kept.read_text().splitlines()
    assert lines and all("done" in json.loads(line) for line in lines)
