"""The exporter as its users call it: pytest codegen/emit/tests/python."""

import json
import re
from pathlib import Path

import casadi as ca
import pytest
from casadi_program import (
    Element,
    ExportError,
    ExternalFunction,
    Function,
    Group,
    Output,
    Program,
    matrix,
    rust_name,
    vector,
)
from plant import Plant


def program(*functions: Function) -> dict:
    return json.loads(Program("test", "A test.", list(functions)).to_json())


def function(group: Group, expression: ca.SX, name: str = "f") -> Function:
    return Function(name, "A function.", "", [group], [Output("y", expression, "1", "value")])


@pytest.fixture
def x() -> Group:
    return Group("x", "Argument.", [Element("x", "1", "argument")])


@pytest.mark.parametrize("name, expected", [
    ("V_x", "v_x"), ("omegaX", "omega_x"), ("Ixx", "ixx"), ("qNED", "q_ned"), ("NEDFrame", "ned_frame"),
    ("theta_x", "theta_x"), ("a__b", "a__b"),
])
def test_names_become_those_of_rust(name: str, expected: str) -> None:
    assert rust_name(name) == expected


def test_capitals_stay_in_the_id() -> None:
    group = Group("Wing", "A wing.", [Element("V_x", "m/s", "speed"), Element("a", "1", "angle")])
    written = program(function(group, group["V_x"]))["groups"][0]
    assert (written["name"], written["elements"][0]["name"]) == ("wing", "v_x")
    assert [element["id"] for element in written["elements"]] == ["V_x", ""]


def test_names_that_become_one_are_refused() -> None:
    with pytest.raises(ExportError, match="`v` and `V`, which are both `v` in Rust"):
        Group("g", "", [Element("v", "1", ""), Element("V", "1", "")])


def test_a_matrix_stands_row_by_row() -> None:
    group = matrix("mount", "Mounting.", "1", ["x", "y"], ["a", "b", "c"])
    assert group.names == [f"mount_{row}_{column}" for row in "xy" for column in "abc"]
    assert group.matrix.shape == (2, 3)
    assert str(group.matrix[0, 2]) == "mount_x_c"
    assert "2 x 3, row by row" in group.doc
    assert vector("f", "Force.", "N").names == ["f_x", "f_y", "f_z"]


def test_every_operation_of_sx_but_output_is_known(x: Group) -> None:
    y = x.sx
    for expression in [ca.floor(y), ca.ceil(y), ca.erf(y), ca.erfinv(y), ca.log1p(y), ca.expm1(y),
                       ca.asinh(y), ca.acosh(y), ca.atanh(y), ca.fmod(y, 2), ca.remainder(y, 2),
                       ca.hypot(y, 2), ca.copysign(y, -1)]:
        assert program(function(x, expression))["functions"][0]["instructions"]
    with pytest.raises(ExportError, match="OP_PRINTME, which is not supported; it prints"):
        program(function(x, y.printme(1)))


def test_constants_that_are_not_finite_are_refused(x: Group) -> None:
    with pytest.raises(ExportError, match="function `f`, instruction 1 holds the constant nan"):
        program(function(x, x.sx + ca.SX(float("nan"))))


def test_mx_is_refused_with_the_way_out(x: Group) -> None:
    with pytest.raises(ExportError, match="is MX, expected casadi.SX.*expand()"):
        program(function(x, ca.MX.sym("x")))


def test_calls_inside_are_written_out(x: Group) -> None:
    inner = ca.Function("inner", [x.sx], [ca.sin(x.sx)], {"never_inline": True})
    written = program(function(x, ca.jacobian(inner(2 * x.sx), x.sx)))["functions"][0]
    assert "cos" in {instruction[0] for instruction in written["instructions"]}


def test_an_external_function_without_derivative_cannot_be_differentiated(x: Group) -> None:
    table = ExternalFunction("table_a", "A table.", ["x"])
    assert program(function(x, table(x.sx)))["externals"][0]["path"] == "crate::table_a"
    with pytest.raises(ExportError, match="derivative of the external function `table_a`"):
        program(function(x, ca.jacobian(table(x.sx), x.sx)))


def test_a_plant_has_what_a_filter_needs() -> None:
    state, valve = Group("state", "", [Element("h", "m", "")]), Group("valve", "", [Element("k", "1", "")])
    wave = Group("wave", "", [Element("w", "m/s", "")])
    plant = Plant("Tank", "A tank.", state, -valve["k"] * ca.sqrt(state["h"]) + wave["w"], state["h"],
                  ["h_read"], parameters=valve, noise=wave)
    written = json.loads(plant.program().to_json())
    assert written["model"]["rates"] == {"value": "dynamics", "jacobian": "dynamics_jacobian"}
    names = [output["name"] for output in written["functions"][1]["outputs"]]
    assert names == ["rates", "rates_d_state", "rates_d_valve", "rates_d_wave"]
    # The noise is zero where the functions are evaluated.
    assert all(i["group"] != "wave" for f in written["functions"] for i in f["inputs"])


MANUAL = (Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8")
SNIPPETS = [block for block in re.findall("```python\n(.*?)```", MANUAL, re.S) if "def derive" in block]


@pytest.mark.parametrize("snippet", SNIPPETS)
def test_snippets_of_the_manual_run(snippet: str, tmp_path: Path) -> None:
    scope: dict = {}
    exec(snippet, scope)
    scope["derive"](tmp_path)
    assert json.loads(next(tmp_path.glob("*.json")).read_text())["functions"]


def test_the_manual_has_snippets() -> None:
    assert len(SNIPPETS) == 2
