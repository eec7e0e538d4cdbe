"""Reference values of every function, computed by CasADi at fixed random points, for tests.

Their last bits depend on the mathematics library of the machine, so they are compared with a
tolerance and never byte for byte.
"""

import json
import math
import random
from pathlib import Path

import casadi as ca

from casadi_program import Element, Function, Group, Program
from frames import platform_c_chart
from layout import REGRESSORS

POINTS = 200
SEED = 20150101
DAY_S = 86400
OWN_GROUPS = ("parameters", "shapes")  # each program has its own
EARTH_RATE_RAD_PER_S = 7.292115e-5  # WGS 84


def _unit_vector(rng: random.Random) -> list[float]:
    z = rng.uniform(-1, 1)
    azimuth = rng.uniform(-math.pi, math.pi)
    r = math.sqrt(1 - z * z)
    return [r * math.cos(azimuth), r * math.sin(azimuth), z]


def _point(rng: random.Random) -> dict[str, list[float]]:
    """Angles to 80 deg, coefficients to 5, any direction of Earth rate and of gravity."""
    limit = math.radians(80)
    return {
        "theta": [rng.uniform(-limit, limit) for _ in range(3)],
        "drift": [rng.uniform(-5, 5) for _ in range(9)],
        "drift_noise": [rng.uniform(-0.1, 0.1) for _ in range(3)],
        "omega_0": [EARTH_RATE_RAD_PER_S * component for component in _unit_vector(rng)],
        "f_0": _unit_vector(rng),
        "step": [rng.uniform(1, 120)],
        "east_0": _unit_vector(rng),
        "field_0": [rng.uniform(-0.6, 0.6) for _ in range(3)],
        "conditions": [rng.uniform(0, 3 * DAY_S), rng.uniform(1, 120), rng.uniform(-5, 5)],
    }


def _rotation(rng: random.Random) -> list[float]:
    """A direction cosine matrix by rows."""
    angles = [rng.uniform(-math.pi, math.pi) for _ in range(3)]
    rows = platform_c_chart(ca.DM(angles))
    return [float(rows[i, j]) for i in range(3) for j in range(3)]


def _own(group: Group, point: dict[str, list[float]], rng: random.Random) -> list[float]:
    """Parameters and shapes, which differ between programs. Effects are as large as drifts, so
    that a wrong one shows, and most onsets lie inside the step or near it."""
    time_s, interval_s = point["conditions"][:2]

    def scalar(element: Element) -> float:
        if element.name.endswith("_onset_s"):
            return time_s + rng.uniform(-1, 1) * interval_s
        if element.name.endswith("_time_constant_h"):
            return rng.uniform(0.3, 36)
        return rng.uniform(-0.5, 0.5)

    if group.name != "parameters":
        return [scalar(element) for element in group.elements]
    return point["drift"] + [scalar(element) for element in group.elements[len(point["drift"]):]]


def _key(program: Program, group: Group) -> str:
    """Name of a group among all programs."""
    return f"{program.name}::{group.name}" if group.name in OWN_GROUPS else group.name


def write(programs: list[Program], path: Path) -> None:
    rng = random.Random(SEED)
    points = [_point(rng) for _ in range(POINTS)]
    own = {
        _key(program, group): group
        for program in programs
        for function in program.functions
        for group in function.inputs
        if group.name in OWN_GROUPS
    }
    # Streams of their own: more effects and conditions leave the points as they are.
    rotations, regressors = random.Random(SEED + 2), random.Random(SEED + 3)
    for point in points:
        point["conditions"] += [regressors.uniform(-5, 5) for _ in REGRESSORS[1:]]
        point["platform_c_gyros"] = _rotation(rotations)
        point.update({key: _own(group, point, rng) for key, group in own.items()})
    forces = random.Random(SEED + 1)
    for point in points:
        point["force"] = _unit_vector(forces)
    document = {
        "casadi_version": ca.__version__,
        "inputs": points,
        "functions": {
            f"{program.name}::{function.name}": _evaluate(program, function, points)
            for program in programs
            for function in program.functions
        },
    }
    lines = [f'{{"casadi_version": {json.dumps(document["casadi_version"])},', '"inputs": [']
    lines.append(",\n".join(json.dumps(point) for point in points))
    lines.append('],\n"functions": {')
    lines.append(
        ",\n".join(
            f"{json.dumps(name)}: [\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]"
            for name, rows in document["functions"].items()
        )
    )
    lines.append("}}\n")
    path.write_text("\n".join(lines), encoding="utf-8", newline="\n")


def _evaluate(program: Program, function: Function, points: list[dict]) -> list[list[float]]:
    """Structural nonzeros of every output, in the order of the program, for each point."""
    compiled = function.casadi()
    keys = [_key(program, group) for group in function.inputs]
    return [
        [value for output in compiled.call([ca.DM(point[key]) for key in keys])
         for value in output.nonzeros()]
        for point in points
    ]
