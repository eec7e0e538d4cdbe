"""What several tests use."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import gyrocal

ROOT = Path(__file__).parents[3]
DATA = ROOT / "examples" / "data"


def command() -> str:
    """The command of a build by Cargo where there is one, otherwise that of the wheel."""
    built = os.environ.get("GYROCAL_COMMAND")
    return built or shutil.which("gyrocal", path=str(Path(sys.executable).parent))


def run_command(arguments, folder):
    """Runs the command; the JSON result that it writes."""
    out = folder / "command.json"
    subprocess.run(
        [command(), *map(str, arguments), "--json", str(out)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    return json.loads(out.read_text())


def without_command_line(result):
    """A result without the line that says how it was made: there is no command line in Python."""
    result = json.loads(json.dumps(result))
    del result["manifest"]["command"]
    return result


@pytest.fixture(autouse=True)
def at_the_root(monkeypatch):
    """Paths in results are those that were given: the command and the tests give the same."""
    monkeypatch.chdir(ROOT)


@pytest.fixture(scope="session")
def simulated():
    """A record of a day with a large fault: diagnosed in a second."""
    return gyrocal.simulate(
        {
            "seed": 3,
            "site": {"latitude_deg": 39.1},
            "platform": {
                "initial_angles_deg": [12.0, -25.0, 40.0],
                "initial_angles_sigma_deg": [0.01, 0.01, 0.01],
            },
            "gyros": {
                "bias_deg_per_h": [0.412, -0.287, 0.153],
                "g_deg_per_h_per_g": [-0.126, 0.214, 0.087],
                "gg_deg_per_h_per_g2": [0.041, -0.068, 0.023],
            },
            "hidden": [{"effect": "gyro_y.g_z", "size": 0.05}],
            "noise": {"accel_g": 1e-5, "gyro_deg_per_h": 0.002},
            "sampling": {"duration_s": 86400.0, "interval_s": 300.0},
        }
    )


@pytest.fixture(scope="session")
def diagnosed(simulated):
    return gyrocal.diagnose(simulated.record, simulated.bench)
