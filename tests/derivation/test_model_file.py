"""Models of model files against those of the catalogue, by CasADi: pytest tests/derivation."""

import random

import casadi as ca
import catalogue_program
import model_file
import pytest
import strapdown_catalogue_program
from casadi_program import ExportError, Function, Program
from frames import platform_c_chart
from layout import drift

EFFECTS = ["gyro_y.ramp", "accel_x.scale", "gyro_x.g_y", "gyro_z.warmup", "accel_yz.nonorthogonality",
           "gyro_x.magnetic", "site.latitude"]
LINE = {"schema_version": 1, "effects": EFFECTS}


def derived(**keys) -> Program:
    return model_file._program(LINE | keys, "unit")


def inputs(function: Function, values: dict[str, float]) -> list[ca.DM]:
    """The inputs of a function by the names of their elements; parameters without a value are zero."""
    return [ca.DM([values.get(element.name, 0.0) for element in group.elements])
            for group in function.inputs]


def outputs(program: Program, name: str, values: dict[str, float]) -> dict[str, ca.DM]:
    """Each output of a function, a derivative by the parameters as a column for each of these."""
    function = next(function for function in program.functions if function.name == name)
    found = function.casadi().call(inputs(function, values))
    named = {}
    for output, value in zip(function.outputs, found, strict=True):
        if not output.name.endswith("_d_parameters"):
            named[output.name] = value
            continue
        group = next(group for group in function.inputs if group.name == "parameters")
        for column, element in enumerate(group.elements):
            named[f"{output.name}: {element.id}"] = value[:, column]
    return named


def point(program: Program, seed: int) -> dict[str, float]:
    """A value for each input of the program."""
    rng = random.Random(seed)
    values = {}
    for function in program.functions:
        for group in function.inputs:
            if group.name == "platform_c_gyros":
                rotation = platform_c_chart(ca.DM([rng.uniform(-3, 3) for _ in range(3)]))
                values |= {element.name: float(rotation[n // 3, n % 3])
                           for n, element in enumerate(group.elements)}
                continue
            for element in group.elements:
                # Interval and time constants are positive.
                values.setdefault(element.name, rng.uniform(0.2, 1.0) * rng.choice([1, -1])
                                  if group.name not in ("conditions", "shapes")
                                  else rng.uniform(0.2, 1.0))
    return values


@pytest.mark.parametrize("gyros, catalogue", [
    ("platform", catalogue_program), ("strapdown", strapdown_catalogue_program),
])
def test_the_model_of_a_file_is_the_catalogue_without_the_other_effects(gyros, catalogue):
    own, whole = derived(gyros=gyros), catalogue.program()
    for seed in range(5):
        values = point(own, seed)
        for function in own.functions:
            expected = outputs(whole, function.name, values)
            for name, value in outputs(own, function.name, values).items():
                # Rates of 1e-5 rad/s, outputs of 1 g: some roundings of sums of twenty terms.
                scale = max(float(ca.norm_inf(ca.vec(expected[name]))), 1e-6)
                apart = float(ca.norm_inf(ca.vec(value - expected[name])))
                assert apart < 1e-13 * scale, (function.name, name)


def test_the_gyros_are_those_of_the_platform_unless_the_file_says_otherwise():
    assert "platform_c_gyros" not in derived().model["inputs"]
    assert derived().model == derived(gyros="platform").model
    strapdown = derived(gyros="strapdown")
    assert "platform_c_gyros" in strapdown.model["inputs"]
    assert "strapdown unit" in strapdown.model["doc"]
    # Parameters and their order are the same.
    for one, other in zip(derived().functions, strapdown.functions, strict=True):
        ids = [[e.id for g in function.inputs if g.name == "parameters" for e in g.elements]
               for function in (one, other)]
        assert ids[0] == ids[1] and (not ids[0] or len(ids[0]) == len(drift.elements) + len(EFFECTS))


@pytest.mark.parametrize("gyros", ["body", True, ["strapdown"], 1])
def test_other_gyros_are_refused(gyros):
    with pytest.raises(ExportError) as error:
        derived(gyros=gyros)
    assert str(error.value) == f"found gyros {gyros!r}, expected `platform` or `strapdown`"
